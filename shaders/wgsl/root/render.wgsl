//!use trace/layout
//!use trace/camera
//!use trace/integrator
// Adds samples to the film.

// Sum of samples: premultiplied linear radiance, opacity.
@group(1) @binding(0) var<storage, read_write> film_sum: array<vec4f>;
// Rays traced for each pixel.
@group(1) @binding(1) var<storage, read_write> film_rays: array<u32>;

// A sample that is not a number would stay in its pixel for ever: it counts as black.
fn render_finite(color: vec4f) -> vec4f {
    let exponents = bitcast<vec4u>(color) & vec4u(0x7f800000u);
    return select(color, vec4f(0.0), any(exponents == vec4u(0x7f800000u)));
}

@compute @workgroup_size(8, 8)
fn render(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= trace_frame.film_width || id.y >= trace_pass.row_count {
        return;
    }
    let row = trace_pass.row_first + id.y;
    let pixel = row * trace_frame.film_width + id.x;
    var sum = film_sum[pixel];
    var rays = film_rays[pixel];
    for (var i = 0u; i < trace_pass.sample_count; i++) {
        let sample_index = trace_pass.sample_first + i;
        var stream = rng_stream(trace_frame.seed, pixel, sample_index);
        let jitter = camera_jitter(trace_frame.seed, pixel, sample_index);
        let ray = camera_ray(vec2f(f32(id.x), f32(row)) + jitter);
        let path = path_trace(ray, Cone(0.0, trace_frame.camera_slope), &stream);
        sum += render_finite(path.color);
        rays += path.ray_count;
    }
    film_sum[pixel] = sum;
    film_rays[pixel] = rays;
}
