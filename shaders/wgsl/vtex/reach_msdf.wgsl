//!use core/layout
//!use vtex/texture
//!use vtex/msdf
// The signed distance of an entry whose edge can be an MSDF tile alone.

fn vtex_reach_point(vt: VtexTexture, q: vec2f) -> vec2f {
    return q;
}

fn vtex_reach_squared(vt: VtexTexture) -> f32 {
    return 0.0;
}

fn vtex_reach_winding(item: vec4u, p: vec2f) -> i32 {
    return 0;
}

fn vtex_reach_distance_squared(vt: VtexTexture, item: vec4u, p: vec2f) -> f32 {
    return 0.0;
}

// In texels, inside positive; where the entry fills its cell, far inside.
fn vtex_reach_texels(
    vt: VtexTexture,
    item: vec4u,
    winding: i32,
    nearest: f32,
    q: vec2f,
) -> f32 {
    if (item.w & VTEX_ITEM_KIND_MASK) != VTEX_ITEM_MSDF {
        return 1e9;
    }
    return vtex_msdf_distance(vt, item.x, q);
}
