//! Compositing and Blending Level 1, written down from its text.

use vtex_format::BlendMode;

type Rgb = [f64; 3];

/// Section 5.8: sRGB-encoded, premultiplied; `cs` the source, `cb` the backdrop as there.
pub(super) fn blend(mode: BlendMode, backdrop: [f64; 4], source: [f64; 4]) -> [f64; 4] {
    if mode == BlendMode::PlusLighter {
        return std::array::from_fn(|i| (backdrop[i] + source[i]).min(1.0));
    }
    let straight = |[r, g, b, a]: [f64; 4]| [r, g, b].map(|c| if a > 0.0 { c / a } else { 0.0 });
    let (cb, ab, cs, a_s) = (straight(backdrop), backdrop[3], straight(source), source[3]);
    let mixed = blended(mode, cb, cs);
    let co = |i: usize| cs[i] * a_s * (1.0 - ab) + cb[i] * ab * (1.0 - a_s) + a_s * ab * mixed[i];
    [co(0), co(1), co(2), a_s + ab * (1.0 - a_s)]
}

fn blended(mode: BlendMode, cb: Rgb, cs: Rgb) -> Rgb {
    match mode {
        BlendMode::Hue => set_lum(set_sat(cs, sat(cb)), lum(cb)),
        BlendMode::Saturation => set_lum(set_sat(cb, sat(cs)), lum(cb)),
        BlendMode::Color => set_lum(cs, lum(cb)),
        BlendMode::Luminosity => set_lum(cb, lum(cs)),
        _ => [0, 1, 2].map(|i| channel(mode, cb[i], cs[i])),
    }
}

fn channel(mode: BlendMode, cb: f64, cs: f64) -> f64 {
    match mode {
        BlendMode::Multiply => cb * cs,
        BlendMode::Screen => 1.0 - (1.0 - cb) * (1.0 - cs),
        BlendMode::Overlay => channel(BlendMode::HardLight, cs, cb),
        BlendMode::Darken => cb.min(cs),
        BlendMode::Lighten => cb.max(cs),
        BlendMode::ColorDodge if cb <= 0.0 => 0.0,
        BlendMode::ColorDodge if cs >= 1.0 => 1.0,
        BlendMode::ColorDodge => (cb / (1.0 - cs)).min(1.0),
        BlendMode::ColorBurn if cb >= 1.0 => 1.0,
        BlendMode::ColorBurn if cs <= 0.0 => 0.0,
        BlendMode::ColorBurn => 1.0 - ((1.0 - cb) / cs).min(1.0),
        BlendMode::HardLight if cs <= 0.5 => channel(BlendMode::Multiply, cb, 2.0 * cs),
        BlendMode::HardLight => channel(BlendMode::Screen, cb, 2.0 * cs - 1.0),
        BlendMode::SoftLight if cs <= 0.5 => cb - (1.0 - 2.0 * cs) * cb * (1.0 - cb),
        BlendMode::SoftLight => {
            let d = if cb <= 0.25 {
                ((16.0 * cb - 12.0) * cb + 4.0) * cb
            } else {
                cb.sqrt()
            };
            cb + (2.0 * cs - 1.0) * (d - cb)
        }
        BlendMode::Difference => (cb - cs).abs(),
        BlendMode::Exclusion => cb + cs - 2.0 * cb * cs,
        _ => cs,
    }
}

fn lum([r, g, b]: Rgb) -> f64 {
    0.3 * r + 0.59 * g + 0.11 * b
}

fn ends(c: Rgb) -> [f64; 2] {
    let least = c[0].min(c[1]).min(c[2]);
    [least, c[0].max(c[1]).max(c[2])]
}

fn sat(c: Rgb) -> f64 {
    let [least, most] = ends(c);
    most - least
}

fn set_lum(c: Rgb, l: f64) -> Rgb {
    let d = l - lum(c);
    clip_color(c.map(|c| c + d))
}

fn clip_color(c: Rgb) -> Rgb {
    let l = lum(c);
    let [n, x] = ends(c);
    let mut c = c;
    if n < 0.0 {
        c = c.map(|c| l + (c - l) * l / (l - n));
    }
    if x > 1.0 {
        c = c.map(|c| l + (c - l) * (1.0 - l) / (x - l));
    }
    c
}

/// The middle channel keeps its place between the others, which become 0 and `s`.
fn set_sat(c: Rgb, s: f64) -> Rgb {
    let [least, most] = ends(c);
    if most <= least {
        return [0.0; 3];
    }
    c.map(|c| (c - least) * s / (most - least))
}
