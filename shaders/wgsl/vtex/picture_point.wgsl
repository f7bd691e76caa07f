//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/cell
//!use vtex/samples
//!use vtex/lists
// What the cells show to a point lookup.

// Linear light, premultiplied.
fn vtex_picture(vt: VtexTexture, lookup: VtexLookup) -> vec4f {
    let p = lookup.uv * vt.cell_from_uv.xy + vt.cell_from_uv.zw;
    let cell = vtex_cell(vt, p);
    let samples = vtex_samples_in_cell(vt, lookup, p - vtex_cell_corner(vt, p));
    return vtex_lists(vt, lookup, cell.word, samples, VTEX_SAMPLES_EVERY).sum;
}
