//!use vtex/words
//!use vtex/footprint
// The fine cell a lookup falls in.

struct VtexCell {
    word: u32,
    // Position inside the cell of the file that it is a part of.
    q: vec2f,
}

fn vtex_cell(vt: VtexTexture, lookup: VtexLookup) -> VtexCell {
    let p = lookup.uv * vt.cell_from_uv.xy + vt.cell_from_uv.zw;
    let part = clamp(floor(p * vt.fine.z), vec2f(0.0), vt.fine.xy - 1.0);
    let index = u32(part.y) * u32(vt.fine.x) + u32(part.x);
    return VtexCell(vtex_word(vt, vt.cells + index), p - floor(part * vt.fine.w));
}
