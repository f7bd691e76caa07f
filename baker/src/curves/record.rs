//! Records: what evaluators read.

use kurbo::Point;
use vtex_format::CurveHeader;

use super::{
    CurveError,
    lower::Segment,
    sweep::{CellCurves, to_u16},
};
use crate::drawing::FillRule;

/// The words of one record for shapes that share a cell, a paint and a fill rule and do not
/// overlap, so that their windings may be added.
///
/// # Errors
/// [`CurveError::Overflow`] when they do not fit one record.
pub(crate) fn encode_record(parts: &[&CellCurves], rule: FillRule) -> Result<Vec<u32>, CurveError> {
    let mut steps: Vec<(f64, i32)> = parts.iter().flat_map(|part| part.steps.clone()).collect();
    steps.sort_by(|a, b| a.0.total_cmp(&b.0));
    steps.dedup_by(|next, kept| {
        let same = next.0.total_cmp(&kept.0).is_eq();
        if same {
            kept.1 += next.1;
        }
        same
    });
    steps.retain(|step| step.1 != 0);

    let segments = || parts.iter().flat_map(|part| &part.segments);
    let of = |curved: bool, direction: i32| {
        segments().filter(move |s| s.control.is_some() == curved && s.direction == direction)
    };
    let lines = || of(false, 1).chain(of(false, -1));
    let quads = || of(true, 1).chain(of(true, -1));
    let header = CurveHeader {
        line_count: count(lines())?,
        down_line_count: count(of(false, 1))?,
        quad_count: count(quads())?,
        down_quad_count: count(of(true, 1))?,
        step_count: count(steps.iter())?,
        even_odd: rule == FillRule::EvenOdd,
        base_winding: parts.iter().map(|part| part.base).sum(),
    };
    let mut words = header.encode().ok_or(CurveError::Overflow)?.to_vec();
    for (height, change) in steps {
        let change = i16::try_from(change).map_err(|_| CurveError::Overflow)?;
        words.push(u32::from(to_u16(height)) | u32::from(change.cast_unsigned()) << 16);
    }
    words.extend(lines().flat_map(|s| [point(s.start), point(s.end)]));
    words.extend(quads().flat_map(quad));
    Ok(words)
}

fn count<T>(items: impl Iterator<Item = T>) -> Result<u32, CurveError> {
    u32::try_from(items.count()).map_err(|_| CurveError::Overflow)
}

fn quad(segment: &Segment) -> [u32; 3] {
    let control = segment.control.unwrap_or(segment.start);
    [point(segment.start), point(control), point(segment.end)]
}

fn point(p: Point) -> u32 {
    u32::from(to_u16(p.x)) | u32::from(to_u16(p.y)) << 16
}
