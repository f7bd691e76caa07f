//! Gradients in f64, straight from their definition in the format.

use vtex_format::{Gradient, Spread};

/// The colour at a uv: straight alpha, sRGB-encoded.
pub(crate) fn color_at(gradient: &Gradient, uv: [f64; 2]) -> [f64; 4] {
    let Some(t) = gradient.shape.t_at(uv) else {
        return [0.0; 4];
    };
    let t = match gradient.spread {
        Spread::Pad => t,
        Spread::Repeat => t.rem_euclid(1.0),
        Spread::Reflect => {
            let t = t.rem_euclid(2.0);
            if t > 1.0 { 2.0 - t } else { t }
        }
    };
    let stops = &gradient.stops;
    let color = |index: usize| stops[index].color.map(f64::from);
    let offset = |index: usize| f64::from(stops[index].offset);
    match (0..stops.len()).rev().find(|&index| offset(index) <= t) {
        None => color(0),
        Some(last) if last + 1 == stops.len() => color(last),
        Some(left) => {
            let f = (t - offset(left)) / (offset(left + 1) - offset(left));
            let (from, to) = (color(left), color(left + 1));
            std::array::from_fn(|i| from[i] * (1.0 - f) + to[i] * f)
        }
    }
}
