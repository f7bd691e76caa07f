//! What a lookup touches: the walk of docs/format.md section 3 over a file's records, counting
//! instead of compositing. Magnified lookups only, where cells answer alone.

use vtex_format::{
    CellWord, CurveHeader, Entry, EntryKind, Features, Image, MAX_ENTRIES_PER_CELL, VtexFile,
};
use vtex_shaders::FilterMode;
use vtex_shaders::cpu::curve::inside;

/// Bytes of a cell's word.
const CELL_BYTES: u64 = 4;
/// Bytes of an entry.
const ENTRY_BYTES: u64 = 8;
/// Four packed texels of a tile.
const MSDF_BYTES: u64 = 16;
/// The half of a paint that a lookup reads, linear or encoded.
const PAINT_BYTES: u64 = 16;
/// An image's rectangle, size, level count and one or two levels' offsets.
const IMAGE_RECORD_BYTES: u64 = 36;
/// Four texels of halves.
const BILINEAR_BYTES: u64 = 32;

/// Sums over lookups.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Count {
    /// Entries visited.
    pub(crate) entries: u64,
    /// Of these, with an MSDF tile.
    pub(crate) msdf: u64,
    /// Bytes of the packed words read, the header (always in a cache) left out.
    pub(crate) bytes: u64,
}

impl Count {
    /// Both together.
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            entries: self.entries + other.entries,
            msdf: self.msdf + other.msdf,
            bytes: self.bytes + other.bytes,
        }
    }
}

/// Counts the lookup at `uv`, inside the canvas, with a footprint `pixel_u` wide in u.
pub(crate) fn count(file: &VtexFile, uv: [f32; 2], pixel_u: f32, filter: FilterMode) -> Count {
    let walk = Walk {
        file,
        uv,
        pixel_u,
        filter,
    };
    let (word, q) = walk.cell();
    let found = Count {
        bytes: CELL_BYTES,
        ..Count::default()
    };
    match CellWord::decode(word) {
        Some(CellWord::Solid { .. }) => found.plus(paint()),
        Some(CellWord::List { offset_words }) => found.plus(walk.list(offset_words, q)),
        _ => found,
    }
}

struct Walk<'a> {
    file: &'a VtexFile,
    uv: [f32; 2],
    pixel_u: f32,
    filter: FilterMode,
}

fn paint() -> Count {
    Count {
        bytes: PAINT_BYTES,
        ..Count::default()
    }
}

impl Walk<'_> {
    /// The cell's word and the point's place inside it.
    fn cell(&self) -> (u32, [f32; 2]) {
        let grid = &self.file.meta.grid;
        let place = |axis: usize| {
            let p = self.uv[axis].clamp(0.0, 1.0) * grid.cell_from_uv_scale[axis]
                + grid.cell_from_uv_offset[axis];
            let cell = index(p).min(grid.size_cells[axis] - 1);
            (cell, p - cell as f32)
        };
        let [(column, s), (row, t)] = [place(0), place(1)];
        let at = row * grid.size_cells[0] + column;
        (
            self.file.cells.get(at as usize).copied().unwrap_or(0),
            [s, t],
        )
    }

    fn list(&self, offset_words: u32, q: [f32; 2]) -> Count {
        let translucent = self.file.spec.features & Features::TRANSLUCENT != 0;
        let all_behind = translucent && self.filter != FilterMode::Point;
        let mut total = Count::default();
        let mut through = 1.0;
        let mut back_to_front = false;
        let entries = self.file.entries[offset_words as usize..]
            .as_chunks::<2>()
            .0;
        for &words in entries.iter().take(MAX_ENTRIES_PER_CELL as usize) {
            let Some(entry) = Entry::decode(words) else {
                break;
            };
            // A translucent entry's ramp needs all that lies behind it: the rest is walked to
            // its end for the count, then backwards.
            back_to_front |= all_behind && !entry.opaque;
            let (coverage, visit) = self.visit(entry, q);
            total = total.plus(visit);
            if back_to_front {
                total.bytes += CELL_BYTES;
            }
            if entry.opaque {
                through *= 1.0 - coverage;
            }
            if entry.last || (through <= 0.0 && !back_to_front) {
                break;
            }
        }
        total
    }

    fn visit(&self, entry: Entry, q: [f32; 2]) -> (f32, Count) {
        let seen = Count {
            entries: 1,
            bytes: ENTRY_BYTES,
            ..Count::default()
        };
        match entry.kind {
            EntryKind::Full => (1.0, seen.plus(paint())),
            EntryKind::Image => (1.0, seen.plus(self.image(entry.index))),
            EntryKind::Msdf => {
                let coverage = self.coverage(entry.data, q);
                let lookup = Count {
                    msdf: 1,
                    bytes: MSDF_BYTES,
                    ..Count::default()
                };
                let shown = if coverage > 0.0 {
                    paint()
                } else {
                    Count::default()
                };
                (coverage, seen.plus(lookup).plus(shown))
            }
            EntryKind::Curves => {
                let (coverage, lookup) = self.curves(entry.data, q);
                let shown = if coverage > 0.0 {
                    paint()
                } else {
                    Count::default()
                };
                (coverage, seen.plus(lookup).plus(shown))
            }
        }
    }

    /// Every word of a record is read. Ramps are narrow when magnified, so the hard test tells
    /// what shows.
    fn curves(&self, at: u32, q: [f32; 2]) -> (f32, Count) {
        let record = self.file.curves.get(at as usize..).unwrap_or(&[]);
        let header = record.first_chunk().copied().and_then(CurveHeader::decode);
        let (Some(header), Some(lattice)) = (header, self.file.meta.curve_lattice) else {
            return (0.0, Count::default());
        };
        let p = q.map(|q| q * lattice.units_per_cell as f32 + lattice.margin_units as f32);
        let count = Count {
            bytes: 4 * u64::from(header.record_words()),
            ..Count::default()
        };
        (f32::from(u8::from(inside(record, p))), count)
    }

    /// Magnified, so level 0 alone, unless the image is finer than the lookup.
    fn image(&self, image: u32) -> Count {
        let Some(Image {
            rect_uv: [left, top, right, bottom],
            size,
            ..
        }) = self.file.images.get(image as usize)
        else {
            return Count::default();
        };
        let inside =
            (*left..=*right).contains(&self.uv[0]) && (*top..=*bottom).contains(&self.uv[1]);
        let texels = self.pixel_u * size[0] as f32 / (right - left);
        let bytes = match inside {
            false => 16,
            true if texels <= 1.0 => IMAGE_RECORD_BYTES + BILINEAR_BYTES,
            true => IMAGE_RECORD_BYTES + 2 * BILINEAR_BYTES,
        };
        Count {
            bytes,
            ..Count::default()
        }
    }

    fn coverage(&self, tile: u32, q: [f32; 2]) -> f32 {
        let meta = &self.file.meta;
        let steps = meta.grid.texels_per_cell;
        let place = q.map(|q| (q * steps as f32).max(0.0));
        let corner = place.map(|x| index(x).min(steps - 1));
        let [s, t] = [place[0] - corner[0] as f32, place[1] - corner[1] as f32];
        let pitch = steps as usize + 1;
        let first = tile as usize * pitch * pitch + corner[1] as usize * pitch + corner[0] as usize;
        let channel = |c: usize| {
            let texel = |o: usize| {
                let byte = self.file.tiles.get(4 * (first + o) + c);
                f32::from(byte.copied().unwrap_or(0)) / 255.0
            };
            let mix = |a: f32, b: f32, t: f32| a * (1.0 - t) + b * t;
            mix(
                mix(texel(0), texel(1), s),
                mix(texel(pitch), texel(pitch + 1), s),
                t,
            )
        };
        let [r, g, b] = [channel(0), channel(1), channel(2)];
        let median = r.min(g).max(r.max(g).min(b));
        match self.filter {
            FilterMode::Point => f32::from(u8::from(median > 0.5)),
            FilterMode::Footprint => {
                let distance_texels = (median - 0.5) * meta.distance_range_texels;
                let pixel = self.pixel_u * meta.grid.cell_from_uv_scale[0] * steps as f32;
                (distance_texels / pixel.max(1e-6) + 0.5).clamp(0.0, 1.0)
            }
            FilterMode::Paper => {
                let smoothing = meta.sampler.smoothing;
                let x = (median - 0.5 + smoothing) / (2.0 * smoothing);
                let x = x.clamp(0.0, 1.0);
                x * x * (3.0 - 2.0 * x)
            }
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturates"
)]
fn index(value: f32) -> u32 {
    value as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use vtex_format::{
        Grid, LayerRecord, Meta, PaintRecord, SHADER_ABI, SamplerSettings, ShaderBlob, SpecKey,
    };

    /// Two cells: one colour, and an MSDF whose left half is inside before a full cover.
    fn file(front_opaque: bool) -> VtexFile {
        let front = Entry {
            kind: EntryKind::Msdf,
            last: false,
            opaque: front_opaque,
            index: 0,
            data: 0,
        };
        let back = Entry {
            kind: EntryKind::Full,
            last: true,
            opaque: true,
            index: 0,
            data: 0,
        };
        let cells = [
            CellWord::Solid { paint: 0 },
            CellWord::List { offset_words: 0 },
        ];
        let mut file = VtexFile {
            meta: Meta {
                canvas_size: [2.0, 1.0],
                grid: Grid {
                    size_cells: [2, 1],
                    cell_from_uv_scale: [2.0, 1.0],
                    cell_from_uv_offset: [0.0, 0.0],
                    texels_per_cell: 1,
                },
                distance_range_texels: 4.0,
                max_zoom: 1.0,
                sampler: SamplerSettings::default(),
                curve_lattice: None,
            },
            spec: bytemuck::Zeroable::zeroed(),
            shader: ShaderBlob {
                abi: SHADER_ABI,
                wgsl_fragment: String::new(),
                batch_spirv: Vec::new(),
            },
            paints: vec![PaintRecord::solid([
                1.0,
                0.0,
                0.0,
                if front_opaque { 1.0 } else { 0.5 },
            ])],
            shapes: Vec::new(),
            layers: vec![LayerRecord {
                tile_first: 0,
                tile_count: 1,
                shape_count: 1,
                reserved: 0,
            }],
            cells: cells.iter().filter_map(|cell| cell.encode()).collect(),
            entries: [front, back]
                .iter()
                .filter_map(|entry| entry.encode())
                .flatten()
                .collect(),
            curves: Vec::new(),
            sources: None,
            tiles: [[255; 4], [0, 0, 0, 255], [255; 4], [0, 0, 0, 255]].concat(),
            images: Vec::new(),
            provenance: None,
        };
        file.spec = SpecKey::for_file(&file);
        file
    }

    #[test]
    fn single_colours_read_a_word_and_a_paint() {
        let got = count(&file(true), [0.25, 0.5], 0.001, FilterMode::Point);
        assert_eq!(
            got,
            Count {
                entries: 0,
                msdf: 0,
                bytes: 20
            }
        );
    }

    #[test]
    fn walks_stop_where_nothing_behind_shows() {
        let inside = count(&file(true), [0.6, 0.5], 0.001, FilterMode::Point);
        assert_eq!(
            inside,
            Count {
                entries: 1,
                msdf: 1,
                bytes: 4 + 8 + 16 + 16
            }
        );
        let outside = count(&file(true), [0.9, 0.5], 0.001, FilterMode::Point);
        assert_eq!(
            outside,
            Count {
                entries: 2,
                msdf: 1,
                bytes: 4 + 8 + 16 + 8 + 16
            }
        );
        let ramp = count(&file(true), [0.75, 0.5], 0.1, FilterMode::Footprint);
        assert_eq!(ramp.entries, 2);
    }

    #[test]
    fn translucent_ramps_walk_twice() {
        let point = count(&file(false), [0.6, 0.5], 0.001, FilterMode::Point);
        assert_eq!(
            point,
            Count {
                entries: 2,
                msdf: 1,
                bytes: 4 + 8 + 16 + 16 + 8 + 16
            }
        );
        let ramp = count(&file(false), [0.6, 0.5], 0.001, FilterMode::Footprint);
        assert_eq!(ramp.bytes, point.bytes + 8);
    }
}
