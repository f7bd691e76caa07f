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

fn combine(a: Rgba, s: f64, b: Rgba, t: f64) -> Rgba {
    std::array::from_fn(|i| s * a[i] + t * b[i])
}

fn over(front: Rgba, back: Rgba) -> Rgba {
    combine(front, 1.0, back, 1.0 - front[3])
}

/// Front to back on sRGB-encoded values; coverages are 0 or 1.
pub(crate) fn point(terms: &[Term]) -> Rgba {
    let mut seen = [0.0; 4];
    for term in terms {
        for (coverage, color) in term.coverage.into_iter().zip(term.color) {
            if coverage > 0.0 {
                seen = over(seen, premultiplied(color));
            }
        }
    }
    straight(decode, seen)
}

/// Back to front in linear light.
pub(crate) fn ramp(terms: &[Term]) -> Rgba {
    terms.iter().rev().fold([0.0; 4], |behind, term| {
        let mut sum = combine(
            behind,
            1.0 - term.coverage[0] - term.coverage[1],
            [0.0; 4],
            0.0,
        );
        for (coverage, color) in term.coverage.into_iter().zip(term.color) {
            let shown = over(premultiplied(color), straight(encode, behind));
            sum = combine(sum, 1.0, straight(decode, shown), coverage);
        }
        sum
    })
}

pub(crate) fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
