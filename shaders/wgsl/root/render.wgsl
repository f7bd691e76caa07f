//!use trace/layout
//!use trace/camera
//!use path/integrator
//!use path/film
// Adds samples to the film, each path from its start to its end.

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
        let ray = camera_sample_ray(vec2u(id.x, row), pixel, sample_index);
        let path = path_trace(ray, Cone(0.0, trace_frame.camera_slope), &stream);
        sum += film_finite(path.color);
        rays += path.ray_count;
    }
    film_sum[pixel] = sum;
    film_rays[pixel] = rays;
}
