//! Blend modes of W3C Compositing and Blending Level 1, section 10, as its formulas stand there.

use vtex_format::BlendMode;

type Rgb = [f64; 3];

/// `source` blended with and composited over `backdrop` (sections 5.1 and 10.1): sRGB-encoded,
/// premultiplied.
pub(super) fn blend(mode: BlendMode, source: [f64; 4], backdrop: [f64; 4]) -> [f64; 4] {
    if mode == BlendMode::PlusLighter {
        return std::array::from_fn(|i| (source[i] + backdrop[i]).min(1.0));
    }
    let [source_alpha, backdrop_alpha] = [source[3], backdrop[3]];
    let straight = |color: [f64; 4]| {
        let alpha = if color[3] > 0.0 { color[3] } else { 1.0 };
        [color[0] / alpha, color[1] / alpha, color[2] / alpha]
    };
    let mixed = mixed(mode, straight(backdrop), straight(source));
    let channel = |i: usize| {
        (1.0 - backdrop_alpha) * source[i]
            + (1.0 - source_alpha) * backdrop[i]
            + source_alpha * backdrop_alpha * mixed[i]
    };
    let alpha = source_alpha + backdrop_alpha * (1.0 - source_alpha);
    [channel(0), channel(1), channel(2), alpha]
}

/// B(Cb, Cs).
fn mixed(mode: BlendMode, b: Rgb, s: Rgb) -> Rgb {
    let each = |f: fn(f64, f64) -> f64| [f(b[0], s[0]), f(b[1], s[1]), f(b[2], s[2])];
    match mode {
        // The latter mixes nothing.
        BlendMode::Normal | BlendMode::PlusLighter => s,
        BlendMode::Multiply => each(|b, s| b * s),
        BlendMode::Screen => each(screen),
        BlendMode::Overlay => each(|b, s| hard_light(s, b)),
        BlendMode::Darken => each(f64::min),
        BlendMode::Lighten => each(f64::max),
        BlendMode::ColorDodge => each(color_dodge),
        BlendMode::ColorBurn => each(color_burn),
        BlendMode::HardLight => each(hard_light),
        BlendMode::SoftLight => each(soft_light),
        BlendMode::Difference => each(|b, s| (b - s).abs()),
        BlendMode::Exclusion => each(|b, s| b + s - 2.0 * b * s),
        BlendMode::Hue => with_luminosity(with_saturation(s, saturation(b)), luminosity(b)),
        BlendMode::Saturation => with_luminosity(with_saturation(b, saturation(s)), luminosity(b)),
        BlendMode::Color => with_luminosity(s, luminosity(b)),
        BlendMode::Luminosity => with_luminosity(b, luminosity(s)),
    }
}

fn screen(b: f64, s: f64) -> f64 {
    b + s - b * s
}

fn hard_light(b: f64, s: f64) -> f64 {
    if s <= 0.5 {
        b * 2.0 * s
    } else {
        screen(b, 2.0 * s - 1.0)
    }
}

fn color_dodge(b: f64, s: f64) -> f64 {
    if b <= 0.0 {
        0.0
    } else if s >= 1.0 {
        1.0
    } else {
        (b / (1.0 - s)).min(1.0)
    }
}

fn color_burn(b: f64, s: f64) -> f64 {
    if b >= 1.0 {
        1.0
    } else if s <= 0.0 {
        0.0
    } else {
        1.0 - ((1.0 - b) / s).min(1.0)
    }
}

fn soft_light(b: f64, s: f64) -> f64 {
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

fn luminosity([r, g, b]: Rgb) -> f64 {
    0.3 * r + 0.59 * g + 0.11 * b
}

fn saturation([r, g, b]: Rgb) -> f64 {
    r.max(g).max(b) - r.min(g).min(b)
}

fn clipped(color: Rgb) -> Rgb {
    let light = luminosity(color);
    let low = color[0].min(color[1]).min(color[2]);
    let high = color[0].max(color[1]).max(color[2]);
    let mut out = color;
    if low < 0.0 {
        out = out.map(|c| light + (c - light) * light / (light - low));
    }
    if high > 1.0 {
        out = out.map(|c| light + (c - light) * (1.0 - light) / (high - light));
    }
    out
}

fn with_luminosity(color: Rgb, light: f64) -> Rgb {
    let change = light - luminosity(color);
    clipped(color.map(|c| c + change))
}

/// The channels keep their order; the least becomes 0 and the largest `amount`.
fn with_saturation(color: Rgb, amount: f64) -> Rgb {
    let low = color[0].min(color[1]).min(color[2]);
    let span = saturation(color);
    if span <= 0.0 {
        return [0.0; 3];
    }
    color.map(|c| (c - low) * amount / span)
}
