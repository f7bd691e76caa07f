//!use core/layout
// Blend modes that take each channel by itself: Compositing and Blending Level 1, section 10.1.
// `b` is the backdrop, `s` the source, straight.

fn vtex_blend_screen(b: vec3f, s: vec3f) -> vec3f {
    return b + s - b * s;
}

fn vtex_blend_hard_light(b: vec3f, s: vec3f) -> vec3f {
    return select(vtex_blend_screen(b, 2.0 * s - 1.0), 2.0 * b * s, s <= vec3f(0.5));
}

fn vtex_blend_color_dodge(b: vec3f, s: vec3f) -> vec3f {
    let dodged = min(b / max(1.0 - s, vec3f(1e-6)), vec3f(1.0));
    return select(select(dodged, vec3f(1.0), s >= vec3f(1.0)), vec3f(0.0), b <= vec3f(0.0));
}

fn vtex_blend_color_burn(b: vec3f, s: vec3f) -> vec3f {
    let burnt = 1.0 - min((1.0 - b) / max(s, vec3f(1e-6)), vec3f(1.0));
    return select(select(burnt, vec3f(0.0), s <= vec3f(0.0)), vec3f(1.0), b >= vec3f(1.0));
}

fn vtex_blend_soft_light(b: vec3f, s: vec3f) -> vec3f {
    let low = ((16.0 * b - 12.0) * b + 4.0) * b;
    let d = select(sqrt(max(b, vec3f(0.0))), low, b <= vec3f(0.25));
    let lighter = b + (2.0 * s - 1.0) * (d - b);
    let darker = b - (1.0 - 2.0 * s) * b * (1.0 - b);
    return select(lighter, darker, s <= vec3f(0.5));
}

fn vtex_blend_separable(mode: u32, b: vec3f, s: vec3f) -> vec3f {
    switch mode {
        case VTEX_BLEND_MULTIPLY: {
            return b * s;
        }
        case VTEX_BLEND_SCREEN: {
            return vtex_blend_screen(b, s);
        }
        case VTEX_BLEND_OVERLAY: {
            return vtex_blend_hard_light(s, b);
        }
        case VTEX_BLEND_DARKEN: {
            return min(b, s);
        }
        case VTEX_BLEND_LIGHTEN: {
            return max(b, s);
        }
        case VTEX_BLEND_COLOR_DODGE: {
            return vtex_blend_color_dodge(b, s);
        }
        case VTEX_BLEND_COLOR_BURN: {
            return vtex_blend_color_burn(b, s);
        }
        case VTEX_BLEND_HARD_LIGHT: {
            return vtex_blend_hard_light(b, s);
        }
        case VTEX_BLEND_SOFT_LIGHT: {
            return vtex_blend_soft_light(b, s);
        }
        case VTEX_BLEND_DIFFERENCE: {
            return abs(b - s);
        }
        default: {
            // Exclusion.
            return b + s - 2.0 * b * s;
        }
    }
}
