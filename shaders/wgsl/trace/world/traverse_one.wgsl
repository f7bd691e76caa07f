//!use trace/bindings
//!use trace/ray
//!use trace/stack
//!use trace/world/nodes
// trace/world/traverse in scenes without instances: one level.

fn bvh_traverse(ray: Ray, any_hit: bool) -> Hit {
    var hit = Hit(ray.t_max, TRACE_NONE, 0u, vec2f(0.0));
    if trace_frame.triangle_count == 0u {
        return hit;
    }
    let octant_inverse4 = bvh_octant_inverse4(ray.direction);
    var stack: Stack;
    var stack_size = 0u;
    var nodes = vec2u(0u, 0x80000000u);
    for (var visit = 0u; visit < BVH_MAX_VISITS; visit++) {
        let found = bvh_enter(&stack, &stack_size, nodes, ray, hit.t, octant_inverse4);
        nodes = found.xy;
        var triangles = found.w;
        // At most 24: one bit each.
        while triangles != 0u {
            let local = firstLeadingBit(triangles);
            triangles &= ~(1u << local);
            hit = bvh_hit_triangle(found.z + local, 0u, ray, hit);
            if any_hit && hit.triangle != TRACE_NONE && bvh_stops(hit) {
                return hit;
            }
        }
        if nodes.y <= 0x00ffffffu {
            if stack_size == 0u {
                break;
            }
            stack_size -= 1u;
            nodes = stack_get(&stack, stack_size);
        }
    }
    return hit;
}
