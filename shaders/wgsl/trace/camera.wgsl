//!use trace/bindings
//!use trace/ray
//!use trace/rng
// Camera rays: pixel (0, 0) is top left, a sample lies anywhere in its pixel (box filter).

// Where in its pixel a sample lies: the R2 sequence (Roberts 2018), in 32-bit fixed point so that
// it stays exact for any sample count, shifted for each pixel.
fn camera_jitter(seed: u32, pixel: u32, sample_index: u32) -> vec2f {
    let shift_x = rng_hash(pixel ^ rng_hash(seed));
    let shift_y = rng_hash(shift_x);
    return vec2f(
        rng_unit(shift_x + sample_index * 3242174889u),
        rng_unit(shift_y + sample_index * 2447445414u),
    );
}

// `position` on the film in pixels.
fn camera_ray(position: vec2f) -> Ray {
    let size = vec2f(f32(trace_frame.film_width), f32(trace_frame.film_height));
    let ndc = 2.0 * position / size - 1.0;
    let direction = trace_frame.camera_forward.xyz
        + ndc.x * trace_frame.camera_right.xyz
        - ndc.y * trace_frame.camera_up.xyz;
    return ray_new(trace_frame.camera_position.xyz, normalize(direction), RAY_INFINITY);
}

// The ray of a sample of a pixel: `place` is its column and row, `pixel` its number.
fn camera_sample_ray(place: vec2u, pixel: u32, sample_index: u32) -> Ray {
    return camera_ray(vec2f(place) + camera_jitter(trace_frame.seed, pixel, sample_index));
}
