//!use trace/bindings
// What the GGX lobe of bsdf.wgsl reflects in all directions by single scattering, as a table among the
// nodes: for each of 32 roughnesses and 32 views the part that Fresnel's term is multiplied with and the part
// that is there in any case (Schlick), then the same for the next view.

const ALBEDO_STEPS: u32 = 32u;

fn albedo_row(row: u32, column: u32, along: f32) -> vec2f {
    let place = trace_frame.albedo_first + row * ALBEDO_STEPS + column;
    let both = bitcast<vec4f>(trace_nodes[place]);
    return mix(both.xy, both.zw, along);
}

fn albedo_of(cosine: f32, ggx_alpha: f32) -> vec2f {
    // Roots, since it changes most at grazing views and on smooth surfaces.
    let place = sqrt(clamp(vec2f(cosine, ggx_alpha), vec2f(0.0), vec2f(1.0))) * f32(ALBEDO_STEPS - 1u);
    let first = min(vec2u(place), vec2u(ALBEDO_STEPS - 2u));
    let along = place - vec2f(first);
    return mix(albedo_row(first.y, first.x, along.x), albedo_row(first.y + 1u, first.x, along.x), along.y);
}
