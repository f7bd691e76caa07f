//! Records: what evaluators read.

use std::collections::BTreeMap;

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

    let of = |curved: bool, direction: i32| {
        let segments = parts.iter().flat_map(|part| &part.segments);
        chained(segments.filter(|s| s.control.is_some() == curved && s.direction == direction))
    };
    let [lines, quads] = [false, true].map(|curved| [of(curved, 1), of(curved, -1)]);
    let header = CurveHeader {
        line_count: count(lines.iter().flatten())?,
        down_line_count: count(lines[0].iter())?,
        quad_count: count(quads.iter().flatten())?,
        down_quad_count: count(quads[0].iter())?,
        step_count: count(steps.iter())?,
        even_odd: rule == FillRule::EvenOdd,
        base_winding: parts.iter().map(|part| part.base).sum(),
    };
    let mut words = header.encode().ok_or(CurveError::Overflow)?.to_vec();
    for (height, change) in steps {
        let change = i16::try_from(change).map_err(|_| CurveError::Overflow)?;
        words.push(u32::from(to_u16(height)) | u32::from(change.cast_unsigned()) << 16);
    }
    words.extend(
        lines
            .iter()
            .flatten()
            .flat_map(|s| [point(s.start), point(s.end)]),
    );
    words.extend(quads.iter().flatten().flat_map(|s| quad(s)));
    Ok(words)
}

/// Segments in an order in which most start where the one before ends: a repeated point costs a
/// packed file next to nothing.
fn chained<'a>(segments: impl Iterator<Item = &'a Segment>) -> Vec<&'a Segment> {
    let mut starts: BTreeMap<[u16; 2], Vec<&Segment>> = BTreeMap::new();
    let key = |p: Point| [to_u16(p.y), to_u16(p.x)];
    let mut left = 0_usize;
    for segment in segments {
        starts.entry(key(segment.start)).or_default().push(segment);
        left += 1;
    }
    let mut chain = Vec::with_capacity(left);
    let mut at = None;
    while chain.len() < left {
        // Segments run down, so the topmost that is left begins a chain.
        let next = at
            .filter(|key| starts.contains_key(key))
            .or_else(|| starts.first_key_value().map(|(key, _)| *key));
        let Some(key_here) = next else { break };
        if let Some(here) = starts.get_mut(&key_here) {
            let segment = here.pop();
            if here.is_empty() {
                starts.remove(&key_here);
            }
            at = segment.map(|segment| key(segment.end));
            chain.extend(segment);
        }
    }
    chain
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
