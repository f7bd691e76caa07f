//! Lowered outlines as the file stores them.

use kurbo::Point;
use vtex_format::{SourceOutline, SourceSegment};

use super::lower::{LoweredOutline, Segment};
use crate::drawing::FillRule;

/// A lowered outline as stored; `None` when it reaches further than the format's integers, or is
/// empty.
pub(crate) fn source_outline(lowered: &LoweredOutline, rule: FillRule) -> Option<SourceOutline> {
    let segments: Option<Vec<SourceSegment>> = lowered.segments.iter().map(segment).collect();
    Some(SourceOutline {
        even_odd: rule == FillRule::EvenOdd,
        segments: segments.filter(|segments| !segments.is_empty())?,
    })
}

fn segment(segment: &Segment) -> Option<SourceSegment> {
    let [start, end] = [segment.start, segment.end].map(lattice_point);
    let control = match segment.control {
        Some(control) => Some(lattice_point(control)?),
        None => None,
    };
    let (from, to) = if segment.direction > 0 {
        (start?, end?)
    } else {
        (end?, start?)
    };
    Some(SourceSegment { from, control, to })
}

/// A point of the lattice; `None` beyond 32 bits.
fn lattice_point(point: Point) -> Option<[i32; 2]> {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "lowered points are integers, and larger ones are refused"
    )]
    let number = |x: f64| (x.abs() < f64::from(i32::MAX)).then_some(x as i32);
    Some([number(point.x)?, number(point.y)?])
}
