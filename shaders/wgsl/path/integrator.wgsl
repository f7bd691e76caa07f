//!use vtex/sample
//!use trace/bvh
//!use path/steps
// All steps of a path in one loop, with the lookups of its surfaces.

// Surfaces a path may meet: one more than 64 scatterings, the most that the host allows, and
// PATH_MAX_VEILS.
const INTEGRATOR_MAX_SEGMENTS: u32 = 129u;

struct PathResult {
    // Radiance, and opacity of the scene in w.
    color: vec4f,
    ray_count: u32,
}

fn integrator_color(material: MaterialRecord, point: SurfacePoint) -> MaterialColor {
    var texel = vec4f(0.0);
    if material.texture_word != TRACE_NONE {
        texel = vtex_sample_at(material.texture_word, point.uv, point.footprint);
    }
    return material_color(material, texel);
}

// Adds what a shadow ray brings.
fn integrator_light(path: ptr<function, PathState>, first: ShadowRay) {
    var shadow = first;
    for (var segment = 0u; segment <= PATH_MAX_VEILS; segment++) {
        let ray = ray_new(shadow.origin, shadow.direction, shadow.left);
        let hit = bvh_any(ray);
        (*path).ray_count += 1u;
        if hit.triangle == TRACE_NONE {
            (*path).color = path_lit((*path).color, shadow);
            return;
        }
        if bvh_stops(hit) {
            return;
        }
        let point = surface_at(ray, hit, path_shadow_cone(shadow, hit.t));
        let alpha = integrator_color(trace_materials[point.material], point).alpha;
        (*path).veils += 1u;
        if !path_shadow_pass(&shadow, point, hit.t, alpha) || (*path).veils > PATH_MAX_VEILS {
            return;
        }
    }
}

fn path_trace(first_ray: Ray, first_cone: Cone, stream: ptr<function, u32>) -> PathResult {
    var path = path_new(first_ray, first_cone);
    for (var segment = 0u; segment < INTEGRATOR_MAX_SEGMENTS; segment++) {
        let hit = bvh_closest(path.ray);
        path.ray_count += 1u;
        if hit.triangle == TRACE_NONE {
            path.color = path_escape(path);
            break;
        }
        path_arrive(&path, hit.t);
        let point = surface_at(path.ray, hit, path.cone);
        let material = trace_materials[point.material];
        var color = integrator_color(material, point);
        if LAYERS_HAVE_COLORS {
            color.base_color *= surface_color(hit);
        }
        if color.alpha < 1.0 && rng_next(stream) >= color.alpha {
            if !path_pass(&path, point) {
                break;
            }
            continue;
        }
        path_absorb(&path, material, point, hit.t);
        path.color = path_emission(path, material, point, color.base_color);
        if path_ends(path, material) {
            break;
        }
        let lobes = path_lobes(path, material, point, color.base_color, stream);
        let shadow = path_shadow_ray(path, point, lobes, stream);
        if shadow.left > 0.0 {
            integrator_light(&path, shadow);
        }
        // The shadow ray may have passed the last see-through surface.
        var goes_on = false;
        if LAYERS_HAVE_GLASS && lobes.is_glass {
            goes_on = path_refract(&path, point, lobes, material, color.base_color, stream);
        } else {
            goes_on = path_scatter(&path, point, lobes, stream);
        }
        if !goes_on || path.veils > PATH_MAX_VEILS {
            break;
        }
    }
    return PathResult(path.color, path.ray_count);
}
