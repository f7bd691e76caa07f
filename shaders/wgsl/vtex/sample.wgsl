//!use core/layout
//!use vtex/texture
//!use vtex/settings
//!use vtex/mapping
//!use vtex/lookup
//!use vtex/minify
// A lookup, docs/format.md section 3.

// `first`: first word of the texture. `footprint`: axis0.uv, axis1.uv, full extents of the filter
// region. Linear light, premultiplied; a mask has its alpha in all four channels.
fn vtex_sample_at(first: u32, uv: vec2f, footprint: vec4f) -> vec4f {
    let vt = vtex_texture(first);
    let moved = vtex_mapping_point(vt, uv);
    let region = vtex_mapping_axes(vt, footprint);
    let share = vtex_mapping_share(vt, moved, region);
    // Also where it is no number.
    if !(share > 0.0) {
        return vec4f(0.0);
    }
    let place = vtex_mapping_address(vt, moved);
    let lookup = vtex_lookup(vt, place, vtex_mapping_kept(vt, moved, region));
    let color = share * vtex_minify(vt, lookup);
    return select(color, vec4f(color.a), vtex_settings_has(vt, VTEX_FEATURE_MASK));
}
