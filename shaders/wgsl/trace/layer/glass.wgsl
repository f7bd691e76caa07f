//!use trace/bsdf
//!use trace/rng
// Light through a surface: a rough dielectric (Walter et al. 2007), of a body or of a thin wall, which light
// leaves in the direction in which it came. Directions are local, as in trace/bsdf.

struct GlassSample {
    direction: vec3f,
    // Value times cosine over density.
    weight: vec3f,
    // Whether it goes to the other side.
    passes: bool,
}

// Share that a dielectric reflects; `eta` is the index on this side over that on the other.
fn glass_fresnel(cosine: f32, eta: f32) -> f32 {
    let sine_squared = eta * eta * (1.0 - cosine * cosine);
    if sine_squared >= 1.0 {
        return 1.0;
    }
    let other = sqrt(1.0 - sine_squared);
    let across = (eta * cosine - other) / (eta * cosine + other);
    let along = (cosine - eta * other) / (cosine + eta * other);
    return 0.5 * (across * across + along * along);
}

fn glass_sample(
    out_direction: vec3f,
    material: MaterialRecord,
    tint: vec3f,
    front: bool,
    stream: ptr<function, u32>,
) -> GlassSample {
    let half_vector = bsdf_visible_normal(out_direction, material.ggx_alpha, rng_next2(stream));
    let is_body = material.glass.w > 0.0;
    let index = abs(material.glass.w);
    let eta = select(1.0 / index, index, is_body && !front);
    let cosine = clamp(dot(out_direction, half_vector), 0.0, 1.0);
    var into = reflect(-out_direction, half_vector);
    var weight = vec3f(1.0);
    let passes = rng_next(stream) >= glass_fresnel(cosine, eta);
    if passes && is_body {
        into = refract(-out_direction, half_vector, eta);
        // Light that goes in comes out again.
        weight = sqrt(tint);
    } else if passes {
        into.z = -into.z;
        weight = tint;
    }
    if (into.z < 0.0) != passes || into.z == 0.0 {
        return GlassSample(into, vec3f(0.0), passes);
    }
    let masking = bsdf_lambda(out_direction, material.ggx_alpha);
    let both = 1.0 + masking + bsdf_lambda(into, material.ggx_alpha);
    return GlassSample(into, weight * ((1.0 + masking) / both), passes);
}
