//! Gradients, as paints in uv.

use std::sync::Arc;

use kurbo::{Affine, Point};
use vtex_format::{Gradient, GradientShape, GradientStop, MAX_GRADIENT_STOPS, Spread};

use crate::{drawing::Paint, number::to_f32, svg::path::affine};

/// Share of the end circle's radius below which a length counts as 0.
const NOTHING: f64 = 1e-6;

/// Whether it has more stops than a paint may have.
pub(super) fn has_too_many_stops(gradient: &usvg::BaseGradient) -> bool {
    gradient.stops().len() > MAX_GRADIENT_STOPS as usize
}

/// The paint of a linear gradient; `None` if it paints nothing. `uv_from_user` maps the space of
/// the painted element.
pub(super) fn linear(
    gradient: &usvg::LinearGradient,
    opacity: f32,
    uv_from_user: Affine,
) -> Option<Paint> {
    let stops = stops(gradient, opacity);
    let gradient_from_uv = gradient_from_uv(gradient, uv_from_user)?;
    let point = |x: f32, y: f32| Point::new(f64::from(x), f64::from(y));
    let start = point(gradient.x1(), gradient.y1());
    let along = point(gradient.x2(), gradient.y2()) - start;
    let squared = along.hypot2();
    // SVG 2 sec. 14.2.2.1: if both ends coincide, the colour of the last stop fills everything.
    if squared <= 0.0 {
        return solid(&stops);
    }
    let [a, b, c, d, e, f] = gradient_from_uv.as_coeffs();
    let t = |x: f64, y: f64| (along.x * x + along.y * y) / squared;
    let mut t_from_uv = [t(a, b), t(c, d), t(e - start.x, f - start.y)];
    let spread = spread(gradient);
    if spread != Spread::Pad {
        // Remove whole periods: they change nothing, but in f32 they cost digits of t.
        let middle = 0.5 * (t_from_uv[0] + t_from_uv[1]) + t_from_uv[2];
        t_from_uv[2] -= 2.0 * (0.5 * middle).floor();
    }
    let shape = GradientShape::Linear {
        t_from_uv: t_from_uv.map(to_f32),
    };
    finished(shape, spread, stops)
}

/// The paint of a radial gradient, as [`linear`].
pub(super) fn radial(
    gradient: &usvg::RadialGradient,
    opacity: f32,
    uv_from_user: Affine,
) -> Option<Paint> {
    let mut stops = stops(gradient, opacity);
    let gradient_from_uv = gradient_from_uv(gradient, uv_from_user)?;
    let point = |x: f32, y: f32| Point::new(f64::from(x), f64::from(y));
    let focus = point(gradient.fx(), gradient.fy());
    let between = point(gradient.cx(), gradient.cy()) - focus;
    let radius = f64::from(gradient.r().get());
    if radius <= 0.0 {
        return solid(&stops);
    }
    let mut distance = between.hypot() / radius;
    let mut focal_radius = f64::from(gradient.fr().get()) / radius;
    let mut angle = between.atan2();
    // A focus at the centre: the angle between them means nothing.
    if distance < NOTHING {
        (distance, angle) = (0.0, 0.0);
        if (focal_radius - 1.0).abs() < NOTHING {
            // Both circles are the same. As in tiny-skia: the first colour inside, the last
            // outside.
            if spread(gradient) != Spread::Pad {
                return None;
            }
            focal_radius = 0.0;
            stops = ring(&stops)?;
        }
    }
    // Into the space of the end circle: focus at the origin, centre on the x axis, radius 1.
    let circle_from_gradient =
        Affine::rotate(-angle) * Affine::scale(1.0 / radius) * Affine::translate(-focus.to_vec2());
    let circle_from_uv = (circle_from_gradient * gradient_from_uv).as_coeffs();
    let shape = GradientShape::Radial {
        circle_from_uv: circle_from_uv.map(to_f32),
        distance: to_f32(distance),
        focal_radius: to_f32(focal_radius),
    };
    finished(shape, spread(gradient), stops)
}

/// Stops with the first colour up to offset 1 and the last colour from there on.
fn ring(stops: &[GradientStop]) -> Option<Vec<GradientStop>> {
    let (first, last) = (stops.first()?, stops.last()?);
    let at = |offset, stop: &GradientStop| GradientStop { offset, ..*stop };
    Some(vec![at(0.0, first), at(1.0, first), at(1.0, last)])
}

/// `None` for a transform that maps everything to a line: such a gradient paints nothing.
fn gradient_from_uv(gradient: &usvg::BaseGradient, uv_from_user: Affine) -> Option<Affine> {
    let uv_from_gradient = uv_from_user * affine(gradient.transform());
    let inverse = uv_from_gradient.inverse();
    (uv_from_gradient.determinant() != 0.0 && inverse.is_finite()).then_some(inverse)
}

fn spread(gradient: &usvg::BaseGradient) -> Spread {
    match gradient.spread_method() {
        usvg::SpreadMethod::Pad => Spread::Pad,
        usvg::SpreadMethod::Reflect => Spread::Reflect,
        usvg::SpreadMethod::Repeat => Spread::Repeat,
    }
}

fn stops(gradient: &usvg::BaseGradient, opacity: f32) -> Vec<GradientStop> {
    let mut least = 0.0_f32;
    let stop = |stop: &usvg::Stop| {
        // SVG 2 sec. 14.2.4.1: an offset is never less than that of the stop before.
        least = least.max(stop.offset().get());
        let color = stop.color();
        let [r, g, b] = [color.red, color.green, color.blue].map(|v| f32::from(v) / 255.0);
        let alpha = (stop.opacity().get() * opacity).clamp(0.0, 1.0);
        GradientStop {
            offset: least,
            color: [r, g, b, alpha],
        }
    };
    gradient.stops().iter().map(stop).collect()
}

/// The colour of the last stop.
fn solid(stops: &[GradientStop]) -> Option<Paint> {
    stops.last().map(|stop| Paint::Solid(stop.color))
}

/// The gradient, or a solid paint if it has one colour everywhere.
fn finished(shape: GradientShape, spread: Spread, stops: Vec<GradientStop>) -> Option<Paint> {
    // A gradient too short for f32 numbers has only its last colour.
    if !shape.is_sound() {
        return solid(&stops);
    }
    let one_color = stops.windows(2).all(|pair| pair[0].color == pair[1].color);
    // One colour everywhere; but some radial gradients leave points without a colour.
    if one_color && shape.leading() < 0.0 {
        return solid(&stops);
    }
    Some(Paint::Gradient(Arc::new(Gradient {
        shape,
        spread,
        stops,
    })))
}
