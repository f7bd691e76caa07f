//! Lowered outlines as the file stores them, section `OUTL`.

use kurbo::Point;
use vtex_format::{StoredOutline, StoredSegment};

use super::lower::{LoweredOutline, Segment};
use crate::drawing::FillRule;

/// The outline as stored; `None` when it is empty or a coordinate does not fit the format's 32
/// bits.
pub(crate) fn stored_outline(lowered: &LoweredOutline, rule: FillRule) -> Option<StoredOutline> {
    let segments: Option<Vec<StoredSegment>> = lowered.segments.iter().map(segment).collect();
    Some(StoredOutline {
        even_odd: rule == FillRule::EvenOdd,
        segments: segments.filter(|segments| !segments.is_empty())?,
    })
}

fn segment(segment: &Segment) -> Option<StoredSegment> {
    let [start, end] = [segment.start, segment.end].map(lattice_point);
    let control = match segment.control {
        Some(control) => Some(lattice_point(control)?),
        None => None,
    };
    // The file stores segments along the outline; lowered ones run from top to bottom.
    let (from, to) = if segment.direction > 0 {
        (start?, end?)
    } else {
        (end?, start?)
    };
    Some(StoredSegment { from, control, to })
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
