//!use path/film
//!use state/paths
// The last stage: adds the samples of a pass to the film, in their order. Sums in f32 depend on it.

@compute @workgroup_size(64)
fn stage_film(@builtin(global_invocation_id) id: vec3u) {
    let pixels = trace_frame.film_width * trace_pass.row_count;
    if id.x >= pixels {
        return;
    }
    let pixel = trace_pass.row_first * trace_frame.film_width + id.x;
    var sum = film_sum[pixel];
    var rays = film_rays[pixel];
    for (var i = 0u; i < trace_pass.sample_count; i++) {
        let path = i * pixels + id.x;
        sum += film_finite(state_float(path, STATE_COLOR));
        rays += state_word(path, STATE_LOOKUP).y;
    }
    film_sum[pixel] = sum;
    film_rays[pixel] = rays;
}
