//!use vtex/texture
// The fine cells.

// Column and row of the fine cell that `p`, in cells, lies in.
fn vtex_cell_fine(vt: VtexTexture, p: vec2f) -> vec2f {
    return clamp(floor(p * vt.fine.z), vec2f(0.0), vt.fine.xy - 1.0);
}

fn vtex_cell_word(vt: VtexTexture, fine: vec2f) -> u32 {
    // Through signed integers, which processors convert to at once.
    let index = i32(fine.y) * i32(vt.fine.x) + i32(fine.x);
    return vtex_word(vt, vt.cells + bitcast<u32>(index));
}
