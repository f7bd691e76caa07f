//! Point lookups exactly as docs/format.md sec. 3 says, and exact pictures to compare them with.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "lookups are f32 and their cells are found by floor"
)]

use std::io::Write as _;

use kurbo::{Affine, Point};
use vtex_format::{CellWord, Entry, EntryKind, VtexFile};
use vtex_testing::srgb::{decode, encode};

use crate::{
    drawing::Item,
    geometry::Region,
    testing::{Random, closed, solid},
};

/// Point lookups in a file without images, in sRGB-encoded premultiplied colour.
#[derive(Debug)]
pub(crate) struct Evaluator<'a> {
    pub(crate) file: &'a VtexFile,
}

impl Evaluator<'_> {
    /// Entries of the cell at `uv` front to back, and where in the cell `uv` lies.
    pub(crate) fn entries(&self, uv: [f64; 2]) -> (CellWord, Vec<Entry>, [f32; 2]) {
        let grid = &self.file.meta.grid;
        let mut q = [0.0; 2];
        let mut cell = [0; 2];
        for axis in 0..2 {
            let p =
                uv[axis] as f32 * grid.cell_from_uv_scale[axis] + grid.cell_from_uv_offset[axis];
            cell[axis] = (p.floor() as u32).min(grid.size_cells[axis] - 1);
            q[axis] = p - cell[axis] as f32;
        }
        let word = self.file.cells[(cell[1] * grid.size_cells[0] + cell[0]) as usize];
        let word = CellWord::decode(word).unwrap();
        let mut entries = Vec::new();
        if let CellWord::List { offset_words } = word {
            for pair in self.file.entries[offset_words as usize..].chunks_exact(2) {
                let entry = Entry::decode([pair[0], pair[1]]).unwrap();
                entries.push(entry);
                if entry.last {
                    break;
                }
            }
        }
        (word, entries, q)
    }

    /// Colour at `uv`.
    pub(crate) fn point(&self, uv: [f64; 2]) -> [f64; 4] {
        let (word, entries, q) = self.entries(uv);
        let mut out = [0.0; 4];
        if let CellWord::Paint { paint } = word {
            under(&mut out, self.file.paints[paint as usize].color);
        }
        for entry in entries {
            let covered = entry.kind == EntryKind::Full || self.median(entry.data, q) > 127.5;
            if covered {
                under(&mut out, self.file.paints[entry.index as usize].color);
            }
        }
        out
    }

    fn median(&self, tile: u32, q: [f32; 2]) -> f32 {
        let n = self.file.meta.grid.texels_per_cell as usize;
        let tile = &self.file.tiles[tile as usize * 4 * (n + 1) * (n + 1)..];
        let x = q.map(|q| (q * n as f32).clamp(0.0, n as f32));
        let cell = x.map(|x| (x.floor() as usize).min(n - 1));
        let f = [x[0] - cell[0] as f32, x[1] - cell[1] as f32];
        let channel = |c: usize| {
            let at = |i: usize, j: usize| {
                f32::from(tile[4 * ((cell[1] + j) * (n + 1) + cell[0] + i) + c])
            };
            let top = at(0, 0) * (1.0 - f[0]) + at(1, 0) * f[0];
            let bottom = at(0, 1) * (1.0 - f[0]) + at(1, 1) * f[0];
            top * (1.0 - f[1]) + bottom * f[1]
        };
        let [r, g, b] = [channel(0), channel(1), channel(2)];
        r.min(g).max(r.max(g).min(b))
    }
}

/// Composites a straight-alpha colour behind a premultiplied one.
pub(crate) fn under(out: &mut [f64; 4], color: [f32; 4]) {
    let shown = (1.0 - out[3]) * f64::from(color[3]);
    for i in 0..3 {
        out[i] += shown * f64::from(color[i]);
    }
    out[3] += shown;
}

/// The exact colour at any point, from the windings of all shapes there. Without groups.
pub(crate) fn paint_exactly(
    items: &[Item],
    canvas_size: [f64; 2],
) -> impl Fn([f64; 2]) -> [f64; 4] {
    let to_uv = Affine::new([
        1.0 / canvas_size[0],
        0.0,
        0.0,
        1.0 / canvas_size[1],
        0.0,
        0.0,
    ]);
    let regions: Vec<(Region, [f32; 4])> = items
        .iter()
        .filter_map(|item| match item {
            Item::Shape(shape) => {
                let region = Region::new(&closed(&(to_uv * &shape.outline)), shape.fill_rule);
                Some((region, solid(&shape.paint)))
            }
            Item::Image(_) | Item::Clip(_) => None,
        })
        .collect();
    move |uv| {
        let mut out = [0.0; 4];
        for (region, color) in regions.iter().rev() {
            if out[3] < 1.0 && region.contains(Point::new(uv[0], uv[1])) {
                under(&mut out, *color);
            }
        }
        out
    }
}

/// Averages jittered point samples over white in linear light: RGB bytes, row by row.
pub(crate) fn render(
    sample: impl Fn([f64; 2]) -> [f64; 4],
    size: [u32; 2],
    view: [f64; 4],
    spp_side: u32,
) -> Vec<u8> {
    let mut random = Random(1);
    let mut out = Vec::new();
    for y in 0..size[1] {
        for x in 0..size[0] {
            let mut sum = [0.0; 3];
            for k in 0..spp_side * spp_side {
                let jx = (f64::from(k % spp_side) + random.within(0.0, 1.0)) / f64::from(spp_side);
                let jy = (f64::from(k / spp_side) + random.within(0.0, 1.0)) / f64::from(spp_side);
                let s = (f64::from(x) + jx) / f64::from(size[0]);
                let t = (f64::from(y) + jy) / f64::from(size[1]);
                let uv = [
                    view[0] + s * (view[2] - view[0]),
                    view[1] + t * (view[3] - view[1]),
                ];
                let c = sample(uv);
                for i in 0..3 {
                    sum[i] += decode(c[i] + 1.0 - c[3]);
                }
            }
            let n = f64::from(spp_side * spp_side);
            out.extend(sum.map(|v| (encode(v / n) * 255.0).round() as u8));
        }
    }
    out
}

/// Peak signal to noise ratio of two pictures in dB.
pub(crate) fn psnr(a: &[u8], b: &[u8]) -> f64 {
    let sum: f64 = a
        .iter()
        .zip(b)
        .map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2))
        .sum();
    20.0 * 255.0_f64.log10() - 10.0 * (sum / a.len() as f64).log10()
}

/// Writes an RGB picture to the folder that `VTEX_DUMP` names, if it is set.
pub(crate) fn write_png(name: &str, size: [u32; 2], rgb: &[u8]) {
    let Some(folder) = std::env::var_os("VTEX_DUMP") else {
        return;
    };
    let rgba: Vec<u8> = rgb
        .chunks_exact(3)
        .flat_map(|c| [c[0], c[1], c[2], 255])
        .collect();
    let size = tiny_skia::IntSize::from_wh(size[0], size[1]).unwrap();
    let picture = tiny_skia::Pixmap::from_vec(rgba, size).unwrap();
    let path = std::path::Path::new(&folder).join(name);
    std::fs::File::create(path)
        .unwrap()
        .write_all(&picture.encode_png().unwrap())
        .unwrap();
}
