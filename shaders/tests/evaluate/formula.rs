//! Section 3 of docs/format.md once more, in `f64` and without any shortcut.

pub(crate) use vtex_testing::srgb::{decode, encode};

pub(crate) type Rgba = [f64; 4];

/// One entry as the formulas see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    /// Coverage of the shape and of the ring around it.
    pub(crate) coverage: [f64; 2],
    /// Straight, sRGB-encoded colours of both.
    pub(crate) color: [[f32; 4]; 2],
}

fn straight(f: fn(f64) -> f64, [r, g, b, a]: Rgba) -> Rgba {
    if a <= 0.0 {
        [0.0; 4]
    } else {
        [f(r / a) * a, f(g / a) * a, f(b / a) * a, a]
    }
}

/// Linear light, premultiplied, of a straight, sRGB-encoded colour.
pub(crate) fn linear(color: [f32; 4]) -> Rgba {
    straight(decode, premultiplied(color))
}

fn premultiplied(color: [f32; 4]) -> Rgba {
    let [r, g, b, a] = color.map(f64::from);
    [r * a, g * a, b * a, a]
}

/// Front to back on sRGB-encoded values. Shape and ring exclude each other, so that both lie over
/// what is behind.
pub(crate) fn composited(terms: &[Term]) -> Rgba {
    let mut seen = [0.0; 4];
    for term in terms {
        let through = 1.0 - seen[3];
        for (coverage, color) in term.coverage.into_iter().zip(term.color) {
            let front = premultiplied(color);
            seen = std::array::from_fn(|i| seen[i] + through * coverage * front[i]);
        }
    }
    straight(decode, seen)
}

pub(crate) fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
