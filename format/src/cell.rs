//! The cell grid: one word a cell, lists of entries front to back.

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
/// Paints, and images, that an entry can name.
pub const MAX_INDEXED: u32 = 1 << 19;
/// Items that a list may hold: segments and changes of the winding of its curve records; an entry
/// without any is one. Bounds every evaluator loop over them.
pub const MAX_LIST_ITEMS: u32 = 1 << 15;
/// Items that all lists together may hold: what one storage binding of core WebGPU takes, 128 MiB
/// at 16 bytes.
pub const MAX_ITEMS: u64 = 1 << 23;

/// One cell of the grid.
///
/// | bits 31..30 | bits 29..0 |
/// |---|---|
/// | 0 empty | 0 |
/// | 1 single colour | paint index; the lookup's whole answer, even when translucent |
/// | 2 list | word offset of the first, frontmost entry in the entry section |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellWord {
    /// Nothing is drawn here.
    Empty,
    /// One paint covers the whole cell and all that lies behind is folded into it.
    Solid {
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
            Self::Solid { paint } => (1, paint),
            Self::List { offset_words } => (2, offset_words),
        };
        (payload <= PAYLOAD_MASK).then_some((tag << CELL_TAG_SHIFT) | payload)
    }

    /// Reads a stored word; `None` for a reserved tag or an empty cell with payload.
    pub fn decode(word: u32) -> Option<Self> {
        let payload = word & PAYLOAD_MASK;
        match word >> CELL_TAG_SHIFT {
            0 if payload == 0 => Some(Self::Empty),
            1 => Some(Self::Solid { paint: payload }),
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
/// The second word is the tile index for [`EntryKind::Msdf`], for [`EntryKind::Curves`] the word
/// offset of the record in the curve section, and 0 otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// How it covers.
    pub kind: EntryKind,
    /// Whether the list ends here.
    pub last: bool,
    /// Whether it hides what lies behind where its coverage is 1.
    pub opaque: bool,
    /// Paint index, or image index for [`EntryKind::Image`].
    pub index: u32,
    /// Tile index for [`EntryKind::Msdf`], word offset of its record for [`EntryKind::Curves`], 0
    /// otherwise.
    pub data: u32,
}

impl Entry {
    /// The two words as stored; `None` when the index is [`MAX_INDEXED`] or more.
    pub fn encode(self) -> Option<[u32; 2]> {
        let last = if self.last { LAST_BIT } else { 0 };
        let opaque = if self.opaque { OPAQUE_BIT } else { 0 };
        let head = ((self.kind as u32) << KIND_SHIFT) | last | opaque | self.index;
        (self.index < MAX_INDEXED).then_some([head, self.data])
    }

    /// Reads two stored words; `None` for an unknown kind, an index out of range or a
    /// stray second word.
    pub fn decode([head, data]: [u32; 2]) -> Option<Self> {
        let kind = match head >> KIND_SHIFT {
            0 if data == 0 => EntryKind::Full,
            1 => EntryKind::Msdf,
            2 => EntryKind::Curves,
            3 if data == 0 => EntryKind::Image,
            _ => return None,
        };
        let index = head & INDEX_MASK;
        (index < MAX_INDEXED).then_some(Self {
            kind,
            last: head & LAST_BIT != 0,
            opaque: head & OPAQUE_BIT != 0,
            index,
            data,
        })
    }
}
