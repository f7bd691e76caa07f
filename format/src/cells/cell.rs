//! The cell grid: one word a cell, lists of entries front to back.

use super::control::{BlendMode, MaskKind, OPEN_ISOLATED};

/// Bit position of a cell word's two-bit tag.
pub const CELL_TAG_SHIFT: u32 = 30;
/// Entries a cell may list. Bounds every evaluator loop; far below the 65,535 iterations after
/// which some software drivers silently stop. A drawing that needs more is refused by the baker.
pub const MAX_ENTRIES_PER_CELL: u32 = 4096;

const PAYLOAD_MASK: u32 = (1 << CELL_TAG_SHIFT) - 1;
pub(crate) const KIND_SHIFT: u32 = 28;
pub(crate) const LAST_BIT: u32 = 1 << 27;
const OPAQUE_BIT: u32 = 1 << 26;
const INDEX_MASK: u32 = OPAQUE_BIT - 1;
/// Paints, and images, that an entry can name; entries that one can pass over are far fewer.
pub const MAX_INDEXED: u32 = 1 << 18;
/// Bits of 1.0: floats from 0 to 1 ascend as their bits do.
const ONE_BITS: u32 = 0x3f80_0000;
/// Commands that a list may hold: segments and changes of the winding of its curve records; an
/// entry without any is one. Bounds every evaluator loop over them.
pub const MAX_LIST_COMMANDS: u32 = 1 << 15;
/// Commands that all lists together may hold: what one storage binding of core WebGPU takes, 128
/// MiB at 16 bytes.
pub const MAX_COMMANDS: u64 = 1 << 23;

/// One cell of the grid.
///
/// | bits 31..30 | bits 29..0 |
/// |---|---|
/// | 0 empty | 0 |
/// | 1 single paint | paint index; the lookup's whole answer, even when translucent |
/// | 2 list | word offset of the first, frontmost entry in the entry section |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellWord {
    /// Nothing is drawn here.
    Empty,
    /// One paint covers the whole cell and all that lies behind is folded into it.
    Paint {
        /// Index into the paints.
        paint: u32,
    },
    /// A list of entries, front to back.
    List {
        /// Word offset of the first entry.
        offset_words: u32,
    },
}

impl CellWord {
    /// The word as stored; `None` when the index does not fit 30 bits.
    pub fn encode(self) -> Option<u32> {
        let (tag, payload) = match self {
            Self::Empty => (0, 0),
            Self::Paint { paint } => (1, paint),
            Self::List { offset_words } => (2, offset_words),
        };
        (payload <= PAYLOAD_MASK).then_some((tag << CELL_TAG_SHIFT) | payload)
    }

    /// Reads a stored word; `None` for a reserved tag or an empty cell with payload.
    pub fn decode(word: u32) -> Option<Self> {
        let payload = word & PAYLOAD_MASK;
        match word >> CELL_TAG_SHIFT {
            // An empty cell has one encoding, so equal grids have equal bytes.
            0 if payload == 0 => Some(Self::Empty),
            1 => Some(Self::Paint { paint: payload }),
            2 => Some(Self::List {
                offset_words: payload,
            }),
            _ => None,
        }
    }
}

/// How an entry covers its cell. Numbers are stable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum EntryKind {
    /// The whole cell lies inside the shape: coverage 1, no lookup.
    Full = 0,
    /// Coverage from the MSDF tile named by the next word.
    Msdf = 1,
    /// Coverage from the exact outline in the curve record named by the next word.
    Curves = 2,
    /// A raster image; coverage and colour are its texels.
    Image = 3,
    /// Shows nothing: branches over the `index` entries behind it where the lookup lies outside the
    /// outline in the curve record named by the next word; inside it when [`Entry::opaque`].
    Branch = 4,
    /// A group begins; [`crate::OPEN_ISOLATED`] or 0 in the next word.
    Open = 5,
    /// A group ends and is composited by the [`crate::BlendMode`] of number `index` with the
    /// opacity in the next word, f32 bits.
    Close = 6,
    /// A group ends and is the mask of the one behind it, by the [`crate::MaskKind`] in the next
    /// word; branches over `index` entries where it is 0.
    Mask = 7,
}

impl EntryKind {
    /// Whether it draws something; the others say what becomes of those that do.
    pub const fn draws(self) -> bool {
        matches!(self, Self::Full | Self::Msdf | Self::Curves | Self::Image)
    }

    /// Whether the second word names a curve record.
    pub const fn has_record(self) -> bool {
        matches!(self, Self::Curves | Self::Branch)
    }
}

/// One entry of a cell's list: two words, so that a list can be walked both ways.
///
/// | bits | first word |
/// |---|---|
/// | 31..28 | [`EntryKind`] |
/// | 27 | last entry of the cell, the backmost |
/// | 26 | opaque: where coverage is 1 nothing behind shows |
/// | 25..0 | paint index, or image index for [`EntryKind::Image`]; less than [`MAX_INDEXED`] |
///
/// The second word is the tile index for [`EntryKind::Msdf`], for [`EntryKind::Curves`] and
/// [`EntryKind::Branch`] the word offset of the record in the curve section, and 0 for
/// [`EntryKind::Full`] and [`EntryKind::Image`]. What the kinds that draw nothing hold is said
/// there, and how they may follow each other at [`crate::list_blocks`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// How it covers.
    pub kind: EntryKind,
    /// Whether the list ends here.
    pub last: bool,
    /// Whether it hides what lies behind where its coverage is 1; of [`EntryKind::Branch`] whether
    /// it branches inside instead of outside.
    pub opaque: bool,
    /// Paint index, or image index for [`EntryKind::Image`].
    pub index: u32,
    /// Tile index for [`EntryKind::Msdf`], word offset of the record for [`EntryKind::Curves`], 0
    /// otherwise.
    pub data: u32,
}

impl Entry {
    /// The two words as stored; `None` when a field is out of its kind's range.
    pub fn encode(self) -> Option<[u32; 2]> {
        let last = if self.last { LAST_BIT } else { 0 };
        let opaque = if self.opaque { OPAQUE_BIT } else { 0 };
        let head = ((self.kind as u32) << KIND_SHIFT) | last | opaque | self.index;
        // The stored field is wider than MAX_INDEXED; evaluators' commands have 18 bits for the
        // index.
        (self.index < MAX_INDEXED && self.is_sound()).then_some([head, self.data])
    }

    /// Reads two stored words; `None` for an unknown kind or a field out of its kind's range.
    pub fn decode([head, data]: [u32; 2]) -> Option<Self> {
        let kind = match head >> KIND_SHIFT {
            0 => EntryKind::Full,
            1 => EntryKind::Msdf,
            2 => EntryKind::Curves,
            3 => EntryKind::Image,
            4 => EntryKind::Branch,
            5 => EntryKind::Open,
            6 => EntryKind::Close,
            7 => EntryKind::Mask,
            _ => return None,
        };
        let index = head & INDEX_MASK;
        let entry = Self {
            kind,
            last: head & LAST_BIT != 0,
            opaque: head & OPAQUE_BIT != 0,
            index,
            data,
        };
        (index < MAX_INDEXED && entry.is_sound()).then_some(entry)
    }

    /// Whether its fields mean something for its kind.
    fn is_sound(&self) -> bool {
        let modes = BlendMode::ALL.len();
        match self.kind {
            EntryKind::Full | EntryKind::Image => self.data == 0,
            EntryKind::Msdf | EntryKind::Curves => true,
            // A branch over nothing would cost time and change nothing.
            EntryKind::Branch => self.index > 0,
            EntryKind::Open => !self.opaque && self.index == 0 && self.data <= OPEN_ISOLATED,
            EntryKind::Close => {
                // The bits of negative numbers and of NaN are larger than those of 1.
                !self.opaque && (self.index as usize) < modes && self.data <= ONE_BITS
            }
            EntryKind::Mask => {
                !self.opaque && self.index > 0 && (self.data as usize) < MaskKind::ALL.len()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_entries_keep_their_ranges() {
        let entry = |kind, opaque, index, data| Entry {
            kind,
            last: false,
            opaque,
            index,
            data,
        };
        let sound = [
            entry(EntryKind::Branch, true, 1, 77),
            entry(EntryKind::Branch, false, MAX_INDEXED - 1, 0),
            entry(EntryKind::Open, false, 0, OPEN_ISOLATED),
            entry(EntryKind::Close, false, 15, 1.0_f32.to_bits()),
            entry(EntryKind::Close, false, 0, 0),
            entry(EntryKind::Mask, false, 3, 2),
        ];
        for entry in sound {
            let words = entry.encode().expect("sound");
            assert_eq!(Entry::decode(words), Some(entry));
        }
        let unsound = [
            entry(EntryKind::Branch, false, 0, 0),
            entry(EntryKind::Open, true, 0, 0),
            entry(EntryKind::Open, false, 1, 0),
            entry(EntryKind::Open, false, 0, 2),
            entry(EntryKind::Close, true, 0, 0),
            entry(EntryKind::Close, false, 17, 0),
            entry(EntryKind::Close, false, 0, 1.000_000_1_f32.to_bits()),
            entry(EntryKind::Close, false, 0, (-0.0_f32).to_bits()),
            entry(EntryKind::Close, false, 0, f32::NAN.to_bits()),
            entry(EntryKind::Mask, false, 0, 0),
            entry(EntryKind::Mask, false, 1, 3),
            entry(EntryKind::Mask, true, 1, 0),
            entry(EntryKind::Full, false, 0, 1),
        ];
        for entry in unsound {
            assert_eq!(entry.encode(), None, "{entry:?}");
        }
        assert_eq!(Entry::decode([8 << KIND_SHIFT, 0]), None);
    }
}
