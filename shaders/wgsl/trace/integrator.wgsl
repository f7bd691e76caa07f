//!use trace/bindings
//!use trace/ray
//!use trace/bvh
//!use trace/cone
//!use trace/surface
//!use trace/material
//!use trace/bsdf
//!use trace/light
//!use trace/rng
// The path tracer: Kajiya 1986, with next-event estimation and multiple importance sampling
// (Veach 1997). The radiance of one camera ray, and in w how much of the background it hides.

// Surfaces a path may meet, see-through ones included.
const PATH_MAX_SEGMENTS: u32 = 128u;
// See-through surfaces a shadow ray looks through; behind them it is dark.
const PATH_MAX_SHADOW_SEGMENTS: u32 = 32u;
// Scatterings after which paths may end by chance (Russian roulette).
const PATH_ROULETTE_AFTER: u32 = 3u;

struct PathResult {
    // Radiance, and opacity of the scene in w.
    color: vec4f,
    ray_count: u32,
}

// Light that scattered twice or more is clamped to trace_frame.indirect_clamp, which trades a
// little energy for far fewer fireflies; light seen directly or after one scattering is not.
fn path_clamped(color: vec3f, scatterings: u32) -> vec3f {
    let peak = max(color.x, max(color.y, color.z));
    if scatterings < 2u || peak <= trace_frame.indirect_clamp {
        return color;
    }
    return color * (trace_frame.indirect_clamp / peak);
}

// Share of the light that arrives along `direction` from `distance` away; in y the rays it took.
fn path_visibility(start: vec3f, direction: vec3f, distance: f32, cone: Cone) -> vec2f {
    var origin = start;
    var left = distance;
    var share = 1.0;
    for (var segment = 1u; segment <= PATH_MAX_SHADOW_SEGMENTS; segment++) {
        let ray = ray_new(origin, direction, left);
        let hit = bvh_closest(ray);
        if hit.triangle == TRACE_NONE {
            return vec2f(share, f32(segment));
        }
        let here = cone_at(cone, distance - left + hit.t);
        let point = surface_at(ray, hit, here);
        let material = trace_materials[point.material];
        if material.texture_word == TRACE_NONE || material.backing.w > 0.0 {
            return vec2f(0.0, f32(segment));
        }
        share *= 1.0 - material_color(material, point).alpha;
        if share <= 0.0 {
            return vec2f(0.0, f32(segment));
        }
        origin = ray_offset(point.position, -point.geometric_normal);
        left -= hit.t;
    }
    return vec2f(0.0, f32(PATH_MAX_SHADOW_SEGMENTS));
}

// Light that reaches a surface straight from an area light; in w the rays it took.
fn path_direct_light(
    point: SurfacePoint,
    frame: mat3x3f,
    bsdf: Bsdf,
    out_local: vec3f,
    cone: Cone,
    stream: ptr<function, u32>,
) -> vec4f {
    let choice = rng_next(stream);
    let start = ray_offset(point.position, point.geometric_normal);
    let light = light_sample(start, choice, rng_next2(stream));
    if light.pdf <= 0.0 || dot(light.direction, point.geometric_normal) <= 0.0 {
        return vec4f(0.0);
    }
    let into_local = light.direction * frame;
    let value = bsdf_evaluate(bsdf, out_local, into_local);
    if all(value <= vec3f(0.0)) {
        return vec4f(0.0);
    }
    let scatter_pdf = bsdf_pdf(bsdf, out_local, into_local);
    // Stop short of the light, which is itself in the BVH.
    let seen = path_visibility(start, light.direction, light.distance * 0.9999, cone);
    let weight = light_mis_weight(light.pdf, scatter_pdf) * seen.x / light.pdf;
    return vec4f(value * light.radiance * weight, seen.y);
}

// Weight of an area light that a scattered ray met by chance.
fn path_light_weight(light: u32, direction: vec3f, distance: f32, scatter_pdf: f32, scatterings: u32) -> f32 {
    if scatterings == 0u || trace_frame.light_sampling == LIGHT_SAMPLING_SCATTER {
        return 1.0;
    }
    return light_mis_weight(scatter_pdf, light_pdf(light, direction, distance));
}

// Where a path is and what it has gathered.
struct PathState {
    ray: Ray,
    cone: Cone,
    throughput: vec3f,
    scatterings: u32,
    // Density of the last scattering, per solid angle.
    scatter_pdf: f32,
    // Length since the last scattering: see-through surfaces do not end a straight line.
    travelled: f32,
    ray_count: u32,
    // Radiance, and opacity of the scene in w.
    color: vec4f,
}

fn path_add(path: PathState, radiance: vec3f, scatterings: u32) -> vec4f {
    return path.color + vec4f(path_clamped(path.throughput * radiance, scatterings), 0.0);
}

// What the sky gives to a path that met nothing.
fn path_escape(path: PathState) -> vec4f {
    if path.scatterings == 0u && trace_frame.transparent_background == 1u {
        return vec4f(path.color.xyz, 0.0);
    }
    return path_add(path, light_sky(path.ray.direction), path.scatterings);
}

// What the surface's own light gives.
fn path_emission(path: PathState, material: MaterialRecord, point: SurfacePoint) -> vec4f {
    if material.light == TRACE_NONE {
        return path_add(path, material.emission.xyz, path.scatterings);
    }
    if !point.front {
        return path.color;
    }
    let weight = path_light_weight(
        material.light,
        path.ray.direction,
        path.travelled,
        path.scatter_pdf,
        path.scatterings,
    );
    return path_add(path, material.emission.xyz * weight, path.scatterings);
}

// Sends the path on in a random direction; false when it ends here.
fn path_scatter(
    path: ptr<function, PathState>,
    point: SurfacePoint,
    frame: mat3x3f,
    bsdf: Bsdf,
    out_local: vec3f,
    stream: ptr<function, u32>,
) -> bool {
    let scattered = bsdf_sample(bsdf, out_local, stream);
    let direction = frame * scattered.direction;
    // Shading normals may send light through the surface: it ends there.
    if scattered.pdf <= 0.0 || dot(direction, point.geometric_normal) <= 0.0 {
        return false;
    }
    (*path).throughput *= scattered.weight;
    (*path).scatterings += 1u;
    (*path).scatter_pdf = scattered.pdf;
    (*path).travelled = 0.0;
    (*path).cone = cone_scatter((*path).cone, scattered.pdf, trace_frame.footprint_scale);
    (*path).ray = ray_new(ray_offset(point.position, point.geometric_normal), direction, RAY_INFINITY);
    if (*path).scatterings > PATH_ROULETTE_AFTER {
        let left = (*path).throughput;
        let survive = min(max(left.x, max(left.y, left.z)), 0.95);
        if rng_next(stream) >= survive {
            return false;
        }
        (*path).throughput = left / survive;
    }
    return true;
}

// Light at the surface a path met, and the way on; false when it ends here.
fn path_shade(
    path: ptr<function, PathState>,
    material: MaterialRecord,
    point: SurfacePoint,
    base_color: vec3f,
    stream: ptr<function, u32>,
) -> bool {
    (*path).color = path_emission(*path, material, point);
    if material.light != TRACE_NONE || (*path).scatterings >= trace_frame.max_bounces {
        return false;
    }
    let frame = bsdf_frame(point.shading_normal);
    let out_local = -(*path).ray.direction * frame;
    let bsdf = bsdf_new(material, base_color, out_local);
    if trace_frame.light_count > 0u && trace_frame.light_sampling == LIGHT_SAMPLING_MIS {
        let direct = path_direct_light(point, frame, bsdf, out_local, (*path).cone, stream);
        (*path).color = path_add(*path, direct.xyz, (*path).scatterings + 1u);
        (*path).ray_count += u32(direct.w);
    }
    return path_scatter(path, point, frame, bsdf, out_local, stream);
}

fn path_trace(first_ray: Ray, first_cone: Cone, stream: ptr<function, u32>) -> PathResult {
    var path: PathState;
    path.ray = first_ray;
    path.cone = first_cone;
    path.throughput = vec3f(1.0);
    path.color = vec4f(0.0, 0.0, 0.0, 1.0);
    for (var segment = 0u; segment < PATH_MAX_SEGMENTS; segment++) {
        let hit = bvh_closest(path.ray);
        path.ray_count += 1u;
        if hit.triangle == TRACE_NONE {
            path.color = path_escape(path);
            break;
        }
        path.cone = cone_at(path.cone, hit.t);
        path.travelled += hit.t;
        let point = surface_at(path.ray, hit, path.cone);
        let material = trace_materials[point.material];
        let color = material_color(material, point);
        if color.alpha < 1.0 && rng_next(stream) >= color.alpha {
            let behind = ray_offset(point.position, -point.geometric_normal);
            path.ray = ray_new(behind, path.ray.direction, RAY_INFINITY);
            continue;
        }
        if !path_shade(&path, material, point, color.base_color, stream) {
            break;
        }
    }
    return PathResult(path.color, path.ray_count);
}
