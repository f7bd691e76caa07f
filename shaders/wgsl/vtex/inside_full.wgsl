//!use vtex/texture
// Whether an entry covers a lookup where every entry fills its cell.

fn vtex_inside_point(vt: VtexTexture, q: vec2f) -> vec2f {
    return q;
}

fn vtex_inside_winding(item: vec4u, p: vec2f) -> i32 {
    return 0;
}

fn vtex_inside(vt: VtexTexture, item: vec4u, winding: i32, q: vec2f) -> bool {
    return true;
}
