//!use core/layout
//!use vtex/texture
// Signed distance from a tile.

fn vtex_msdf_median(v: vec3f) -> f32 {
    return max(min(v.x, v.y), min(max(v.x, v.y), v.z));
}

fn vtex_msdf_texel(vt: VtexTexture, index: u32) -> vec3f {
    return unpack4x8unorm(vtex_word(vt, index)).rgb;
}

// In texels, inside positive. `q` is the position inside the file's cell.
fn vtex_msdf_distance(vt: VtexTexture, tile: u32, q: vec2f) -> f32 {
    let n = vt.texels_per_cell;
    // By hand: hardware filters carry 8 bits of weight, staircases when magnified.
    let x = q * f32(n);
    let corner = clamp(floor(x), vec2f(0.0), vec2f(f32(n - 1u)));
    let f = x - corner;
    let pitch = n + 1u;
    let first = vt.tiles + tile * pitch * pitch
        + u32(corner.y) * pitch + u32(corner.x);
    let top = mix(vtex_msdf_texel(vt, first), vtex_msdf_texel(vt, first + 1u), f.x);
    let bottom = mix(
        vtex_msdf_texel(vt, first + pitch),
        vtex_msdf_texel(vt, first + pitch + 1u),
        f.x,
    );
    let m = vtex_msdf_median(mix(top, bottom, f.y));
    return (m - 0.5) * vtex_word_float(vt, VTEX_HEADER_DISTANCE_RANGE);
}
