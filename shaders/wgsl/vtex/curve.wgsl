//!use vtex/texture
// Where a lookup lies on the lattice of curves.

// `q` is the position inside the file's cell; in units of the cell's box.
fn vtex_curve_point(vt: VtexTexture, q: vec2f) -> vec2f {
    return q * vt.curve_units.x + vt.curve_units.y;
}
