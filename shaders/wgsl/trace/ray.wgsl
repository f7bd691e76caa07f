// Rays and what they meet.

struct Ray {
    origin: vec3f,
    direction: vec3f,
    // 1 / direction, finite: see ray_safe_inverse.
    inverse: vec3f,
    t_max: f32,
}

struct Hit {
    t: f32,
    // Index in the order of the BVH, TRACE_NONE for a miss.
    triangle: u32,
    // Where the record of the instance lies whose mesh has the triangle, see trace/world/instance; 0 for a
    // triangle that is stored in world space.
    instance: u32,
    // Weights of the second and third vertex.
    barycentric: vec2f,
}

const RAY_INFINITY: f32 = 3.0e38;

fn ray_new(origin: vec3f, direction: vec3f, t_max: f32) -> Ray {
    let inverse = vec3f(
        ray_safe_inverse(direction.x),
        ray_safe_inverse(direction.y),
        ray_safe_inverse(direction.z),
    );
    return Ray(origin, direction, inverse, t_max);
}

// Keeps the slab test free of infinities and of 0 * infinity. 2^23 = 1 / epsilon.
fn ray_safe_inverse(x: f32) -> f32 {
    if abs(x) <= 0x1p-23f {
        return bitcast<f32>(bitcast<u32>(8388608.0f) | (bitcast<u32>(x) & 0x80000000u));
    }
    return 1.0 / x;
}

// Moves a point off its surface to the side of `normal`, by a distance that grows with the
// rounding error of its coordinates: Waechter and Binder, Ray Tracing Gems 2019, ch. 6.
fn ray_offset(point: vec3f, normal: vec3f) -> vec3f {
    let steps = vec3i(256.0 * normal);
    let moved = bitcast<vec3f>(bitcast<vec3i>(point) + select(steps, -steps, point < vec3f(0.0)));
    let near_zero = abs(point) < vec3f(1.0 / 32.0);
    return select(moved, point + normal * (1.0 / 65536.0), near_zero);
}
