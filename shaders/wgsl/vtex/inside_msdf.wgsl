//!use core/layout
//!use vtex/texture
//!use vtex/msdf
// Whether an entry covers a lookup, where its edge can be an MSDF tile alone.

fn vtex_inside_point(vt: VtexTexture, q: vec2f) -> vec2f {
    return q;
}

fn vtex_inside_winding(item: vec4u, p: vec2f) -> i32 {
    return 0;
}

fn vtex_inside(vt: VtexTexture, item: vec4u, winding: i32, q: vec2f) -> bool {
    return (item.w & VTEX_ITEM_KIND_MASK) != VTEX_ITEM_MSDF
        || vtex_msdf_distance(vt, item.x, q) > 0.0;
}
