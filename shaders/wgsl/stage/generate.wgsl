//!use trace/camera
//!use state/paths
// The first stage: the camera rays of all samples of a pass. Path `i` is of pixel `i % pixels` and of
// sample `i / pixels`, so neighbours have neighbouring rays.

@compute @workgroup_size(64)
fn stage_generate(@builtin(global_invocation_id) id: vec3u) {
    let path = id.x;
    let pixels = trace_frame.film_width * trace_pass.row_count;
    if path >= pixels * trace_pass.sample_count {
        return;
    }
    let local = path % pixels;
    let pixel = trace_pass.row_first * trace_frame.film_width + local;
    let sample_index = trace_pass.sample_first + path / pixels;
    let column = local % trace_frame.film_width;
    let row = trace_pass.row_first + local / trace_frame.film_width;
    let ray = camera_sample_ray(vec2u(column, row), pixel, sample_index);
    let stream = rng_stream(trace_frame.seed, pixel, sample_index);
    let state = path_new(ray, Cone(0.0, trace_frame.camera_slope));
    state_set_way(path, state, stream);
    state_set_float(path, STATE_COLOR, state.color);
    state_set(path, STATE_LOOKUP, vec4u(TRACE_NONE, 0u, 0u, 0u));
    // The host has counted them already.
    stage_lists[path] = path;
}
