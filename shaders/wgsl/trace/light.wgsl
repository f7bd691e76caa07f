//!use trace/bindings
// Light sources: the sky and rectangles.

fn light_sky(direction: vec3f) -> vec3f {
    let up = direction.y;
    let far = select(trace_frame.sky_ground.xyz, trace_frame.sky_zenith.xyz, up > 0.0);
    return mix(trace_frame.sky_horizon.xyz, far, min(abs(up), 1.0));
}

struct LightSample {
    direction: vec3f,
    distance: f32,
    radiance: vec3f,
    // Per solid angle, the choice of the light included; 0 when the light shows its back.
    pdf: f32,
}

// A point on one light, all lights alike likely, seen from `point`.
fn light_sample(point: vec3f, choice: f32, xi: vec2f) -> LightSample {
    let index = min(u32(choice * f32(trace_frame.light_count)), trace_frame.light_count - 1u);
    let corner = trace_frame.lights[index].corner.xyz;
    let on_light = corner
        + xi.x * trace_frame.lights[index].edge_u.xyz
        + xi.y * trace_frame.lights[index].edge_v.xyz;
    let offset = on_light - point;
    let distance = length(offset);
    let direction = offset / max(distance, 1e-20);
    let pdf = light_pdf(index, direction, distance);
    return LightSample(direction, distance, trace_frame.lights[index].radiance.xyz, pdf);
}

// Density with which light_sample would have found light `index` at `distance`.
fn light_pdf(index: u32, direction: vec3f, distance: f32) -> f32 {
    let normal_area = trace_frame.lights[index].normal_area;
    let cosine = -dot(normal_area.xyz, direction);
    if cosine <= 0.0 {
        return 0.0;
    }
    return distance * distance / (cosine * normal_area.w * f32(trace_frame.light_count));
}

// Power heuristic, Veach 1997 eq. 9.13 with beta = 2.
fn light_mis_weight(pdf: f32, other_pdf: f32) -> f32 {
    let ratio = other_pdf / pdf;
    return 1.0 / (1.0 + ratio * ratio);
}
