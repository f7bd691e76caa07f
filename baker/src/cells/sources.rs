//! What the file stores of curves: outlines, each once, and the cells they are cut to.

use kurbo::Point;
use vtex_format::{CurveSources, SourceOutline, SourceRecord, SourceSegment};

use crate::{
    coverage::{
        cover::Cover,
        curves::lower::{LoweredOutline, Segment},
    },
    drawing::FillRule,
};

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

/// The sources of `records`, whose outlines are items; `None` where an outline is not to be had,
/// so that the file holds the records themselves.
pub(crate) fn sources(
    covers: &[Cover],
    records: &[SourceRecord],
    flatness_units: f32,
) -> Option<CurveSources> {
    // Only outlines that show are stored, in painter's order.
    let mut shown: Vec<u32> = records
        .iter()
        .flat_map(|record| record.outlines.iter().copied())
        .collect();
    shown.sort_unstable();
    shown.dedup();
    let outline = |item: &u32| covers.get(*item as usize)?.source.clone();
    let outlines = shown.iter().map(outline).collect::<Option<Vec<_>>>()?;
    let index = |item: u32| u32::try_from(shown.binary_search(&item).ok()?).ok();
    let renumbered = |record: &SourceRecord| {
        let outlines = record.outlines.iter().map(|&item| index(item));
        Some(SourceRecord {
            cell: record.cell,
            outlines: outlines.collect::<Option<_>>()?,
        })
    };
    Some(CurveSources {
        flatness_units,
        outlines,
        records: records.iter().map(renumbered).collect::<Option<_>>()?,
    })
}
