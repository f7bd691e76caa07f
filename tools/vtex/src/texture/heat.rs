//! How many entries and segments each cell holds: as numbers and as a heat map.

use serde_json::{Value, json};
use vtex_format::{CellWord, CurveHeader, Entry, VtexFile};

/// Pixels along a cell's side in the heat map: with one pixel per cell, small grids could not be
/// seen.
const CELL_PX: u32 = 8;
/// Colours of the scale, from few to many, sRGB. Lightness grows with the count, so that the map
/// can be read without seeing hue.
const SCALE: [[u8; 3]; 6] = [
    [40, 11, 84],
    [101, 21, 110],
    [159, 42, 99],
    [212, 72, 66],
    [245, 125, 21],
    [250, 215, 90],
];
const EMPTY: [u8; 4] = [0, 0, 0, 0];
const SINGLE: [u8; 4] = [70, 80, 90, 255];

/// What a cell's list holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct CellLoad {
    /// Entries; 0 for empty and cells of a single paint.
    pub(crate) entries: u32,
    /// Lines and quadratics in the curve records of all entries.
    pub(crate) segments: u32,
}

/// The load of each cell, row by row.
pub(crate) fn cell_loads(file: &VtexFile) -> Vec<CellLoad> {
    let load = |&word: &u32| {
        let mut load = CellLoad::default();
        for entry in list(file, word) {
            load.entries = load.entries.saturating_add(1);
            load.segments = load.segments.saturating_add(segment_count(file, entry));
        }
        load
    };
    file.cells.iter().map(load).collect()
}

/// The entries of the list that a cell's word names, front to back; none for other words.
fn list(file: &VtexFile, word: u32) -> impl Iterator<Item = Entry> {
    let first = match CellWord::decode(word) {
        Some(CellWord::List { offset_words }) => offset_words as usize,
        _ => file.entries.len(),
    };
    let rest = file.entries.get(first..).unwrap_or(&[]);
    let mut ended = false;
    rest.as_chunks::<2>().0.iter().map_while(move |&pair| {
        let entry = Entry::decode(pair).filter(|_| !ended)?;
        ended = entry.last;
        Some(entry)
    })
}

/// Lines and quadratics of an entry's curve record; 0 for other entries.
fn segment_count(file: &VtexFile, entry: Entry) -> u32 {
    let words = file.curves.get(entry.data as usize..).unwrap_or(&[]);
    let header = words.first_chunk().copied().and_then(CurveHeader::decode);
    header
        .filter(|_| entry.kind.has_record())
        .map_or(0, |header| header.line_count + header.quad_count)
}

/// A picture of a count per cell.
#[derive(Debug)]
pub(crate) struct HeatMap {
    /// Width and height.
    pub(crate) size_px: [u32; 2],
    /// Row by row from the top.
    pub(crate) rgba: Vec<u8>,
    /// The meaning of its colours, as JSON.
    pub(crate) legend: Value,
}

/// Draws `counts`, one per cell. Empty cells and cells of a single paint have colours that are not
/// on the scale.
pub(crate) fn heat_map(file: &VtexFile, counts: &[u32]) -> HeatMap {
    let bounds = bounds(counts.iter().copied().max().unwrap_or(0));
    let color = |(&word, &count): (&u32, &u32)| match CellWord::decode(word) {
        Some(CellWord::Paint { .. }) => SINGLE,
        Some(CellWord::List { .. }) => opaque(SCALE[step_of(count, &bounds)]),
        _ => EMPTY,
    };
    let cells: Vec<[u8; 4]> = file.cells.iter().zip(counts).map(color).collect();
    let [columns, _] = file.meta.grid.size_cells;
    let mut rgba = Vec::with_capacity(cells.len() * 4 * (CELL_PX * CELL_PX) as usize);
    for row in cells.chunks(columns.max(1) as usize) {
        let line: Vec<[u8; 4]> = row
            .iter()
            .flat_map(|&cell| std::iter::repeat_n(cell, CELL_PX as usize))
            .collect();
        for _ in 0..CELL_PX {
            rgba.extend(line.as_flattened());
        }
    }
    HeatMap {
        size_px: file.meta.grid.size_cells.map(|side| side * CELL_PX),
        rgba,
        legend: legend(&bounds),
    }
}

/// The largest count of each colour. The steps have equal ratios up to `most`: a few cells hold far
/// more than the rest, and with equal differences all others would get one colour.
fn bounds(most: u32) -> [u32; SCALE.len()] {
    let mut bounds = [0; SCALE.len()];
    let mut below = 0;
    for (step, bound) in (1_u32..).zip(&mut bounds) {
        let share = f64::from(step) / SCALE.len() as f64;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and a u32"
        )]
        let wanted = f64::from(most.max(1)).powf(share).round() as u32;
        below = wanted.max(below + 1);
        *bound = below;
    }
    bounds
}

fn step_of(count: u32, bounds: &[u32]) -> usize {
    bounds
        .partition_point(|&bound| bound < count)
        .min(SCALE.len() - 1)
}

fn opaque([r, g, b]: [u8; 3]) -> [u8; 4] {
    [r, g, b, 255]
}

fn legend(bounds: &[u32]) -> Value {
    let mut from = 0;
    let steps: Vec<Value> = bounds
        .iter()
        .zip(SCALE)
        .map(|(&to, color)| {
            let step = json!({"from": from, "to": to, "color": opaque(color)});
            from = to + 1;
            step
        })
        .collect();
    json!({
        "pixels_per_cell": CELL_PX, "empty": EMPTY, "single_color": SINGLE, "lists": steps,
    })
}

#[cfg(test)]
mod tests {
    use super::{SCALE, bounds, step_of};

    #[test]
    fn every_count_has_one_colour_and_the_largest_the_last() {
        for most in [0, 1, 5, 6, 7, 21, 900, 100_000] {
            let bounds = bounds(most);
            assert!(bounds.is_sorted_by(|a, b| a < b), "{bounds:?}");
            assert!(bounds[SCALE.len() - 1] >= most);
            assert_eq!(step_of(0, &bounds), 0);
            let steps: Vec<_> = (0..=most.min(1000)).map(|n| step_of(n, &bounds)).collect();
            assert!(steps.is_sorted());
            for (step, &bound) in bounds.iter().enumerate() {
                assert_eq!(step_of(bound, &bounds), step);
            }
        }
        assert_eq!(bounds(64), [2, 4, 8, 16, 32, 64]);
    }
}
