//!use vtex/sample
//!use trace/bindings
//!use trace/surface
// A surface's own colours.

struct MaterialColor {
    // Linear, straight.
    base_color: vec3f,
    // Share of the rays that the surface stops.
    alpha: f32,
}

fn material_color(material: MaterialRecord, point: SurfacePoint) -> MaterialColor {
    // Without a texture a backing is never seen.
    if material.texture_word == TRACE_NONE {
        return MaterialColor(material.base_color.xyz, 1.0);
    }
    let texel = vtex_sample_at(material.texture_word, point.uv, point.footprint);
    if material.backing.w > 0.0 {
        let backed = texel.rgb * material.base_color.xyz + (1.0 - texel.a) * material.backing.xyz;
        return MaterialColor(backed, 1.0);
    }
    let straight = texel.rgb / max(texel.a, 1e-6);
    return MaterialColor(straight * material.base_color.xyz, texel.a);
}
