//!use trace/bindings
//!use trace/ray
//!use trace/stack
//!use trace/world/nodes
// Closest hit in a scene without instances: trace/bvh, with one level.

// Whether a surface may let rays through. Other ones stop a shadow ray wherever they are met.
fn bvh_is_veil(hit: Hit) -> bool {
    return bvh_triangle_is_veil(hit.triangle);
}

// The nearest triangle nearer than ray.t_max, or a miss.
fn bvh_closest(ray: Ray) -> Hit {
    return bvh_traverse(ray, false);
}

// For shadow rays: any triangle nearer than ray.t_max that stops all rays; where none does, the nearest
// of the others, or a miss.
fn bvh_any(ray: Ray) -> Hit {
    return bvh_traverse(ray, true);
}

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
        let offset = firstLeadingBit(nodes.y);
        let inner_mask = nodes.y;
        nodes.y &= ~(1u << offset);
        if nodes.y > 0x00ffffffu && stack_size < STACK_SIZE {
            stack_put(&stack, stack_size, nodes);
            stack_size += 1u;
        }
        let slot = (offset - 24u) ^ (octant_inverse4 & 0xffu);
        let child = nodes.x + countOneBits(inner_mask & ~(0xffffffffu << slot));
        let found = bvh_hit_node(child, ray, hit.t, octant_inverse4);
        nodes = found.xy;
        var triangles = found.w;
        // At most 24: one bit each.
        while triangles != 0u {
            let local = firstLeadingBit(triangles);
            triangles &= ~(1u << local);
            hit = bvh_hit_triangle(found.z + local, 0u, ray, hit);
            if any_hit && hit.triangle != TRACE_NONE && !bvh_is_veil(hit) {
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
