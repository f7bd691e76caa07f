//! Twin of `vtex/blend.wgsl`: Compositing and Blending Level 1. `b` is the backdrop, `s` the source, straight.

use crate::layout::blend as mode;

type Rgb = [f32; 3];

/// Both sides sRGB-encoded, premultiplied, not empty.
pub(super) fn blend(number: u32, behind: [f32; 4], group: [f32; 4]) -> [f32; 4] {
    let [ab, ag] = [behind[3], group[3]];
    if number < mode::MULTIPLY {
        return std::array::from_fn(|i| group[i] + (1.0 - ag) * behind[i]);
    }
    if number == mode::PLUS_LIGHTER {
        return std::array::from_fn(|i| (behind[i] + group[i]).min(1.0));
    }
    let straight = |[r, g, b, a]: [f32; 4]| [r, g, b].map(|c| (c / a).min(1.0));
    let [b, s] = [straight(behind), straight(group)];
    let blended = if number >= mode::HUE {
        hue(number, b, s)
    } else {
        std::array::from_fn(|i| separable(number, b[i], s[i]))
    };
    let channel = |i: usize| (1.0 - ab) * group[i] + (1.0 - ag) * behind[i] + ag * ab * blended[i];
    [channel(0), channel(1), channel(2), ag + (1.0 - ag) * ab]
}

fn separable(number: u32, b: f32, s: f32) -> f32 {
    match number {
        mode::MULTIPLY => b * s,
        mode::SCREEN => screen(b, s),
        mode::OVERLAY => hard_light(s, b),
        mode::DARKEN => b.min(s),
        mode::LIGHTEN => b.max(s),
        mode::COLOR_DODGE => color_dodge(b, s),
        mode::COLOR_BURN => color_burn(b, s),
        mode::HARD_LIGHT => hard_light(b, s),
        mode::SOFT_LIGHT => soft_light(b, s),
        mode::DIFFERENCE => (b - s).abs(),
        _ => b + s - 2.0 * b * s,
    }
}

fn screen(b: f32, s: f32) -> f32 {
    b + s - b * s
}

fn hard_light(b: f32, s: f32) -> f32 {
    if s <= 0.5 {
        2.0 * b * s
    } else {
        screen(b, 2.0 * s - 1.0)
    }
}

fn color_dodge(b: f32, s: f32) -> f32 {
    if b <= 0.0 {
        0.0
    } else if s >= 1.0 {
        1.0
    } else {
        (b / (1.0 - s).max(1e-6)).min(1.0)
    }
}

fn color_burn(b: f32, s: f32) -> f32 {
    if b >= 1.0 {
        1.0
    } else if s <= 0.0 {
        0.0
    } else {
        1.0 - ((1.0 - b) / s.max(1e-6)).min(1.0)
    }
}

fn soft_light(b: f32, s: f32) -> f32 {
    if s <= 0.5 {
        return b - (1.0 - 2.0 * s) * b * (1.0 - b);
    }
    let d = if b <= 0.25 {
        ((16.0 * b - 12.0) * b + 4.0) * b
    } else {
        b.sqrt()
    };
    b + (2.0 * s - 1.0) * (d - b)
}

fn hue(number: u32, b: Rgb, s: Rgb) -> Rgb {
    match number {
        mode::HUE => set_lum(set_sat(s, sat(b)), lum(b)),
        mode::SATURATION => set_lum(set_sat(b, sat(s)), lum(b)),
        mode::COLOR => set_lum(s, lum(b)),
        _ => set_lum(b, lum(s)),
    }
}

fn lum([r, g, b]: Rgb) -> f32 {
    r * 0.3 + g * 0.59 + b * 0.11
}

fn least([r, g, b]: Rgb) -> f32 {
    r.min(g).min(b)
}

fn most([r, g, b]: Rgb) -> f32 {
    r.max(g).max(b)
}

fn sat(c: Rgb) -> f32 {
    most(c) - least(c)
}

/// ClipColor(c + (luminosity - Lum(c))), so that its luminosity is the one asked for.
fn set_lum(c: Rgb, luminosity: f32) -> Rgb {
    let by = luminosity - lum(c);
    let moved = c.map(|c| c + by);
    let (lum, least, most) = (lum(moved), least(moved), most(moved));
    let mut clipped = moved;
    if least < 0.0 {
        clipped = clipped.map(|c| lum + (c - lum) * lum / (lum - least));
    }
    if most > 1.0 {
        clipped = clipped.map(|c| lum + (c - lum) * (1.0 - lum) / (most - lum));
    }
    clipped
}

fn set_sat(c: Rgb, saturation: f32) -> Rgb {
    let least = least(c);
    let range = most(c) - least;
    if range > 0.0 {
        c.map(|c| (c - least) * saturation / range.max(1e-6))
    } else {
        [0.0; 3]
    }
}
