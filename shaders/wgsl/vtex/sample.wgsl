//!use vtex/texture
//!use vtex/matrix
//!use vtex/address
//!use vtex/footprint
//!use vtex/value
//!use vtex/minify
// A lookup, docs/format.md section 3.

// `first`: first word of the texture. `footprint`: axis0.uv, axis1.uv, full extents of the filter
// region. Linear light, premultiplied; a mask has its alpha in all four channels.
fn vtex_sample_at(first: u32, uv: vec2f, footprint: vec4f) -> vec4f {
    let vt = vtex_texture(first);
    let moved = vtex_matrix_point(vt, uv);
    if vtex_address_outside(vt, moved) {
        return vec4f(0.0);
    }
    let width_squared = vtex_footprint_width_squared(vt, vtex_matrix_axes(vt, footprint));
    let lookup = VtexLookup(vtex_address(vt, moved), width_squared, vec2f(0.0));
    return vtex_value_result(vt, vtex_minify(vt, lookup));
}
