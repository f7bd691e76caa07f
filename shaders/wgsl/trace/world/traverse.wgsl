//!use trace/bindings
//!use trace/ray
//!use trace/stack
//!use trace/world/instance
//!use trace/world/nodes
// The walk through two levels of hierarchies: the first, in world space, has triangles and instances in its
// leaves; a mesh that is placed several times has a hierarchy in its own space. A triangle record whose
// fourth number is not zero stands for an instance and says where its record lies. Scenes without instances
// have trace/world/traverse_one instead.

fn bvh_traverse(ray: Ray, any_hit: bool) -> Hit {
    var hit = Hit(ray.t_max, TRACE_NONE, 0u, vec2f(0.0));
    if trace_frame.triangle_count == 0u {
        return hit;
    }
    // The ray in the space of the hierarchy that is being walked, and whose that is.
    var local = ray;
    var instance = 0u;
    var octant_inverse4 = bvh_octant_inverse4(ray.direction);
    var stack: Stack;
    var stack_size = 0u;
    // The size of the stack at which the instance is done with.
    var stack_floor = TRACE_NONE;
    var nodes = vec2u(0u, 0x80000000u);
    for (var visit = 0u; visit < BVH_MAX_VISITS; visit++) {
        // Triangles that an instance among them held up come from the stack, as nodes do.
        var triangles = vec2u(nodes.x, nodes.y & 0x00ffffffu);
        if nodes.y > 0x00ffffffu {
            let found = bvh_enter(&stack, &stack_size, nodes, local, hit.t, octant_inverse4);
            nodes = found.xy;
            triangles = found.zw;
        } else {
            nodes.y = 0u;
        }
        // At most 24: one bit each.
        while triangles.y != 0u {
            let bit = firstLeadingBit(triangles.y);
            triangles.y &= ~(1u << bit);
            let index = triangles.x + bit;
            let link = bitcast<u32>(trace_triangles[index].v0.w);
            if link == 0u {
                hit = bvh_hit_triangle(index, instance, local, hit);
                if any_hit && hit.triangle != TRACE_NONE && bvh_stops(hit) {
                    return hit;
                }
                continue;
            }
            if nodes.y > 0x00ffffffu {
                bvh_push(&stack, &stack_size, nodes);
            }
            if triangles.y != 0u {
                bvh_push(&stack, &stack_size, triangles);
            }
            stack_floor = stack_size;
            instance = link;
            local = instance_ray(link, ray);
            octant_inverse4 = bvh_octant_inverse4(local.direction);
            nodes = vec2u(instance_root(link), 0x80000000u);
            break;
        }
        if nodes.y <= 0x00ffffffu {
            if stack_size == stack_floor {
                stack_floor = TRACE_NONE;
                instance = 0u;
                local = ray;
                octant_inverse4 = bvh_octant_inverse4(ray.direction);
            }
            if stack_size == 0u {
                break;
            }
            stack_size -= 1u;
            nodes = stack_get(&stack, stack_size);
        }
    }
    return hit;
}
