//!use core/layout
// Blend modes: Compositing and Blending Level 1. All colours sRGB-encoded. `b` is the backdrop, `s`
// the source, straight.

// Section 10.1: modes that take each channel by itself.
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

// Section 10.2: modes that take the channels together.
fn vtex_blend_lum(c: vec3f) -> f32 {
    return dot(c, vec3f(0.3, 0.59, 0.11));
}

fn vtex_blend_least(c: vec3f) -> f32 {
    return min(min(c.r, c.g), c.b);
}

fn vtex_blend_most(c: vec3f) -> f32 {
    return max(max(c.r, c.g), c.b);
}

// ClipColor(c + (luminosity - Lum(c))), so that its luminosity is the one asked for.
fn vtex_blend_set_lum(c: vec3f, luminosity: f32) -> vec3f {
    let moved = c + (luminosity - vtex_blend_lum(c));
    let lum = vtex_blend_lum(moved);
    let least = vtex_blend_least(moved);
    let most = vtex_blend_most(moved);
    var clipped = moved;
    if least < 0.0 {
        clipped = lum + (clipped - lum) * lum / (lum - least);
    }
    if most > 1.0 {
        clipped = lum + (clipped - lum) * (1.0 - lum) / (most - lum);
    }
    return clipped;
}

fn vtex_blend_set_sat(c: vec3f, saturation: f32) -> vec3f {
    let least = vtex_blend_least(c);
    let range = vtex_blend_most(c) - least;
    return select(vec3f(0.0), (c - least) * saturation / max(range, 1e-6), range > 0.0);
}

fn vtex_blend_sat(c: vec3f) -> f32 {
    return vtex_blend_most(c) - vtex_blend_least(c);
}

fn vtex_blend_hue(mode: u32, b: vec3f, s: vec3f) -> vec3f {
    switch mode {
        case VTEX_BLEND_HUE: {
            return vtex_blend_set_lum(vtex_blend_set_sat(s, vtex_blend_sat(b)), vtex_blend_lum(b));
        }
        case VTEX_BLEND_SATURATION: {
            return vtex_blend_set_lum(vtex_blend_set_sat(b, vtex_blend_sat(s)), vtex_blend_lum(b));
        }
        case VTEX_BLEND_COLOR: {
            return vtex_blend_set_lum(s, vtex_blend_lum(b));
        }
        default: {
            // Luminosity.
            return vtex_blend_set_lum(b, vtex_blend_lum(s));
        }
    }
}

// Section 5.8. Both sides premultiplied, not empty.
fn vtex_blend(mode: u32, behind: vec4f, group: vec4f) -> vec4f {
    if mode == VTEX_BLEND_PLUS_LIGHTER {
        return min(behind + group, vec4f(1.0));
    }
    let b = min(behind.rgb / behind.a, vec3f(1.0));
    let s = min(group.rgb / group.a, vec3f(1.0));
    var blended = s;
    if mode >= VTEX_BLEND_HUE {
        blended = vtex_blend_hue(mode, b, s);
    } else if mode >= VTEX_BLEND_MULTIPLY {
        blended = vtex_blend_separable(mode, b, s);
    }
    let color = (1.0 - behind.a) * group.rgb
        + (1.0 - group.a) * behind.rgb
        + group.a * behind.a * blended;
    return vec4f(color, group.a + (1.0 - group.a) * behind.a);
}
