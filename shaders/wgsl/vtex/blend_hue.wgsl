//!use core/layout
// Blend modes that take the channels together: Compositing and Blending Level 1, section 10.2.
// `b` is the backdrop, `s` the source, straight.

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
