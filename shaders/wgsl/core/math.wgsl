// Small functions that are not of colour.

fn vtex_math_median(v: vec3f) -> f32 {
    return max(min(v.x, v.y), min(max(v.x, v.y), v.z));
}
