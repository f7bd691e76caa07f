//!use core/layout
//!use vtex/words
//!use vtex/footprint
// The cell a lookup falls in.

struct VtexCell {
    word: u32,
    // Position inside the cell.
    q: vec2f,
}

fn vtex_cell(vt: u32, lookup: VtexLookup) -> VtexCell {
    let p = lookup.uv * lookup.scale + vtex_word_float2(vt, VTEX_HEADER_CELL_FROM_UV_OFFSET);
    let size = vtex_word2(vt, VTEX_HEADER_GRID_SIZE);
    let cell = clamp(floor(p), vec2f(0.0), vec2f(size) - 1.0);
    let index = u32(cell.y) * size.x + u32(cell.x);
    return VtexCell(vtex_word(vt, vtex_word(vt, VTEX_HEADER_CELLS) + index), p - cell);
}
