//!use core/layout
//!use vtex/texture
//!use vtex/settings
//!use vtex/mapping_inset
// From the place that a lookup names to the place on the canvas: texture matrix, then address modes.

// In uv: what is smaller is a point.
const VTEX_MAPPING_LEAST_EXTENT: f32 = 1e-12;

fn vtex_mapping_linear(vt: VtexTexture, v: vec2f) -> vec2f {
    let m = vtex_word_float4(vt, VTEX_HEADER_TEXTURE_MATRIX);
    return vec2f(m.x * v.x + m.z * v.y, m.y * v.x + m.w * v.y);
}

fn vtex_mapping_point(vt: VtexTexture, uv: vec2f) -> vec2f {
    if !vtex_settings_has(vt, VTEX_FEATURE_MAPPING) {
        return uv;
    }
    return vtex_mapping_linear(vt, uv) + vtex_word_float2(vt, VTEX_HEADER_TEXTURE_MATRIX + 4u);
}

fn vtex_mapping_axes(vt: VtexTexture, axes: vec4f) -> vec4f {
    if !vtex_settings_has(vt, VTEX_FEATURE_MAPPING) {
        return axes;
    }
    return vec4f(vtex_mapping_linear(vt, axes.xy), vtex_mapping_linear(vt, axes.zw));
}

// A place in a canvas and its mirrored copy, which follows from 1 to 2.
fn vtex_mapping_turn(t: f32) -> f32 {
    return t - 2.0 * floor(t * 0.5);
}

fn vtex_mapping_axis(t: f32, mode: u32) -> f32 {
    switch mode {
        case VTEX_ADDRESS_REPEAT: {
            return t - floor(t);
        }
        case VTEX_ADDRESS_MIRROR: {
            let turn = vtex_mapping_turn(t);
            return select(turn, 2.0 - turn, turn > 1.0);
        }
        // Clamped in any mode.
        default: {
            return t;
        }
    }
}

// Axes in uv, after the matrix. In clamp mode, beyond a side of the canvas all of a footprint shows what
// the side does. In mirror mode, what is mirrored is so with its footprint.
fn vtex_mapping_kept(vt: VtexTexture, uv: vec2f, axes: vec4f) -> vec4f {
    let clamps = vt.address == vec2u(VTEX_ADDRESS_CLAMP);
    let placed = select(uv, clamp(uv, vec2f(0.0), vec2f(1.0)), clamps);
    let turn = vec2f(vtex_mapping_turn(uv.x), vtex_mapping_turn(uv.y));
    let turned = select(vec2f(1.0), vec2f(-1.0), turn > vec2f(1.0));
    let sign = select(vec2f(1.0), turned, vt.address == vec2u(VTEX_ADDRESS_MIRROR));
    return select(vec4f(0.0), sign.xyxy * axes, (placed == uv).xyxy);
}

fn vtex_mapping_address(vt: VtexTexture, uv: vec2f) -> vec2f {
    let inset = vtex_mapping_inset(vt);
    let u = vtex_mapping_axis(uv.x, vt.address.x);
    let v = vtex_mapping_axis(uv.y, vt.address.y);
    return clamp(vec2f(u, v), inset, 1.0 - inset);
}

// How much of `extent` about `t` lies within 0 and 1 in border mode.
fn vtex_mapping_axis_share(t: f32, extent: f32, mode: u32) -> f32 {
    // What lies without, so that nothing is lost to rounding where all lies within.
    let outside = max(0.5 * extent - t, 0.0) + max(t + 0.5 * extent - 1.0, 0.0);
    let share = clamp(1.0 - outside / max(extent, VTEX_MAPPING_LEAST_EXTENT), 0.0, 1.0);
    let placed = select(0.0, 1.0, t >= 0.0 && t <= 1.0);
    let bordered = select(share, placed, extent < VTEX_MAPPING_LEAST_EXTENT);
    return select(1.0, bordered, mode == VTEX_ADDRESS_BORDER);
}

// How much of a footprint lies on the canvas in border mode, as if it were upright.
fn vtex_mapping_share(vt: VtexTexture, uv: vec2f, axes: vec4f) -> f32 {
    let wide = vtex_settings_has(vt, VTEX_FEATURE_FOOTPRINT);
    let extent = select(vec2f(0.0), abs(axes.xy) + abs(axes.zw), vec2<bool>(wide));
    return vtex_mapping_axis_share(uv.x, extent.x, vt.address.x)
        * vtex_mapping_axis_share(uv.y, extent.y, vt.address.y);
}

// Axes along which the filter of image 0 reaches round to the other side.
fn vtex_mapping_wraps(vt: VtexTexture) -> vec2<bool> {
    return vt.address == vec2u(VTEX_ADDRESS_REPEAT);
}
