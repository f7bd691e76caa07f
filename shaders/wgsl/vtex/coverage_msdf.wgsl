//!use core/layout
//!use vtex/footprint
//!use vtex/msdf
// Coverage of an entry: MSDF tile, or the whole cell. An image fills its cell and is transparent
// outside its rectangle.

fn vtex_coverage(vt: u32, entry: vec2u, lookup: VtexLookup) -> f32 {
    if (entry.x >> VTEX_ENTRY_KIND_SHIFT) != VTEX_ENTRY_MSDF {
        return 1.0;
    }
    let distance = vtex_msdf_distance(vt, entry.y, lookup.q);
    return vtex_msdf_coverage(vt, distance, lookup.width_cells);
}
