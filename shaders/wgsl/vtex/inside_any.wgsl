//!use core/layout
//!use vtex/texture
//!use vtex/curve
//!use vtex/msdf
//!use vtex/segment
//!use vtex/winding
// Whether an entry covers a lookup: by its curves or its MSDF tile.

fn vtex_inside_point(vt: VtexTexture, q: vec2f) -> vec2f {
    return vtex_curve_point(vt, q);
}

fn vtex_inside_winding(item: vec4u, p: vec2f) -> i32 {
    return vtex_segment_winding(item, p);
}

// `item` is the entry's last, `winding` that of all its items.
fn vtex_inside(vt: VtexTexture, item: vec4u, winding: i32, q: vec2f) -> bool {
    switch item.w & VTEX_ITEM_KIND_MASK {
        case VTEX_ITEM_CURVES: {
            return vtex_winding_fills(item.w, winding);
        }
        case VTEX_ITEM_MSDF: {
            return vtex_msdf_distance(vt, item.x, q) > 0.0;
        }
        default: {
            return true;
        }
    }
}
