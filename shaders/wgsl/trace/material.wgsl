//!use trace/layout
// A surface's own colours.

struct MaterialColor {
    // Linear, straight.
    base_color: vec3f,
    // Share of the rays that the surface stops.
    alpha: f32,
}

// `texel` is what the material's texture shows; it is not read where there is none.
fn material_color(material: MaterialRecord, texel: vec4f) -> MaterialColor {
    // Without a texture a backing is never seen.
    if material.texture_word == TRACE_NONE {
        return MaterialColor(material.base_color.xyz, 1.0);
    }
    if material.backing.w > 0.0 {
        let backed = texel.rgb * material.base_color.xyz + (1.0 - texel.a) * material.backing.xyz;
        return MaterialColor(backed, 1.0);
    }
    let straight = texel.rgb / max(texel.a, 1e-6);
    return MaterialColor(straight * material.base_color.xyz, texel.a);
}
