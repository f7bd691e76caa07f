//!use trace/bindings
//!use trace/light/kinds
//!use trace/light/environment
// What lies behind everything: the panorama, or the sky.

fn light_far(direction: vec3f) -> vec3f {
    if LIGHTS_HAVE_ENVIRONMENT {
        return environment_radiance(direction);
    }
    let up = direction.y;
    let end = select(trace_frame.sky_ground.xyz, trace_frame.sky_zenith.xyz, up > 0.0);
    return mix(trace_frame.sky_horizon.xyz, end, min(abs(up), 1.0));
}

// Density with which light_sample finds a direction behind everything, per solid angle.
fn light_far_pdf(direction: vec3f) -> f32 {
    if LIGHTS_HAVE_ENVIRONMENT {
        return trace_frame.environment_turn.w * environment_pdf(direction);
    }
    return 0.0;
}
