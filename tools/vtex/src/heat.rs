//! How many entries each cell lists, as numbers and as a picture.

use serde_json::{Value, json};
use vtex_format::{CellWord, Entry, VtexFile};

/// Entries of each cell, row by row; 0 for empty and single-colour cells.
pub fn entry_counts(file: &VtexFile) -> Vec<u32> {
    let (pairs, _) = file.entries.as_chunks::<2>();
    let length = |first: u32| {
        let listed = pairs.iter().skip(first as usize / 2);
        let until_last = listed.take_while(|&&pair| Entry::decode(pair).is_some_and(|e| !e.last));
        u32::try_from(until_last.count()).map_or(u32::MAX, |before| before + 1)
    };
    let count = |&word: &u32| match CellWord::decode(word) {
        Some(CellWord::List { offset_words }) => length(offset_words),
        _ => 0,
    };
    file.cells.iter().map(count).collect()
}

/// Pixels along a cell's side in the heat map, so that small grids can be seen.
const CELL_PX: u32 = 8;

/// Colours of the scale, from few entries to many; sRGB. Black-body order, readable without
/// seeing hue.
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

/// The heat map as RGBA8 with its size, and its legend.
pub fn heat_map(file: &VtexFile) -> ([u32; 2], Vec<u8>, Value) {
    let counts = entry_counts(file);
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let color = |(&word, &count): (&u32, &u32)| match CellWord::decode(word) {
        Some(CellWord::Solid { .. }) => SINGLE,
        Some(CellWord::List { .. }) => scale(count, most),
        _ => EMPTY,
    };
    let cells: Vec<[u8; 4]> = file.cells.iter().zip(&counts).map(color).collect();
    let [columns, _] = file.meta.grid.size_cells;
    let mut pixels = Vec::with_capacity(cells.len() * 4 * (CELL_PX * CELL_PX) as usize);
    for row in cells.chunks(columns.max(1) as usize) {
        let line: Vec<[u8; 4]> = row
            .iter()
            .flat_map(|&cell| std::iter::repeat_n(cell, CELL_PX as usize))
            .collect();
        for _ in 0..CELL_PX {
            pixels.extend(line.as_flattened());
        }
    }
    let size_px = file.meta.grid.size_cells.map(|side| side * CELL_PX);
    (size_px, pixels, legend(most))
}

fn scale(count: u32, most: u32) -> [u8; 4] {
    let last = u32::try_from(SCALE.len() - 1).unwrap_or(0);
    let step = (count.saturating_sub(1) * last) / most.saturating_sub(1).max(1);
    let [r, g, b] = SCALE[step.min(last) as usize];
    [r, g, b, 255]
}

fn legend(most: u32) -> Value {
    let steps: Vec<Value> = (1..=most)
        .map(|count| json!({"entries": count, "color": scale(count, most)}))
        .take(4096)
        .collect();
    json!({"pixels_per_cell": CELL_PX, "empty": EMPTY, "single_color": SINGLE, "lists": steps})
}
