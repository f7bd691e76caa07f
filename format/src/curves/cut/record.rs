//! The words of one record.

use super::{CellCurves, Point, Segment};
use crate::records::curve::CurveHeader;

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
    let key = |p: Point| [to_u16(p.y), to_u16(p.x)];
    let mut sorted: Vec<(&Segment, bool)> = segments.map(|segment| (segment, false)).collect();
    // Before a stable sort, so that of equal starts the last comes first.
    sorted.reverse();
    sorted.sort_by_key(|(segment, _)| key(segment.start));
    let mut chain: Vec<&Segment> = Vec::with_capacity(sorted.len());
    let mut topmost = 0;
    while chain.len() < sorted.len() {
        let follows = chain.last().and_then(|last| {
            let at = key(last.end);
            let first = sorted.partition_point(|(segment, _)| key(segment.start) < at);
            let here = sorted[first..].iter();
            let here = here.take_while(|(segment, _)| key(segment.start) == at);
            let free = here.enumerate().find(|(_, (_, taken))| !taken);
            free.map(|(place, _)| first + place)
        });
        // Never goes back: what lies before it is taken.
        while follows.is_none() && sorted[topmost].1 {
            topmost += 1;
        }
        let next = &mut sorted[follows.unwrap_or(topmost)];
        next.1 = true;
        chain.push(next.0);
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
