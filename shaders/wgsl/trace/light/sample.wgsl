//!use trace/bindings
//!use trace/rng
//!use trace/light/kinds
//!use trace/light/environment
// Aiming at lights: one is chosen by its power, then a point on it. A light is four groups of four words
// among the nodes:
//   0  corner of an area, position, or direction towards the light; its kind
//   1  first edge, or where a spot shines to; the chance that it is chosen
//   2  second edge, or a spot's falloff as scale and offset and 1 / range^4; threshold (Walker 1977)
//   3  radiance, intensity or irradiance; alias

const LIGHT_ENVIRONMENT: u32 = 0u;
// A rectangle that shines from its front.
const LIGHT_PANEL: u32 = 1u;
// A triangle of a mesh that glows, on both sides.
const LIGHT_TRIANGLE: u32 = 2u;
const LIGHT_DIRECTIONAL: u32 = 3u;
// A point is a spot that shines to all sides.
const LIGHT_SPOT: u32 = 4u;

const LIGHT_GROUPS: u32 = 4u;
// The density of a light that nothing but aiming finds.
const LIGHT_PDF_OF_POINTS: f32 = 3.0e38;

struct LightSample {
    direction: vec3f,
    distance: f32,
    // Radiance over density.
    estimate: vec3f,
    // Per solid angle, the choice of the light included; 0 where it does not shine to.
    pdf: f32,
}

fn light_words(light: u32, group: u32) -> vec4u {
    return trace_nodes[trace_frame.light_first + LIGHT_GROUPS * light + group];
}

fn light_choose(stream: ptr<function, u32>) -> u32 {
    let light = rng_below(stream, trace_frame.light_count);
    let keeps = rng_next(stream) < bitcast<f32>(light_words(light, 2u).w);
    return select(light_words(light, 3u).w, light, keeps);
}

// A point on one of the lights, of which there is at least one, seen from `point`.
fn light_sample(point: vec3f, stream: ptr<function, u32>) -> LightSample {
    let light = light_choose(stream);
    let xi = rng_next2(stream);
    let place = light_words(light, 0u);
    let first = bitcast<vec4f>(light_words(light, 1u));
    if LIGHTS_HAVE_ENVIRONMENT && place.w == LIGHT_ENVIRONMENT {
        let found = environment_sample(xi, stream);
        let pdf = found.pdf * first.w;
        let estimate = environment_radiance(found.direction) / max(pdf, 1e-30);
        return LightSample(found.direction, trace_frame.reach, estimate, pdf);
    }
    let second = bitcast<vec3f>(light_words(light, 2u).xyz);
    let radiance = bitcast<vec3f>(light_words(light, 3u).xyz);
    let corner = bitcast<vec3f>(place.xyz);
    if LIGHTS_HAVE_PUNCTUAL && place.w >= LIGHT_DIRECTIONAL {
        return light_punctual(point, place.w, corner, first, second, radiance);
    }
    if LIGHTS_HAVE_AREAS {
        return light_area(point, place.w, corner, first, second, radiance, xi);
    }
    return LightSample();
}

fn light_area(
    point: vec3f,
    kind: u32,
    corner: vec3f,
    first: vec4f,
    second: vec3f,
    radiance: vec3f,
    xi: vec2f,
) -> LightSample {
    let is_triangle = kind == LIGHT_TRIANGLE;
    // The upper half of the parallelogram is folded onto the lower one.
    let at = select(xi, 1.0 - xi, is_triangle && xi.x + xi.y > 1.0);
    let offset = corner + at.x * first.xyz + at.y * second - point;
    let distance_squared = dot(offset, offset);
    let distance = sqrt(distance_squared);
    let direction = offset / max(distance, 1e-20);
    // Area of the parallelogram, as it is seen.
    let front = -dot(cross(first.xyz, second), direction);
    let area = select(front, 0.5 * abs(front), is_triangle);
    if area <= 0.0 {
        return LightSample();
    }
    let pdf = first.w * distance_squared / area;
    return LightSample(direction, distance, radiance / max(pdf, 1e-30), pdf);
}

// KHR_lights_punctual: falloff by distance, range and angle.
fn light_punctual(
    point: vec3f,
    kind: u32,
    place: vec3f,
    first: vec4f,
    second: vec3f,
    intensity: vec3f,
) -> LightSample {
    if kind == LIGHT_DIRECTIONAL {
        return LightSample(place, trace_frame.reach, intensity / first.w, LIGHT_PDF_OF_POINTS);
    }
    let offset = place - point;
    let distance_squared = max(dot(offset, offset), 1e-20);
    let distance = sqrt(distance_squared);
    let direction = offset / distance;
    let angular = clamp(-dot(first.xyz, direction) * second.x + second.y, 0.0, 1.0);
    let window = clamp(1.0 - distance_squared * distance_squared * second.z, 0.0, 1.0);
    let falloff = angular * angular * window / distance_squared;
    if falloff <= 0.0 {
        return LightSample();
    }
    return LightSample(direction, distance, intensity * (falloff / first.w), LIGHT_PDF_OF_POINTS);
}

// Density with which light_sample would have found a point of an area whose light is chosen with
// `density` per area, met at `distance` at an angle of this cosine.
fn light_area_pdf(density: f32, cosine: f32, distance: f32) -> f32 {
    return density * distance * distance / max(cosine, 1e-20);
}

// Power heuristic, Veach 1997 eq. 9.13 with beta = 2.
fn light_mis_weight(pdf: f32, other_pdf: f32) -> f32 {
    let ratio = other_pdf / pdf;
    return 1.0 / (1.0 + ratio * ratio);
}
