//!use vtex/footprint
//!use vtex/paint
// What a paint shows at a lookup where all paints are solid.

fn vtex_fill(vt: VtexTexture, index: u32, lookup: VtexLookup) -> VtexValue {
    return vtex_paint_solid(vt, index);
}
