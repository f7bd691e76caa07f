//! The words of one record.

use std::cmp::Reverse;

use super::{Point, Segment};
use crate::records::curve::CurveHeader;

/// What stands left of a box: the winding at its top, and where that changes on its left edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Left<I> {
    pub(crate) base: i32,
    /// Heights, ascending, and changes, none of them zero.
    pub(crate) steps: I,
}

/// A segment of one kind, by where it starts.
#[derive(Clone, Copy, Debug)]
struct Start {
    /// Where: y in the high half, x in the low one.
    key: u32,
    /// Its place among the record's segments.
    place: u32,
    /// Of the first with its key: how many of that key are taken.
    taken: u32,
}

/// Writes records. Its memory serves the next record again.
#[derive(Debug, Default)]
pub(crate) struct Records {
    starts: Vec<Start>,
}

impl Records {
    /// Appends the record of what a box holds; `None` when it does not fit one.
    pub(crate) fn append<I>(
        &mut self,
        left: Left<I>,
        segments: &[Segment],
        even_odd: bool,
        words: &mut Vec<u32>,
    ) -> Option<()>
    where
        I: ExactSizeIterator<Item = (u16, i32)>,
    {
        let mut counts = [0_u32; 4];
        for segment in segments {
            counts[kind(segment)] += 1;
        }
        let header = CurveHeader {
            line_count: counts[0] + counts[1],
            down_line_count: counts[0],
            quad_count: counts[2] + counts[3],
            down_quad_count: counts[2],
            step_count: u32::try_from(left.steps.len()).ok()?,
            even_odd,
            base_winding: left.base,
        };
        words.extend(header.encode()?);
        for (height, change) in left.steps {
            let change = i16::try_from(change).ok()?;
            words.push(u32::from(height) | u32::from(change.cast_unsigned()) << 16);
        }
        for (kind, &count) in counts.iter().enumerate() {
            if count > 0 {
                self.chain(segments, kind, words)?;
            }
        }
        Some(())
    }

    /// Appends the segments of a kind in an order in which most start where the one before ends, the
    /// topmost of those that are left beginning a chain; of several with one start the last comes
    /// first.
    fn chain(&mut self, segments: &[Segment], wanted: usize, words: &mut Vec<u32>) -> Option<()> {
        self.starts.clear();
        for (segment, place) in segments.iter().zip(0..) {
            if kind(segment) == wanted {
                let (key, taken) = (key(segment.start), 0);
                self.starts.push(Start { key, place, taken });
            }
        }
        let starts = &mut self.starts;
        starts.sort_unstable_by_key(|start| (start.key, Reverse(start.place)));
        let mut topmost = 0;
        let mut end = None;
        for _ in 0..starts.len() {
            let follows = end.and_then(|end| {
                let first = starts.partition_point(|start| start.key < end);
                let next = first + starts.get(first)?.taken as usize;
                (starts.get(next)?.key == end).then_some((first, next))
            });
            // Never goes back: what lies before it is taken.
            let (first, next) = match follows {
                Some(places) => places,
                None => free(starts, &mut topmost)?,
            };
            starts[first].taken += 1;
            let segment = &segments[starts[next].place as usize];
            end = Some(key(segment.end));
            words.push(point(segment.start));
            if let Some(control) = segment.control {
                words.push(point(control));
            }
            words.push(point(segment.end));
        }
        Some(())
    }
}

/// The first place of a key, and the first of that key that is not taken, from `first` on.
fn free(starts: &[Start], first: &mut usize) -> Option<(usize, usize)> {
    loop {
        let start = starts.get(*first)?;
        let next = *first + start.taken as usize;
        match starts.get(next) {
            Some(other) if other.key == start.key => return Some((*first, next)),
            // All of this key are taken.
            _ => *first = next,
        }
    }
}

/// Lines before quadratics, those that run down before those that run up.
fn kind(segment: &Segment) -> usize {
    2 * usize::from(segment.control.is_some()) + usize::from(segment.direction < 0)
}

fn key(p: Point) -> u32 {
    u32::from(to_u16(p.y)) << 16 | u32::from(to_u16(p.x))
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
pub(crate) fn to_u16(x: f64) -> u16 {
    x as u16
}
