//! What a magnified lookup reads, for reports: no twin, but it walks as the twin does.

use vtex_format::{Features, MAX_ENTRIES_PER_CELL};

use super::cell::find;
use super::coverage::coverage;
use super::{Lookup, Sampler, flow, footprint};
use crate::layout::{cell, filter, item};

/// Bytes of a fine cell's word.
const CELL_BYTES: u32 = 4;
/// Bytes of an item.
const ITEM_BYTES: u32 = 4 * item::WORDS;
/// Four packed texels of a tile.
const TILE_BYTES: u32 = 16;
/// The half of a paint that a lookup reads, linear or encoded.
const PAINT_BYTES: u32 = 16;
/// An image's rectangle, size and four texels of one level.
const IMAGE_BYTES: u32 = 16 + 16 + 4 + 32;

/// What one lookup reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LookupCost {
    /// Entries visited.
    pub entries: u32,
    /// Segments of outlines tested, or changes of the winding beside a cell.
    pub segments: u32,
    /// MSDF tiles read.
    pub tiles: u32,
    /// Bytes of the packed words; the header, always in a cache, is left out.
    pub bytes: u32,
}

impl Sampler<'_> {
    /// What the lookup at `uv`, inside the canvas before the texture matrix, reads when cells
    /// answer it alone; `footprint` as for [`Sampler::sample`].
    pub fn cost(&self, uv: [f32; 2], footprint: [f32; 4]) -> LookupCost {
        let lookup = Lookup {
            uv: uv.map(|t| t.clamp(0.0, 1.0)),
            width_cells: footprint::width_cells(self.settings.scale, footprint),
            q: [0.0; 2],
        };
        let (word, q) = find(self, &lookup);
        let mut cost = LookupCost {
            bytes: CELL_BYTES,
            ..LookupCost::default()
        };
        match word >> cell::TAG_SHIFT {
            cell::SOLID => cost.bytes += PAINT_BYTES,
            cell::LIST => {
                let offset = (word & cell::PAYLOAD_MASK).wrapping_mul(item::WORDS);
                let first = self.settings.items.wrapping_add(offset);
                cost.list(self, first, &Lookup { q, ..lookup });
            }
            _ => {}
        }
        cost
    }
}

impl LookupCost {
    fn list(&mut self, sampler: &Sampler<'_>, first: u32, lookup: &Lookup) {
        let s = &sampler.settings;
        // What a translucent ramp shows depends on all that lies behind it; so do groups.
        let translucent = s.has(Features::TRANSLUCENT) && s.filter != filter::POINT;
        let to_the_end = translucent || s.composited;
        let mut through = 1.0;
        let mut at = first;
        for _ in 0..MAX_ENTRIES_PER_CELL {
            let covered = coverage(sampler, at, lookup);
            let tail = covered.item[3];
            self.items(tail, (covered.next - at) / item::WORDS);
            at = covered.next;
            let (inner, ring) = covered.coverage;
            if tail & item::CONTROL_BIT != 0 {
                // What is passed over in part is read.
                if flow::tests(tail) && flow::jumps(tail, inner) >= 1.0 {
                    at = flow::target(tail, covered.next);
                }
            } else {
                if inner + ring > 0.0 {
                    let image = tail & item::KIND_MASK == item::IMAGE;
                    self.bytes += if image { IMAGE_BYTES } else { PAINT_BYTES };
                }
                if tail & item::OPAQUE_BIT != 0 {
                    through *= 1.0 - inner;
                }
            }
            let hidden = through <= 0.0 && !to_the_end;
            if hidden || tail & item::LAST_BIT != 0 || sampler.is_past(at) {
                break;
            }
        }
    }

    /// The items of an entry with this last word.
    fn items(&mut self, tail: u32, count: u32) {
        self.entries += 1;
        self.bytes += count * ITEM_BYTES;
        match tail & item::KIND_MASK {
            item::CURVES => self.segments += count,
            item::MSDF => {
                self.tiles += 1;
                self.bytes += TILE_BYTES;
            }
            _ => {}
        }
    }
}

impl std::ops::Add for LookupCost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            entries: self.entries + other.entries,
            segments: self.segments + other.segments,
            tiles: self.tiles + other.tiles,
            bytes: self.bytes + other.bytes,
        }
    }
}
