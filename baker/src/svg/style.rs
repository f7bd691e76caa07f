//! What usvg says about strokes and colours, in the baker's terms.

use kurbo::{Cap, Join};
use usvg::Paint;

use crate::stroke::StrokeStyle;

/// Straight alpha, sRGB-encoded. A replacement's own alpha multiplies the opacity of the shape.
pub(crate) fn color(
    paint: &Paint,
    replacement: Option<[f32; 4]>,
    opacity: f32,
) -> Option<[f32; 4]> {
    if let Some([r, g, b, a]) = replacement {
        return Some([r, g, b, a * opacity]);
    }
    let Paint::Color(c) = paint else { return None };
    let [r, g, b] = [c.red, c.green, c.blue].map(|v| f32::from(v) / 255.0);
    Some([r, g, b, opacity])
}

/// Everything about a stroke but its paint.
pub(crate) fn stroke_style(stroke: &usvg::Stroke) -> StrokeStyle {
    StrokeStyle {
        width: f64::from(stroke.width().get()),
        cap: match stroke.linecap() {
            usvg::LineCap::Butt => Cap::Butt,
            usvg::LineCap::Round => Cap::Round,
            usvg::LineCap::Square => Cap::Square,
        },
        join: match stroke.linejoin() {
            usvg::LineJoin::Miter | usvg::LineJoin::MiterClip => Join::Miter,
            usvg::LineJoin::Round => Join::Round,
            usvg::LineJoin::Bevel => Join::Bevel,
        },
        miter_limit: f64::from(stroke.miterlimit().get()),
        dashes: stroke
            .dasharray()
            .unwrap_or_default()
            .iter()
            .copied()
            .map(f64::from)
            .collect(),
        dash_offset: f64::from(stroke.dashoffset()),
    }
}
