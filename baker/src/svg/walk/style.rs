//! usvg's fill rules and stroke styles, in the baker's terms.

use kurbo::{Cap, Join};

use crate::{drawing::FillRule, geometry::stroke::StrokeStyle};

/// The fill rule.
pub(super) fn fill_rule(rule: usvg::FillRule) -> FillRule {
    match rule {
        usvg::FillRule::NonZero => FillRule::NonZero,
        usvg::FillRule::EvenOdd => FillRule::EvenOdd,
    }
}

/// Everything about a stroke but its paint.
pub(super) fn stroke_style(stroke: &usvg::Stroke) -> StrokeStyle {
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
