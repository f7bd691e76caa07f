//!use trace/bindings
//!use trace/ray
// Meshes that are stored once and placed several times. The record of an instance lies among the nodes,
// behind all of them, in seven vec4u:
//   0 to 2  rows of the affine transform from world space to the mesh's own
//   3 to 5  rows of its inverse
//   6       root node of the mesh's hierarchy, material, 1 where the transform mirrors, 1 where the surface
//           may let rays through

fn instance_row(instance: u32, row: u32) -> vec4f {
    return bitcast<vec4f>(trace_nodes[instance + row]);
}

fn instance_root(instance: u32) -> u32 {
    return trace_nodes[instance + 6u].x;
}

fn instance_material(instance: u32) -> u32 {
    return trace_nodes[instance + 6u].y;
}

fn instance_mirrors(instance: u32) -> bool {
    return trace_nodes[instance + 6u].z != 0u;
}

fn instance_is_veil(instance: u32) -> bool {
    return trace_nodes[instance + 6u].w != 0u;
}

// The order of the sums is part of the contract with the CPU's traversal.
fn instance_along(row: vec4f, v: vec3f) -> f32 {
    return row.x * v.x + row.y * v.y + row.z * v.z;
}

// A vector by three rows from `first`.
fn instance_vector(instance: u32, first: u32, v: vec3f) -> vec3f {
    return vec3f(
        instance_along(instance_row(instance, first), v),
        instance_along(instance_row(instance, first + 1u), v),
        instance_along(instance_row(instance, first + 2u), v),
    );
}

fn instance_point(instance: u32, first: u32, p: vec3f) -> vec3f {
    let moved = vec3f(
        instance_row(instance, first).w,
        instance_row(instance, first + 1u).w,
        instance_row(instance, first + 2u).w,
    );
    return instance_vector(instance, first, p) + moved;
}

// A ray of world space in the mesh's own. Its direction is not of unit length, so that t stays what it is.
fn instance_ray(instance: u32, ray: Ray) -> Ray {
    let origin = instance_point(instance, 0u, ray.origin);
    let direction = instance_vector(instance, 0u, ray.direction);
    let size = abs(direction);
    // Beside the longest axis, as ray_safe_inverse has it beside 1: a mesh may be in any unit.
    let least = max(max(size.x, max(size.y, size.z)) * 0x1p-23f, 0x1p-120f);
    let kept = select(select(vec3f(least), vec3f(-least), direction < vec3f(0.0)), direction, size > vec3f(least));
    return Ray(origin, direction, 1.0 / kept, ray.t_max);
}

fn instance_vector_to_world(instance: u32, v: vec3f) -> vec3f {
    return instance_vector(instance, 3u, v);
}

fn instance_point_to_world(instance: u32, p: vec3f) -> vec3f {
    return instance_point(instance, 3u, p);
}

// By the inverse transpose, so that normals stay at right angles to surfaces that are stretched.
fn instance_normal_to_world(instance: u32, n: vec3f) -> vec3f {
    return n.x * instance_row(instance, 0u).xyz
        + n.y * instance_row(instance, 1u).xyz
        + n.z * instance_row(instance, 2u).xyz;
}
