//! Blending, from the text of Compositing and Blending Level 1.
//!
//! It has the formulas, names and steps of the text and shares no code with the evaluator, whose
//! mistakes it is to show. All tests of blending compare with it; its own test compares it with
//! Chromium.
//!
//! `cb` and `cs` are the specification's Cb and Cs, the colours of backdrop and source, not
//! premultiplied; `alpha_b` and `alpha_s` are their alphas.

use vtex_format::BlendMode;

/// Red, green, blue.
type Color = [f64; 3];

/// The backdrop with the source blended in and composited over it; all colours sRGB-encoded and
/// premultiplied.
pub fn blend(mode: BlendMode, backdrop: [f64; 4], source: [f64; 4]) -> [f64; 4] {
    let (cb, alpha_b) = unpremultiplied(backdrop);
    let (cs, alpha_s) = unpremultiplied(source);
    if mode == BlendMode::PlusLighter {
        // Sec. 9.1.13, lighter: Fa = 1, Fb = 1. Level 2 clamps the sum and calls it plus-lighter.
        let sum = composite((cs, alpha_s), 1.0, (cb, alpha_b), 1.0);
        return sum.map(|channel| channel.min(1.0));
    }
    // Sec. 6, "Apply the blend in place": Cr = (1 - ab) x Cs + ab x B(Cb, Cs).
    let mixed = b(mode, cb, cs);
    let cr = [0, 1, 2].map(|i| (1.0 - alpha_b) * cs[i] + alpha_b * mixed[i]);
    // Sec. 9.1.4, source over: Fa = 1, Fb = 1 - as.
    composite((cr, alpha_s), 1.0, (cb, alpha_b), 1.0 - alpha_s)
}

/// Sec. 10: blending is defined on colours that are not premultiplied.
fn unpremultiplied([r, g, b, alpha]: [f64; 4]) -> (Color, f64) {
    if alpha > 0.0 {
        ([r / alpha, g / alpha, b / alpha], alpha)
    } else {
        ([0.0; 3], 0.0)
    }
}

/// Sec. 9.1: co = as x Fa x Cs + ab x Fb x Cb and ao = as x Fa + ab x Fb.
fn composite(
    (cs, alpha_s): (Color, f64),
    fa: f64,
    (cb, alpha_b): (Color, f64),
    fb: f64,
) -> [f64; 4] {
    let co = |i: usize| alpha_s * fa * cs[i] + alpha_b * fb * cb[i];
    [co(0), co(1), co(2), alpha_s * fa + alpha_b * fb]
}

/// B(Cb, Cs), the mixing function of sec. 10.1 and 10.2.
fn b(mode: BlendMode, cb: Color, cs: Color) -> Color {
    match mode {
        BlendMode::Hue => set_lum(set_sat(cs, sat(cb)), lum(cb)),
        BlendMode::Saturation => set_lum(set_sat(cb, sat(cs)), lum(cb)),
        BlendMode::Color => set_lum(cs, lum(cb)),
        BlendMode::Luminosity => set_lum(cb, lum(cs)),
        _ => [0, 1, 2].map(|i| separable(mode, cb[i], cs[i])),
    }
}

/// Sec. 10.1, of one component.
fn separable(mode: BlendMode, cb: f64, cs: f64) -> f64 {
    match mode {
        BlendMode::Multiply => multiply(cb, cs),
        BlendMode::Screen => screen(cb, cs),
        BlendMode::Overlay => hard_light(cs, cb),
        BlendMode::Darken => f64::min(cb, cs),
        BlendMode::Lighten => f64::max(cb, cs),
        BlendMode::ColorDodge => color_dodge(cb, cs),
        BlendMode::ColorBurn => color_burn(cb, cs),
        BlendMode::HardLight => hard_light(cb, cs),
        BlendMode::SoftLight => soft_light(cb, cs),
        BlendMode::Difference => f64::abs(cb - cs),
        BlendMode::Exclusion => cb + cs - 2.0 * cb * cs,
        // Normal. PlusLighter has no mixing function, the others are in sec. 10.2.
        _ => cs,
    }
}

fn multiply(cb: f64, cs: f64) -> f64 {
    cb * cs
}

fn screen(cb: f64, cs: f64) -> f64 {
    1.0 - (1.0 - cb) * (1.0 - cs)
}

fn color_dodge(cb: f64, cs: f64) -> f64 {
    if cb == 0.0 {
        0.0
    } else if cs == 1.0 {
        1.0
    } else {
        f64::min(1.0, cb / (1.0 - cs))
    }
}

fn color_burn(cb: f64, cs: f64) -> f64 {
    if cb == 1.0 {
        1.0
    } else if cs == 0.0 {
        0.0
    } else {
        1.0 - f64::min(1.0, (1.0 - cb) / cs)
    }
}

fn hard_light(cb: f64, cs: f64) -> f64 {
    if cs <= 0.5 {
        multiply(cb, 2.0 * cs)
    } else {
        screen(cb, 2.0 * cs - 1.0)
    }
}

fn soft_light(cb: f64, cs: f64) -> f64 {
    if cs <= 0.5 {
        cb - (1.0 - 2.0 * cs) * cb * (1.0 - cb)
    } else {
        let d = if cb <= 0.25 {
            ((16.0 * cb - 12.0) * cb + 4.0) * cb
        } else {
            f64::sqrt(cb)
        };
        cb + (2.0 * cs - 1.0) * (d - cb)
    }
}

/// Sec. 10.2, as the functions below.
fn lum([red, green, blue]: Color) -> f64 {
    0.3 * red + 0.59 * green + 0.11 * blue
}

fn clip_color(c: Color) -> Color {
    let l = lum(c);
    let [n, _, x] = order(c).map(|i| c[i]);
    let mut c = c;
    if n < 0.0 {
        c = c.map(|c| l + (c - l) * l / (l - n));
    }
    if x > 1.0 {
        c = c.map(|c| l + (c - l) * (1.0 - l) / (x - l));
    }
    c
}

fn set_lum(c: Color, l: f64) -> Color {
    let d = l - lum(c);
    clip_color(c.map(|component| component + d))
}

fn sat(c: Color) -> f64 {
    let [min, _, max] = order(c);
    c[max] - c[min]
}

fn set_sat(c: Color, s: f64) -> Color {
    let [min, mid, max] = order(c);
    let (c_min, c_mid, c_max) = (c[min], c[mid], c[max]);
    let mut c = c;
    if c_max > c_min {
        c[mid] = (c_mid - c_min) * s / (c_max - c_min);
        c[max] = s;
    } else {
        c[mid] = 0.0;
        c[max] = 0.0;
    }
    c[min] = 0.0;
    c
}

/// Which components are the minimum, the middle and the maximum.
fn order(c: Color) -> [usize; 3] {
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| c[i].total_cmp(&c[j]));
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What Chromium makes of pairs of colours, mode by mode; its first lines say how.
    const CHROMIUM: &str = include_str!("blend_chromium.tsv");
    /// Chromium's canvas holds halves, which are 2^-11 apart below 1. Color burn divides by Cs and
    /// so enlarges the backdrop's rounding: 0.0010, the others stay below 0.0006.
    const SAME: f64 = 2e-3;

    /// Numbers separated by blanks.
    fn rgba(field: &str) -> [f64; 4] {
        let numbers: Vec<f64> = field
            .split(' ')
            .map(|number| number.parse().unwrap())
            .collect();
        numbers.try_into().unwrap()
    }

    fn premultiplied([r, g, b, a]: [f64; 4]) -> [f64; 4] {
        [r * a, g * a, b * a, a]
    }

    #[test]
    fn chromium_blends_the_same() {
        let mut modes = Vec::new();
        for row in CHROMIUM.lines().filter(|line| !line.starts_with('#')) {
            let fields: Vec<&str> = row.split('\t').collect();
            let &[name, backdrop, source, result] = fields.as_slice() else {
                panic!("four fields: {row}");
            };
            let mode = BlendMode::ALL
                .into_iter()
                .find(|mode| format!("{mode:?}") == name);
            let mode = mode.unwrap_or_else(|| panic!("no mode {name}"));
            let [backdrop, source] =
                [backdrop, source].map(|bytes| premultiplied(rgba(bytes).map(|byte| byte / 255.0)));
            let found = blend(mode, backdrop, source);
            let expected = premultiplied(rgba(result));
            let mut pairs = found.iter().zip(expected);
            assert!(
                pairs.all(|(a, b)| (a - b).abs() < SAME),
                "{row}: {found:?}, not {expected:?}"
            );
            modes.push(mode);
        }
        for mode in BlendMode::ALL {
            assert!(modes.contains(&mode), "{mode:?} is not in the table");
        }
    }

    /// By hand from sec. 10.2.
    #[test]
    fn auxiliary_functions_are_those_of_the_text() {
        let close = |a: Color, b: Color| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(close(
            [
                lum([1.0, 0.0, 0.0]),
                lum([0.0, 1.0, 0.0]),
                lum([0.0, 0.0, 1.0])
            ],
            [0.3, 0.59, 0.11]
        ));
        // Cmid = (0.5 - 0.2) x 0.4 / (0.8 - 0.2) = 0.2.
        assert!(close(set_sat([0.8, 0.2, 0.5], 0.4), [0.4, 0.0, 0.2]));
        assert!(close(set_sat([0.7, 0.7, 0.7], 0.4), [0.0; 3]));
        // L = 0.3 x 1.4 = 0.42, x = 1.4: red 0.42 + 0.98 x 0.58 / 0.98 = 1, the others
        // 0.42 - 0.42 x 0.58 / 0.98.
        let rest = 0.42 - 0.42 * 0.58 / 0.98;
        assert!(close(clip_color([1.4, 0.0, 0.0]), [1.0, rest, rest]));
    }
}
