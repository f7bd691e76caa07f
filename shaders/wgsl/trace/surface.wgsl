//!use trace/bindings
//!use trace/ray
//!use trace/world/instance
//!use trace/world/levels
//!use trace/world/veil
//!use trace/cone
// What lies where a ray hit: position, normals, uv and the footprint of the ray cone in uv.

struct SurfacePoint {
    position: vec3f,
    // Unit, both on the side the ray came from.
    geometric_normal: vec3f,
    shading_normal: vec3f,
    uv: vec2f,
    // As vtex_sample wants it.
    footprint: vec4f,
    material: u32,
    // The ray came from where the triangle turns counter-clockwise.
    front: bool,
}

// What the colours of vertices make of white: ten bits a channel, of the root.
fn surface_color(hit: Hit) -> vec3f {
    let corners = trace_nodes[trace_frame.colors_first + hit.triangle];
    let r = vec3f(corners.xyz & vec3u(1023u));
    let g = vec3f((corners.xyz >> vec3u(10u)) & vec3u(1023u));
    let b = vec3f((corners.xyz >> vec3u(20u)) & vec3u(1023u));
    let weights = vec3f(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric) / (1023.0 * 1023.0);
    return vec3f(dot(weights, r * r), dot(weights, g * g), dot(weights, b * b));
}

// Rays nearly along a surface have footprints without end; they stop at this many cone widths.
const SURFACE_MIN_COSINE: f32 = 1.0 / 64.0;

fn surface_at(ray: Ray, hit: Hit, cone: Cone) -> SurfacePoint {
    let tri = trace_triangles[hit.triangle];
    let attributes = trace_attributes[hit.triangle];
    let weights = vec3f(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric);
    var v0 = tri.v0.xyz;
    var to_v1 = -tri.edge1.xyz;
    var to_v2 = tri.edge2.xyz;
    var smooth_normal = weights.x * attributes.normal0_u.xyz
        + weights.y * attributes.normal1_u.xyz
        + weights.z * attributes.normal2_u.xyz;
    var mirrored = false;
    if WORLD_HAS_INSTANCES && hit.instance != 0u {
        v0 = instance_point_to_world(hit.instance, v0);
        to_v1 = instance_vector_to_world(hit.instance, to_v1);
        to_v2 = instance_vector_to_world(hit.instance, to_v2);
        smooth_normal = instance_normal_to_world(hit.instance, smooth_normal);
        mirrored = instance_mirrors(hit.instance);
    }
    let outside = normalize(cross(to_v1, to_v2));
    let faces = dot(outside, ray.direction) < 0.0;
    let normal = select(-outside, outside, faces);
    let u3 = vec3f(attributes.normal0_u.w, attributes.normal1_u.w, attributes.normal2_u.w);
    let v3 = attributes.v_material.xyz;
    var point: SurfacePoint;
    point.position = v0 + weights.y * to_v1 + weights.z * to_v2;
    point.geometric_normal = normal;
    point.shading_normal = surface_shading_normal(smooth_normal, normal, ray.direction);
    point.uv = vec2f(dot(weights, u3), dot(weights, v3));
    let uv1 = vec2f(u3.y - u3.x, v3.y - v3.x);
    let uv2 = vec2f(u3.z - u3.x, v3.z - v3.x);
    point.footprint = surface_footprint(to_v1, to_v2, uv1, uv2, normal, ray.direction, cone.width);
    point.material = surface_material(hit);
    point.front = faces != mirrored;
    return point;
}

// The interpolated normal, turned to the viewer's side; where that is impossible the flat one.
fn surface_shading_normal(smooth_normal: vec3f, flat_normal: vec3f, direction: vec3f) -> vec3f {
    let length_squared = dot(smooth_normal, smooth_normal);
    if length_squared < 1e-12 {
        return flat_normal;
    }
    let unit = smooth_normal * inverseSqrt(length_squared);
    let turned = select(-unit, unit, dot(unit, flat_normal) > 0.0);
    return select(flat_normal, turned, dot(turned, direction) < -1e-4);
}

// The cone cuts the plane in an ellipse: `width` across the plane of incidence, and width over the
// cosine along it. Both axes become uv through the triangle's barycentric coordinates.
fn surface_footprint(
    to_v1: vec3f,
    to_v2: vec3f,
    uv1: vec2f,
    uv2: vec2f,
    normal: vec3f,
    direction: vec3f,
    width: f32,
) -> vec4f {
    let cosine = dot(normal, direction);
    let along_raw = direction - cosine * normal;
    let length_squared = dot(along_raw, along_raw);
    // Looking straight down any axis will do.
    let fallback = normalize(to_v1);
    let along = select(fallback, along_raw * inverseSqrt(max(length_squared, 1e-20)), length_squared > 1e-12);
    let across = cross(normal, along);
    let stretched = width / max(abs(cosine), SURFACE_MIN_COSINE);
    let axis0 = surface_uv_from_world(across * width, to_v1, to_v2, uv1, uv2);
    let axis1 = surface_uv_from_world(along * stretched, to_v1, to_v2, uv1, uv2);
    return vec4f(axis0, axis1);
}

// A vector in the triangle's plane as a difference of uv.
fn surface_uv_from_world(vector: vec3f, to_v1: vec3f, to_v2: vec3f, uv1: vec2f, uv2: vec2f) -> vec2f {
    let normal = cross(to_v1, to_v2);
    let scale = 1.0 / max(dot(normal, normal), 1e-30);
    let along_v1 = dot(cross(vector, to_v2), normal) * scale;
    let along_v2 = dot(cross(to_v1, vector), normal) * scale;
    return along_v1 * uv1 + along_v2 * uv2;
}
