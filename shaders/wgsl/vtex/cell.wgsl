//!use core/layout
//!use vtex/texture
// The cells: a grid of base cells, and blocks of finer ones where a base cell shows more.

struct VtexCell {
    // Never that of a block.
    word: u32,
    // How many cells of this size lie along one of the file's, a power of two, as a float's bits.
    per_cell: u32,
    // Its column and row among cells of this size.
    at: vec2f,
}

// The word of the base cell that `p`, in the file's cells, lies in.
fn vtex_cell_base(vt: VtexTexture, p: vec2f) -> u32 {
    let place = clamp(p, vec2f(0.0), vt.base.xy);
    // Through signed integers, which processors convert to at once.
    let base = vec2i(place * vt.base.z);
    return vtex_word(vt, vt.cells + bitcast<u32>(base.y * i32(vt.base.w) + base.x));
}

// Of a base cell's word: how deep its block is, or 0.
fn vtex_cell_depth(word: u32) -> u32 {
    let divided = (word >> VTEX_CELL_BLOCK_SHIFT) == VTEX_CELL_BLOCK;
    return select(0u, (word >> VTEX_CELL_DEPTH_SHIFT) & VTEX_CELL_DEPTH_MASK, divided);
}

// The cell that `p` lies in, where its base cell has `word`: of the level of this depth, which begins so
// many words behind the block's first.
fn vtex_cell_of_block(vt: VtexTexture, p: vec2f, word: u32, depth: u32, skipped: u32) -> VtexCell {
    let place = clamp(p, vec2f(0.0), vt.base.xy);
    let per_cell = bitcast<u32>(vt.base.z) + (depth << VTEX_CELL_EXPONENT_SHIFT);
    let at = floor(place * bitcast<f32>(per_cell));
    var cell = VtexCell(word, per_cell, at);
    if (word >> VTEX_CELL_BLOCK_SHIFT) == VTEX_CELL_BLOCK {
        let inside = bitcast<vec2u>(vec2i(at)) & vec2u((1u << depth) - 1u);
        let first = vt.cells + (word & VTEX_CELL_PLACE_MASK) * VTEX_CELL_BLOCK_WORDS + skipped;
        cell.word = vtex_word(vt, first + (inside.y << depth) + inside.x);
    }
    return cell;
}

// The cell that `p` lies in.
fn vtex_cell(vt: VtexTexture, p: vec2f) -> VtexCell {
    let word = vtex_cell_base(vt, p);
    return vtex_cell_of_block(vt, p, word, vtex_cell_depth(word), 0u);
}

// The side of a cell, in the file's cells: exactly 1 / per_cell.
fn vtex_cell_side(cell: VtexCell) -> f32 {
    return bitcast<f32>((254u << VTEX_CELL_EXPONENT_SHIFT) - cell.per_cell);
}

// The corner of the file's cell that `p` lies in.
fn vtex_cell_corner(vt: VtexTexture, p: vec2f) -> vec2f {
    return floor(clamp(p, vec2f(0.0), vt.base.xy));
}
