//! Gradients in f64, straight from their definition in the format.

use vtex_format::{Gradient, GradientShape, Spread};

/// The colour at a uv: straight alpha, sRGB-encoded.
pub(crate) fn color_at(gradient: &Gradient, uv: [f64; 2]) -> [f64; 4] {
    let Some(t) = parameter(&gradient.shape, uv) else {
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

/// The parameter t at a uv, if it has one.
fn parameter(shape: &GradientShape, [u, v]: [f64; 2]) -> Option<f64> {
    match *shape {
        GradientShape::Linear { t_from_uv } => {
            let [a, b, c] = t_from_uv.map(f64::from);
            Some(a * u + b * v + c)
        }
        GradientShape::Radial {
            circle_from_uv,
            distance,
            focal_radius,
        } => {
            let [a, b, c, d, e, f] = circle_from_uv.map(f64::from);
            let p = [a * u + c * v + e, b * u + d * v + f];
            circle(p, f64::from(distance), f64::from(focal_radius))
        }
    }
}

/// The greatest t of the circles through `p` whose radius is not negative: the roots of
/// `|p - t (distance, 0)|^2 = (focal + t growth)^2`.
fn circle([x, y]: [f64; 2], distance: f64, focal: f64) -> Option<f64> {
    let growth = 1.0 - focal;
    let (a, b, c) = (
        distance * distance - growth * growth,
        -2.0 * (x * distance + focal * growth),
        x * x + y * y - focal * focal,
    );
    let roots = if a.abs() < 1e-12 {
        [-c / b, -c / b]
    } else {
        let root = (b * b - 4.0 * a * c).sqrt();
        [(-b + root) / (2.0 * a), (-b - root) / (2.0 * a)]
    };
    let sound = roots.into_iter().filter(|t| focal + t * growth >= 0.0);
    sound.max_by(f64::total_cmp)
}
