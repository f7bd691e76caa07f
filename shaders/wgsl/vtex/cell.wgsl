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

// The place in the grid that is nearest to `p`, in the file's cells.
fn vtex_cell_place(vt: VtexTexture, p: vec2f) -> vec2f {
    return clamp(p, vec2f(0.0), vt.base.xy);
}

// The word of the base cell that `p` lies in.
fn vtex_cell_base(vt: VtexTexture, p: vec2f) -> u32 {
    // Through signed integers, which processors convert to at once.
    let base = vec2i(vtex_cell_place(vt, p) * vt.base.z);
    return vtex_word(vt, vt.cells + bitcast<u32>(base.y * i32(vt.base.w) + base.x));
}

fn vtex_cell_is_block(word: u32) -> bool {
    return (word >> VTEX_CELL_BLOCK_SHIFT) == VTEX_CELL_BLOCK;
}

// Of a base cell's word: how deep its block is, or 0.
fn vtex_cell_depth(word: u32) -> u32 {
    let depth = (word >> VTEX_CELL_DEPTH_SHIFT) & VTEX_CELL_DEPTH_MASK;
    return select(0u, depth, vtex_cell_is_block(word));
}

// The word of a cell of a block.
fn vtex_cell_in_block(vt: VtexTexture, block: u32, index: u32) -> u32 {
    let first = vt.cells + (block & VTEX_CELL_PLACE_MASK);
    // 1 where two cells share a word, and the first word says where their lists begin.
    let narrow = (block >> VTEX_CELL_NARROW_SHIFT) & 1u;
    let word = vtex_word(vt, first + narrow + (index >> narrow));
    let lists = vtex_word(vt, first);
    let half = (word >> ((index & narrow) * VTEX_HALF_BITS)) & VTEX_HALF_MASK;
    let tag = half >> VTEX_HALF_TAG_SHIFT;
    let base = select(0u, lists, tag >= VTEX_CELL_LIST);
    let whole = (tag << VTEX_CELL_TAG_SHIFT) | ((half & VTEX_HALF_PAYLOAD_MASK) + base);
    return select(word, whole, narrow != 0u);
}

// The cell that `p` lies in, where its base cell has `word`: of the level of this depth, which begins so
// many words behind the block's first.
fn vtex_cell_of_block(vt: VtexTexture, p: vec2f, word: u32, depth: u32, skipped: u32) -> VtexCell {
    let per_cell = bitcast<u32>(vt.base.z) + (depth << VTEX_CELL_EXPONENT_SHIFT);
    let at = floor(vtex_cell_place(vt, p) * bitcast<f32>(per_cell));
    var cell = VtexCell(word, per_cell, at);
    if vtex_cell_is_block(word) {
        let inside = bitcast<vec2u>(vec2i(at)) & vec2u((1u << depth) - 1u);
        cell.word = vtex_cell_in_block(vt, word, skipped + (inside.y << depth) + inside.x);
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
    return floor(vtex_cell_place(vt, p));
}
