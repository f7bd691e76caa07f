//! What lookups visit: the walk of docs/format.md section 3 in point mode, counting.

use vtex_format::{CellWord, Entry, EntryKind, VtexFile};
use vtex_shaders::cpu;

use crate::heat::{list, segment_count};

/// Lookups that [`lookup_load`] makes: the p99 then rests on 160 of them.
const LOOKUPS: usize = 16_384;

/// Mean and 99th percentile over lookups.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    /// Arithmetic mean.
    pub mean: f64,
    /// 99th percentile.
    pub p99: u32,
}

/// What a magnified point lookup visits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LookupLoad {
    /// Entries up to the first opaque one that covers.
    pub entries: Spread,
    /// Lines and quadratics in the curve records of these entries.
    pub segments: Spread,
}

/// Over points spread evenly over the canvas, the same every time.
pub fn lookup_load(file: &VtexFile) -> LookupLoad {
    let (mut entries, mut segments) = (Vec::new(), Vec::new());
    for k in 0..LOOKUPS {
        // The additive recurrence R2 of Roberts (2018).
        let place = |step: f64| ((k + 1) as f64 * step).fract();
        let uv = [
            place(0.754_877_666_246_692_8),
            place(0.569_840_290_998_053_3),
        ];
        let [entry_count, segment_count] = visit(file, uv);
        entries.push(entry_count);
        segments.push(segment_count);
    }
    LookupLoad {
        entries: spread(entries),
        segments: spread(segments),
    }
}

fn spread(mut counts: Vec<u32>) -> Spread {
    counts.sort_unstable();
    let sum: u64 = counts.iter().map(|&count| u64::from(count)).sum();
    Spread {
        mean: sum as f64 / counts.len().max(1) as f64,
        p99: counts.get(counts.len() * 99 / 100).copied().unwrap_or(0),
    }
}

/// Entries and segments that the lookup at `uv` visits.
fn visit(file: &VtexFile, uv: [f64; 2]) -> [u32; 2] {
    let grid = &file.meta.grid;
    let place = |axis: usize| {
        let p = uv[axis] * f64::from(grid.cell_from_uv_scale[axis])
            + f64::from(grid.cell_from_uv_offset[axis]);
        let cell = p.floor().min(f64::from(grid.size_cells[axis]) - 1.0);
        (cell, p - cell)
    };
    let [(column, s), (row, t)] = [place(0), place(1)];
    let cell = index(row) * grid.size_cells[0] as usize + index(column);
    let word = file.cells.get(cell).copied().unwrap_or(0);
    if matches!(CellWord::decode(word), Some(CellWord::Solid { .. })) {
        return [0, 0];
    }
    let mut counts = [0, 0];
    for entry in list(file, word) {
        counts[0] += 1;
        counts[1] += segment_count(file, entry);
        if entry.opaque && covers(file, entry, uv, [s, t]) {
            break;
        }
    }
    counts
}

/// Whether an opaque entry covers the point `q` of its cell.
fn covers(file: &VtexFile, entry: Entry, uv: [f64; 2], q: [f64; 2]) -> bool {
    match entry.kind {
        EntryKind::Full => true,
        EntryKind::Msdf => inside_tile(file, entry.data, q),
        EntryKind::Curves => {
            let record = file.curves.get(entry.data as usize..).unwrap_or(&[]);
            file.meta.curve_lattice.is_some_and(|lattice| {
                let unit = f64::from(lattice.units_per_cell);
                let margin = f64::from(lattice.margin_units);
                #[expect(clippy::cast_possible_truncation, reason = "at most 65535 units")]
                let p = q.map(|q| (q * unit + margin) as f32);
                cpu::curve::inside(record, p)
            })
        }
        EntryKind::Image => file.images.get(entry.index as usize).is_some_and(|image| {
            let [left, top, right, bottom] = image.rect_uv.map(f64::from);
            (left..=right).contains(&uv[0]) && (top..=bottom).contains(&uv[1])
        }),
    }
}

/// The median of the four texels around `q`, mixed channel by channel, against its middle.
fn inside_tile(file: &VtexFile, tile: u32, q: [f64; 2]) -> bool {
    let steps = file.meta.grid.texels_per_cell as usize;
    let side = steps + 1;
    let place = q.map(|q| (q * steps as f64).max(0.0));
    let corner = place.map(|x| index(x).min(steps - 1));
    let [s, t] = [place[0] - corner[0] as f64, place[1] - corner[1] as f64];
    let first = tile as usize * side * side + corner[1] * side + corner[0];
    let channel = |c: usize| {
        let texel = |o: usize| f64::from(*file.tiles.get(4 * (first + o) + c).unwrap_or(&0));
        let row = |o: usize| texel(o) * (1.0 - s) + texel(o + 1) * s;
        row(0) * (1.0 - t) + row(side) * t
    };
    let [r, g, b] = [channel(0), channel(1), channel(2)];
    r.min(g).max(r.max(g).min(b)) > 127.5
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a place in the grid, not negative"
)]
fn index(x: f64) -> usize {
    x as usize
}

#[cfg(test)]
mod tests {
    use super::{Spread, lookup_load, spread};
    use vtex_baker::{BakeConfig, Mode, Resources, bake};

    #[test]
    fn mean_and_p99() {
        let found = spread((0..200).collect());
        assert_eq!(
            found,
            Spread {
                mean: 99.5,
                p99: 198
            }
        );
    }

    /// A square over a quarter of the canvas, whose edges lie in few cells.
    #[test]
    fn a_square_costs_its_edge_cells() {
        let svg = br##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 16 16">
            <path d="M4.1 4.1H12.1V12.1H4.1Z" fill="#fff"/></svg>"##;
        for (mode, segments) in [(Mode::Curves, 1.0), (Mode::Msdf, 0.0)] {
            let config = BakeConfig {
                mode,
                msdf_size: 384,
                ..BakeConfig::default()
            };
            let file = bake(svg, &config, &Resources::default()).unwrap();
            let load = lookup_load(&file);
            // 128 of 64 x 64 cells hold an edge, and a few more within the reach of one.
            assert!((0.025..0.06).contains(&load.entries.mean), "{load:?}");
            assert_eq!(load.entries.p99, 1);
            let ratio = load.segments.mean / load.entries.mean;
            assert!((ratio - segments).abs() < 0.2, "{mode:?} {load:?}");
        }
    }
}
