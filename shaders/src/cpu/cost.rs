//! What a lookup reads, for reports: no twin, but it watches the twin's own walk.

use super::picture::picture;
use super::{Lookup, Sampler};
use crate::layout::cmd;

/// Bytes of a fine cell's word.
const CELL_BYTES: u32 = 4;
/// Bytes of a command.
const COMMAND_BYTES: u32 = 4 * cmd::WORDS;
/// Four packed texels of a tile.
const TILE_BYTES: u32 = 16;
/// The half of a paint that a lookup reads, linear or encoded.
const PAINT_BYTES: u32 = 16;
/// An image's rectangle, its size, the places of two levels, and four texels of one.
const IMAGE_BYTES: u32 = 16 + 16 + 8 + 16;

/// What one lookup reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LookupCost {
    /// Entries visited.
    pub entries: u32,
    /// Segments of outlines tested, or changes of the winding beside a cell.
    pub segments: u32,
    /// MSDF tiles read.
    pub tiles: u32,
    /// Bytes of the packed words and texels; the header, always in a cache, is left out.
    pub bytes: u32,
}

/// Is told what a lookup reads.
pub(super) trait Observer {
    /// A fine cell.
    fn cell(&mut self);
    /// A command with this tag.
    fn command(&mut self, tag: u32);
    /// The paint or image of an entry with this tag.
    fn paint(&mut self, tag: u32);
}

/// Nobody watches.
impl Observer for () {
    fn cell(&mut self) {}
    fn command(&mut self, _: u32) {}
    fn paint(&mut self, _: u32) {}
}

/// The cost so far, and the commands of the entry that is being read.
#[derive(Default)]
struct Counter {
    cost: LookupCost,
    commands: u32,
}

impl Observer for Counter {
    fn cell(&mut self) {
        self.cost.bytes += CELL_BYTES;
    }

    fn command(&mut self, tag: u32) {
        self.commands += 1;
        self.cost.bytes += COMMAND_BYTES;
        if tag & cmd::END_BIT != 0 {
            self.cost.entries += 1;
            match tag & cmd::KIND_MASK {
                cmd::CURVES => self.cost.segments += self.commands,
                cmd::MSDF => {
                    self.cost.tiles += 1;
                    self.cost.bytes += TILE_BYTES;
                }
                _ => {}
            }
            self.commands = 0;
        }
    }

    fn paint(&mut self, tag: u32) {
        let image = tag & cmd::KIND_MASK == cmd::IMAGE;
        self.cost.bytes += if image { IMAGE_BYTES } else { PAINT_BYTES };
    }
}

impl Sampler<'_> {
    /// What the lookup at `uv`, inside the canvas before the texture matrix, reads when cells
    /// answer it alone; `footprint` as for [`Sampler::sample`]. A gradient counts as a single
    /// colour does.
    pub fn cost(&self, uv: [f32; 2], footprint: [f32; 4]) -> LookupCost {
        let mut counter = Counter::default();
        let uv = uv.map(|t| t.clamp(0.0, 1.0));
        picture(self, &Lookup::new(self, uv, footprint), &mut counter);
        counter.cost
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
