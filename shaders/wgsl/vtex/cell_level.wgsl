//!use core/layout
//!use vtex/texture
//!use vtex/cell
// Coarser cells, for footprints that would lie in many: a block has, behind its cells, levels of such
// as are halved 4, 2 or no times from a cell of the file, from fine to coarse.

// The cell that `p` lies in, on the finest level on which no more than 2 to `most` lie along one of the
// file's, or on the coarsest that its block has.
fn vtex_cell_level(vt: VtexTexture, p: vec2f, most: i32) -> VtexCell {
    let word = vtex_cell_base(vt, p);
    let depth = vtex_cell_depth(word);
    // Halvings of a cell of the file.
    let halved = bitcast<i32>(bitcast<u32>(vt.base.z) >> VTEX_CELL_EXPONENT_SHIFT) - 127;
    let finest = halved + bitcast<i32>(depth);
    let coarsest = (max(halved, 0) + 1) & -2;
    let above = (finest - 1) & -2;
    let is_fine = most >= finest || above < coarsest;
    let chosen = min(max(most & -2, coarsest), above);
    let chosen_depth = bitcast<u32>(chosen - halved);
    // 16 + 256 + ... times the words of the chosen level lie between the block's cells and it.
    let finer = bitcast<u32>(above - chosen) & 31u;
    let between = (0x11111111u & ((1u << (2u * finer)) - 1u)) << ((2u * chosen_depth + 4u) & 31u);
    let skipped = select((1u << (2u * depth)) + between, 0u, is_fine);
    return vtex_cell_of_block(vt, p, word, select(chosen_depth, depth, is_fine), skipped);
}
