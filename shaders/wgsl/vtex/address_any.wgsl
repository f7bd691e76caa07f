//!use core/layout
//!use vtex/settings
// Address modes: what a lookup outside [0, 1] sees.

fn vtex_address_axis(t: f32, mode: u32) -> f32 {
    switch mode {
        case VTEX_ADDRESS_REPEAT: {
            return t - floor(t);
        }
        case VTEX_ADDRESS_MIRROR: {
            let turn = t - 2.0 * floor(t * 0.5);
            return select(turn, 2.0 - turn, turn > 1.0);
        }
        default: {
            return clamp(t, 0.0, 1.0);
        }
    }
}

fn vtex_address(vt: VtexTexture, uv: vec2f) -> vec2f {
    let modes = vtex_settings_address(vt);
    return vec2f(vtex_address_axis(uv.x, modes.x), vtex_address_axis(uv.y, modes.y));
}

fn vtex_address_axis_outside(t: f32, mode: u32) -> bool {
    return mode == VTEX_ADDRESS_BORDER && (t < 0.0 || t > 1.0);
}

// By axis: naga does not read its own SPIR-V back where `&` and `|` join vectors of bool.
fn vtex_address_outside(vt: VtexTexture, uv: vec2f) -> bool {
    let modes = vtex_settings_address(vt);
    return vtex_address_axis_outside(uv.x, modes.x) || vtex_address_axis_outside(uv.y, modes.y);
}

// Axes along which the filter of image 0 reaches round to the other side.
fn vtex_address_wraps(vt: VtexTexture) -> vec2<bool> {
    return vtex_settings_address(vt) == vec2u(VTEX_ADDRESS_REPEAT);
}
