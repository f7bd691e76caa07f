//! The outlines that the file stores instead of curve records: each once, and the cells it is cut
//! to.

use vtex_format::{CurveLattice, CurveSources, SourceRecord};

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
) -> (Option<CurveLattice>, Option<CurveSources>) {
    let curve_lattice =
        curve_lattice(input.placed, lattice, scales).filter(|_| !lists.curves.is_empty());
    let sources = curve_lattice.and_then(|curves| {
        let flatness = flatness_units(lattice, curves, scales.longer_side_px);
        sources(input.covers, &lists.sources, flatness)
            .filter(|sources| sources.is_cuttable(&lattice.grid, curves))
    });
    (curve_lattice, sources)
}

/// The outlines that `records` are cut from, which name items so far; `None` when one of them
/// cannot be stored, so that the file must hold the records themselves.
fn sources(
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
    // From the number of the item to the number of the stored outline.
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
