//!use trace/bindings
//!use trace/ray
//!use trace/cone
//!use trace/surface
//!use trace/material
//!use trace/bsdf
//!use trace/layer/kinds
//!use trace/layer/glass
//!use trace/light/far
//!use trace/light/sample
//!use trace/rng
// The steps of a path: Kajiya 1986, with next-event estimation and multiple importance sampling
// (Veach 1997). One kernel takes them in a loop (path/integrator), or each stage takes one (stage/).

// See-through surfaces that a path and its shadow rays pass in all; behind them it is dark.
const PATH_MAX_VEILS: u32 = 64u;
// Scatterings after which paths may end by chance (Russian roulette).
const PATH_ROULETTE_AFTER: u32 = 3u;

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
    // See-through surfaces that it and its shadow rays passed.
    veils: u32,
    ray_count: u32,
    // Radiance, and opacity of the scene in w.
    color: vec4f,
}

// A ray from a surface to a light.
struct ShadowRay {
    origin: vec3f,
    direction: vec3f,
    // What is left to go; 0 where no ray is wanted.
    left: f32,
    // The whole way.
    distance: f32,
    // What the path gains where nothing is in the way, not clamped.
    radiance: vec3f,
    // Share that the surfaces passed so far let through.
    share: f32,
    // Where the ray starts.
    cone: Cone,
    // Scatterings of the light that it brings.
    scatterings: u32,
}

fn path_new(ray: Ray, cone: Cone) -> PathState {
    return PathState(ray, cone, vec3f(1.0), 0u, 0.0, 0.0, 0u, 0u, vec4f(0.0, 0.0, 0.0, 1.0));
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

fn path_add(path: PathState, radiance: vec3f) -> vec4f {
    return path.color + vec4f(path_clamped(path.throughput * radiance, path.scatterings), 0.0);
}

// Whether the light that a path meets could have been found by aiming as well.
fn path_is_aimed(path: PathState) -> bool {
    return path.scatterings != 0u && trace_frame.light_sampling == LIGHT_SAMPLING_MIS;
}

// What lies behind everything, for a path that met nothing.
fn path_escape(path: PathState) -> vec4f {
    if path.scatterings == 0u && trace_frame.transparent_background == 1u {
        return vec4f(path.color.xyz, 0.0);
    }
    let radiance = light_far(path.ray.direction);
    if LIGHTS_HAVE_ENVIRONMENT && path_is_aimed(path) {
        let weight = light_mis_weight(path.scatter_pdf, light_far_pdf(path.ray.direction));
        return path_add(path, radiance * weight);
    }
    return path_add(path, radiance);
}

// Moves a path to the surface that it met.
fn path_arrive(path: ptr<function, PathState>, distance: f32) {
    (*path).cone = cone_at((*path).cone, distance);
    (*path).travelled += distance;
}

// Sends a path straight through a surface; false when it ends here.
fn path_pass(path: ptr<function, PathState>, point: SurfacePoint) -> bool {
    let behind = ray_offset(point.position, -point.geometric_normal);
    (*path).ray = ray_new(behind, (*path).ray.direction, RAY_INFINITY);
    (*path).veils += 1u;
    return (*path).veils <= PATH_MAX_VEILS;
}

// Takes what a body absorbed on the way to its other side.
fn path_absorb(path: ptr<function, PathState>, material: MaterialRecord, point: SurfacePoint, distance: f32) {
    if LAYERS_HAVE_GLASS && material.glass.w > 0.0 && !point.front {
        (*path).throughput *= exp(-material.glass.xyz * distance);
    }
}

// What the surface's own light gives, and its colour where it shows that alone.
fn path_emission(path: PathState, material: MaterialRecord, point: SurfacePoint, base_color: vec3f) -> vec4f {
    if material.surface == SURFACE_UNLIT {
        return path_add(path, material.emission.xyz + base_color);
    }
    if material.is_panel == 1u && !point.front {
        return path.color;
    }
    var emission = material.emission.xyz;
    if LIGHTS_HAVE_AREAS && material.light_density > 0.0 && path_is_aimed(path) {
        let cosine = -dot(point.geometric_normal, path.ray.direction);
        let pdf = light_area_pdf(material.light_density, cosine, path.travelled);
        emission *= light_mis_weight(path.scatter_pdf, pdf);
    }
    return path_add(path, emission);
}

// How a surface scatters what comes along the path, seen from its shading normal: one of its layers.
struct PathLobes {
    frame: mat3x3f,
    out_local: vec3f,
    bsdf: Bsdf,
    // What the layer's light is multiplied by, for the chance that it was chosen.
    scale: f32,
    // Instead of all that: light is reflected by glass or goes through.
    is_glass: bool,
}

// A layer is chosen as often as it reflects or passes what comes to it, so that one at a time is enough.
fn path_lobes(
    path: PathState,
    material: MaterialRecord,
    point: SurfacePoint,
    base_color: vec3f,
    stream: ptr<function, u32>,
) -> PathLobes {
    let frame = bsdf_frame(point.shading_normal);
    let out_local = -path.ray.direction * frame;
    if LAYERS_HAVE_COATS && material.coat > 0.0 {
        let coat = bsdf_coat(material.coat_alpha, out_local);
        if rng_next(stream) < material.coat * coat.reflected {
            return PathLobes(frame, out_local, coat.bsdf, 1.0 / coat.reflected, false);
        }
    }
    let bsdf = bsdf_new(material, base_color, out_local);
    var is_glass = false;
    if LAYERS_HAVE_GLASS && material.transmission > 0.0 {
        is_glass = rng_next(stream) < material.transmission;
    }
    return PathLobes(frame, out_local, bsdf, 1.0, is_glass);
}

// Whether a path ends at a surface whose own light it has.
fn path_ends(path: PathState, material: MaterialRecord) -> bool {
    return material.is_panel == 1u || material.surface == SURFACE_UNLIT || path.scatterings >= trace_frame.max_bounces;
}

// A ray to a point on a light, if that can light the surface.
fn path_shadow_ray(path: PathState, point: SurfacePoint, lobes: PathLobes, stream: ptr<function, u32>) -> ShadowRay {
    var shadow: ShadowRay;
    if trace_frame.light_count == 0u || trace_frame.light_sampling != LIGHT_SAMPLING_MIS {
        return shadow;
    }
    if LAYERS_HAVE_GLASS && lobes.is_glass {
        return shadow;
    }
    shadow.origin = ray_offset(point.position, point.geometric_normal);
    let light = light_sample(shadow.origin, stream);
    if light.pdf <= 0.0 || dot(light.direction, point.geometric_normal) <= 0.0 {
        return shadow;
    }
    let into_local = light.direction * lobes.frame;
    let value = bsdf_evaluate(lobes.bsdf, lobes.out_local, into_local);
    if all(value <= vec3f(0.0)) {
        return shadow;
    }
    let scatter_pdf = bsdf_pdf(lobes.bsdf, lobes.out_local, into_local);
    let weight = light_mis_weight(light.pdf, scatter_pdf);
    shadow.direction = light.direction;
    // Stop short of the light, which is itself in the BVH.
    shadow.distance = light.distance * 0.9999;
    shadow.left = shadow.distance;
    shadow.radiance = path.throughput * value * light.estimate * (weight * lobes.scale);
    shadow.share = 1.0;
    shadow.cone = path.cone;
    shadow.scatterings = path.scatterings + 1u;
    return shadow;
}

// What a shadow ray brings that nothing stopped.
fn path_lit(color: vec4f, shadow: ShadowRay) -> vec4f {
    return color + vec4f(path_clamped(shadow.radiance * shadow.share, shadow.scatterings), 0.0);
}

// The cone where a shadow ray met something.
fn path_shadow_cone(shadow: ShadowRay, distance: f32) -> Cone {
    return cone_at(shadow.cone, shadow.distance - shadow.left + distance);
}

// Sends a shadow ray through a surface; false when nothing is left of it.
fn path_shadow_pass(shadow: ptr<function, ShadowRay>, point: SurfacePoint, distance: f32, alpha: f32) -> bool {
    (*shadow).share *= 1.0 - alpha;
    (*shadow).origin = ray_offset(point.position, -point.geometric_normal);
    (*shadow).left -= distance;
    return (*shadow).share > 0.0 && (*shadow).left > 0.0;
}

// Sends the path on in a random direction; false when it ends here.
fn path_scatter(
    path: ptr<function, PathState>,
    point: SurfacePoint,
    lobes: PathLobes,
    stream: ptr<function, u32>,
) -> bool {
    let scattered = bsdf_sample(lobes.bsdf, lobes.out_local, stream);
    let direction = lobes.frame * scattered.direction;
    // Shading normals may send light through the surface: it ends there.
    if scattered.pdf <= 0.0 || dot(direction, point.geometric_normal) <= 0.0 {
        return false;
    }
    (*path).throughput *= scattered.weight * lobes.scale;
    (*path).scatter_pdf = scattered.pdf;
    (*path).cone = cone_scatter((*path).cone, scattered.pdf, trace_frame.footprint_scale);
    (*path).ray = ray_new(ray_offset(point.position, point.geometric_normal), direction, RAY_INFINITY);
    return path_goes_on(path, stream);
}

// Sends the path on by glass, whose light nothing aims at: what it meets next counts in full.
fn path_refract(
    path: ptr<function, PathState>,
    point: SurfacePoint,
    lobes: PathLobes,
    material: MaterialRecord,
    base_color: vec3f,
    stream: ptr<function, u32>,
) -> bool {
    let glass = glass_sample(lobes.out_local, material, base_color, point.front, stream);
    let direction = lobes.frame * glass.direction;
    let side = select(point.geometric_normal, -point.geometric_normal, glass.passes);
    if all(glass.weight <= vec3f(0.0)) || dot(direction, side) <= 0.0 {
        return false;
    }
    (*path).throughput *= glass.weight;
    (*path).scatter_pdf = LIGHT_PDF_OF_POINTS;
    (*path).ray = ray_new(ray_offset(point.position, side), direction, RAY_INFINITY);
    return path_goes_on(path, stream);
}

// Counts a scattering; false where the path ends by chance.
fn path_goes_on(path: ptr<function, PathState>, stream: ptr<function, u32>) -> bool {
    (*path).scatterings += 1u;
    (*path).travelled = 0.0;
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
