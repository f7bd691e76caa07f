//! The words of one record.

use std::collections::BTreeMap;

use super::{CellCurves, Point, Segment};
use crate::CurveHeader;

/// The record of what a cell holds; `None` when it does not fit.
pub(super) fn words(curves: &CellCurves, even_odd: bool) -> Option<Vec<u32>> {
    let of = |curved: bool, direction: i32| {
        let segments = curves.segments.iter();
        chained(segments.filter(|s| s.control.is_some() == curved && s.direction == direction))
    };
    let [lines, quads] = [false, true].map(|curved| [of(curved, 1), of(curved, -1)]);
    let count = |n: usize| u32::try_from(n).ok();
    let header = CurveHeader {
        line_count: count(lines[0].len() + lines[1].len())?,
        down_line_count: count(lines[0].len())?,
        quad_count: count(quads[0].len() + quads[1].len())?,
        down_quad_count: count(quads[0].len())?,
        step_count: count(curves.steps.len())?,
        even_odd,
        base_winding: curves.base,
    };
    let mut words = header.encode()?.to_vec();
    for (&height, &change) in &curves.steps {
        let change = i16::try_from(change).ok()?;
        words.push(u32::from(height) | u32::from(change.cast_unsigned()) << 16);
    }
    let line = |s: &Segment| [point(s.start), point(s.end)];
    words.extend(lines.iter().flatten().flat_map(|s| line(s)));
    words.extend(quads.iter().flatten().flat_map(|s| quad(s)));
    Some(words)
}

/// Segments in an order in which most start where the one before ends, the topmost of those that
/// are left beginning a chain; of several with one start the last comes first.
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

fn quad(segment: &Segment) -> [u32; 3] {
    let control = segment.control.unwrap_or(segment.start);
    [point(segment.start), point(control), point(segment.end)]
}

fn point(p: Point) -> u32 {
    u32::from(to_u16(p.x)) | u32::from(to_u16(p.y)) << 16
}

/// A coordinate of a box, which is an integer of 16 bits.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "boxes are at most 65535 units wide; a cast saturates"
)]
pub(super) fn to_u16(x: f64) -> u16 {
    x as u16
}
