//! Small files built by hand: a grid of cells of unit scale, without a baker.

use std::sync::Arc;

use vtex_format::{
    CellWord, CurveHeader, CurveLattice, Entry, EntryKind, Features, Grid, Image, Meta,
    PaintRecord, SpecKey, VtexFile,
};

/// Lattice steps a cell.
pub(crate) const TEXELS: u32 = 4;
/// Full distance range in texels.
pub(crate) const RANGE: f32 = 4.0;

/// How far the boxes of curve records go beyond their cells, in cells.
const MARGIN: f32 = 0.25;

/// What a listed entry is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Cover {
    Full,
    /// A tile whose distance is the same everywhere, in texels.
    Uniform(f32),
    /// A straight edge across the cell at `x` texels from its left; inside is to the right.
    Edge(f32),
}

/// A file of `columns` cells in one row, all empty.
pub(crate) fn row_of(columns: u32) -> VtexFile {
    board_of([columns, 1])
}

/// A file of columns and rows of cells, all empty.
pub(crate) fn board_of(cells: [u32; 2]) -> VtexFile {
    let grid = Grid::new(cells, TEXELS);
    VtexFile::blank(Meta {
        distance_range_texels: RANGE,
        ..Meta::new(cells.map(|count| count as f32), grid)
    })
}

/// Gives a file without images the canvas' mip chain.
pub(crate) fn set_canvas(
    file: &mut VtexFile,
    size: [u32; 2],
    texel: impl Fn(u32, u32, u32) -> [u8; 4],
) {
    assert!(file.images.is_empty(), "image 0 is the canvas");
    file.images.push(image([0.0, 0.0, 1.0, 1.0], size, texel));
    file.spec.features |= Features::MIPS;
}

pub(crate) fn key(features: u32) -> SpecKey {
    SpecKey { features }
}

pub(crate) fn paint(file: &mut VtexFile, color: [f32; 4]) -> u32 {
    file.paints.push(PaintRecord::solid(color));
    file.paints.len() as u32 - 1
}

pub(crate) fn set_solid(file: &mut VtexFile, cell: usize, color: [f32; 4]) {
    let paint = paint(file, color);
    file.cells[cell] = CellWord::Paint { paint }
        .encode()
        .expect("small indices fit");
}

/// Lists `stack`, front to back, in `cell`.
pub(crate) fn set_list(file: &mut VtexFile, cell: usize, stack: &[(Cover, [f32; 4])]) {
    let entries: Vec<Entry> = stack
        .iter()
        .map(|&(cover, color)| Entry {
            kind: match cover {
                Cover::Full => EntryKind::Full,
                _ => EntryKind::Msdf,
            },
            last: false,
            opaque: color[3] >= 1.0,
            index: paint(file, color),
            data: match cover {
                Cover::Full => 0,
                Cover::Uniform(distance) => push_tile(file, |_, _| distance),
                Cover::Edge(edge) => push_tile(file, |x, _| x - edge),
            },
        })
        .collect();
    push_entries(file, cell, &entries);
}

/// Lists `entries` in `cell`; the last is marked as such.
pub(crate) fn push_entries(file: &mut VtexFile, cell: usize, entries: &[Entry]) {
    let offset_words = file.entries.len() as u32;
    file.cells[cell] = CellWord::List { offset_words }
        .encode()
        .expect("small indices fit");
    for (i, entry) in entries.iter().enumerate() {
        let last = i + 1 == entries.len();
        file.entries.extend(
            Entry { last, ..*entry }
                .encode()
                .expect("small indices fit"),
        );
    }
}

/// Adds a tile of equal channels from a distance in texels at texel coordinates.
pub(crate) fn push_tile(file: &mut VtexFile, distance: impl Fn(f32, f32) -> f32) -> u32 {
    let side = TEXELS + 1;
    let index = file.tiles.len() as u32 / (4 * side * side);
    for y in 0..side {
        for x in 0..side {
            let m = (distance(x as f32, y as f32) / RANGE + 0.5).clamp(0.0, 1.0);
            let byte = (m * 255.0).round() as u8;
            file.tiles.extend([byte, byte, byte, 255]);
        }
    }
    index
}

/// The distance a tile of `Cover::Uniform(distance)` really holds.
pub(crate) fn stored(distance: f32) -> f64 {
    let m = (distance / RANGE + 0.5).clamp(0.0, 1.0);
    (f64::from((m * 255.0).round()) / 255.0 - 0.5) * f64::from(RANGE)
}

/// An image whose level `k` is filled with `texel(k, x, y)`.
pub(crate) fn image(
    rect_uv: [f32; 4],
    size: [u32; 2],
    texel: impl Fn(u32, u32, u32) -> [u8; 4],
) -> Image {
    let mips = (0..Image::level_count(size)).map(|level| {
        let [width, height] = Image::level_size(size, level);
        let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        rows.flat_map(|(x, y)| texel(level, x, y)).collect()
    });
    Image {
        rect_uv,
        size,
        mips: Arc::new(mips.collect()),
    }
}

/// An outline in cell 0's box, `p` in cells from the cell's corner.
pub(crate) type Segment = Vec<[f32; 2]>;

/// Adds the curve record of `segments`, each two or three points, both coordinates monotone.
/// Returns its place.
pub(crate) fn push_record(
    file: &mut VtexFile,
    header: CurveHeader,
    steps: &[(f32, i16)],
    segments: &[Segment],
) -> u32 {
    let lattice = CurveLattice::new(MARGIN).expect("in range");
    file.meta.curve_lattice = Some(lattice);
    let unit = |v: f32| {
        let units = v * lattice.units_per_cell as f32 + lattice.margin_units as f32;
        units.round().clamp(0.0, 65_535.0) as u32
    };
    let runs_down = |segment: &Segment| segment[segment.len() - 1][1] > segment[0][1];
    let stored = |points: usize, down: bool| -> Vec<u32> {
        let chosen = segments
            .iter()
            .filter(|segment| segment.len() == points && runs_down(segment) == down);
        let mut words = Vec::new();
        for segment in chosen {
            let mut points = segment.clone();
            if !down {
                points.reverse();
            }
            words.extend(points.iter().map(|&[x, y]| unit(x) | unit(y) << 16));
        }
        words
    };
    let count = |words: usize, points: u32| words as u32 / points;
    let header = CurveHeader {
        line_count: segments.iter().filter(|s| s.len() == 2).count() as u32,
        down_line_count: count(stored(2, true).len(), 2),
        quad_count: segments.iter().filter(|s| s.len() == 3).count() as u32,
        down_quad_count: count(stored(3, true).len(), 3),
        step_count: steps.len() as u32,
        ..header
    };
    let place = file.curves.len() as u32;
    file.curves.extend(header.encode().expect("fits"));
    let step = |&(y, change): &(f32, i16)| unit(y) | u32::from(change.cast_unsigned()) << 16;
    file.curves.extend(steps.iter().map(step));
    for (points, down) in [(2, true), (2, false), (3, true), (3, false)] {
        file.curves.extend(stored(points, down));
    }
    place
}

/// Lists the record at `place` alone in `cell`.
pub(crate) fn set_record(file: &mut VtexFile, cell: usize, place: u32, color: [f32; 4]) {
    let entry = Entry {
        kind: EntryKind::Curves,
        last: true,
        opaque: color[3] >= 1.0,
        index: paint(file, color),
        data: place,
    };
    push_entries(file, cell, &[entry]);
}
