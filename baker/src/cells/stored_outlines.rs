//! The outlines that the file stores instead of curve records: each once, and the cells it is cut
//! to.

use vtex_format::{CurveLattice, RecordParts, StoredOutlines};

use super::{input::CellInput, lists::CellLists};
use crate::coverage::{
    cover::Cover,
    curve_lattice::{curve_lattice, flatness_units},
    grid::Lattice,
    scales::Scales,
};

/// The lattice of curve records, if there are any, and the outlines that a reader makes them from,
/// where it can.
pub(crate) fn stored_curves(
    input: &CellInput<'_>,
    lists: &CellLists,
    lattice: &Lattice,
    scales: &Scales,
) -> (Option<CurveLattice>, Option<StoredOutlines>) {
    let curve_lattice =
        curve_lattice(input.placed, lattice, scales).filter(|_| !lists.curves.is_empty());
    let outlines = curve_lattice.and_then(|curves| {
        let flatness = flatness_units(lattice, curves, scales.longer_side_px);
        stored_outlines(input.covers, &lists.record_parts, flatness)
            .filter(|outlines| outlines.is_cuttable(&lattice.grid, curves))
    });
    (curve_lattice, outlines)
}

/// The outlines that `records` are cut from, which name items so far; `None` when one of them
/// cannot be stored, so that the file must hold the records themselves.
fn stored_outlines(
    covers: &[Cover],
    records: &[RecordParts],
    flatness_units: f32,
) -> Option<StoredOutlines> {
    // Only outlines that show are stored, in painter's order.
    let mut used: Vec<u32> = records
        .iter()
        .flat_map(|record| record.outlines.iter().copied())
        .collect();
    used.sort_unstable();
    used.dedup();
    let outline = |item: &u32| covers.get(*item as usize)?.stored.clone();
    let outlines = used.iter().map(outline).collect::<Option<Vec<_>>>()?;
    // From the number of the item to the number of the stored outline.
    let index = |item: u32| u32::try_from(used.binary_search(&item).ok()?).ok();
    let renumbered = |record: &RecordParts| {
        let outlines = record.outlines.iter().map(|&item| index(item));
        Some(RecordParts {
            cell: record.cell,
            outlines: outlines.collect::<Option<_>>()?,
        })
    };
    Some(StoredOutlines {
        flatness_units,
        outlines,
        records: records.iter().map(renumbered).collect::<Option<_>>()?,
    })
}
