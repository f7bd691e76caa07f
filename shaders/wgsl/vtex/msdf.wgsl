//!use core/layout
//!use core/math
//!use vtex/words
//!use vtex/settings
//!use vtex/footprint
// Signed distance from a tile, and coverage from the distance.

fn vtex_msdf_texel(vt: u32, index: u32) -> vec3f {
    return unpack4x8unorm(vtex_word(vt, index)).rgb;
}

// In texels, inside positive. `q` is the position inside the cell.
fn vtex_msdf_distance(vt: u32, tile: u32, q: vec2f) -> f32 {
    let n = vtex_settings_texels_per_cell(vt);
    // By hand: hardware filters carry 8 bits of weight, staircases when magnified.
    let x = q * f32(n);
    let corner = clamp(floor(x), vec2f(0.0), vec2f(f32(n - 1u)));
    let f = x - corner;
    let pitch = n + 1u;
    let first = vtex_word(vt, VTEX_HEADER_TILES) + tile * pitch * pitch
        + u32(corner.y) * pitch + u32(corner.x);
    let top = mix(vtex_msdf_texel(vt, first), vtex_msdf_texel(vt, first + 1u), f.x);
    let bottom = mix(
        vtex_msdf_texel(vt, first + pitch),
        vtex_msdf_texel(vt, first + pitch + 1u),
        f.x,
    );
    let m = vtex_math_median(mix(top, bottom, f.y));
    return (m - 0.5) * vtex_word_float(vt, VTEX_HEADER_DISTANCE_RANGE);
}

fn vtex_msdf_coverage(vt: u32, distance: f32, width_cells: f32) -> f32 {
    switch vtex_word(vt, VTEX_HEADER_FILTER) {
        case VTEX_FILTER_FOOTPRINT: {
            let width = width_cells * f32(vtex_settings_texels_per_cell(vt));
            return clamp(distance / max(width, 1e-6) + 0.5, 0.0, 1.0);
        }
        case VTEX_FILTER_PAPER: {
            // [SFG22] eq. 1.
            let m = distance / vtex_word_float(vt, VTEX_HEADER_DISTANCE_RANGE) + 0.5;
            let s = vtex_word_float(vt, VTEX_HEADER_SMOOTHING);
            return smoothstep(0.5 - s, 0.5 + s, m);
        }
        default: {
            return select(0.0, 1.0, distance > 0.0);
        }
    }
}
