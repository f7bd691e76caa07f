//! The packed words that evaluators read: one `array<vec4u>` holds all of a texture but the texels of its
//! images.
//!
//! Several textures can lie in one array; every offset is relative to the texture's first word,
//! so that a packed texture can be moved. All floats are f32 bits.

/// Makes modules of constants, and [`CONSTANTS`] with all of them under the name that
/// `wgsl/core/layout.wgsl` gives them: `header::FILTER` is `VTEX_HEADER_FILTER`.
macro_rules! shared_constants {
    ($(
        $(#[$module_doc:meta])*
        mod $module:ident = $prefix:literal {
            $($(#[$doc:meta])* $name:ident = $value:expr;)*
        }
    )*) => {
        $(
            $(#[$module_doc])*
            pub mod $module {
                $($(#[$doc])* pub const $name: u32 = $value;)*
            }
        )*

        /// Every constant that crosses the border, by its name in WGSL. A test compares names and
        /// values through naga, both ways.
        pub const CONSTANTS: &[(&str, u32)] = &[
            $($((concat!("VTEX_", $prefix, "_", stringify!($name)), $module::$name),)*)*
        ];
    };
}

shared_constants! {
/// Words of the header, by index; what is read together lies in one group of four.
mod header = "HEADER" {
    /// [`vtex_format::SHADER_ABI`].
    ABI = 0;
    /// Bits of [`vtex_format::Features`], and samples as [`header::SAMPLES_SHIFT`](super::header::SAMPLES_SHIFT) says.
    FEATURES = 1;
    /// From this bit of the features' word on: the logarithm to the base of two of the samples of a
    /// footprint.
    SAMPLES_SHIFT = 26;
    /// [`vtex_format::AddressMode`] along u.
    ADDRESS_U = 2;
    /// [`vtex_format::AddressMode`] along v.
    ADDRESS_V = 3;
    /// [`FilterMode`](super::FilterMode).
    FILTER = 4;
    /// Float: full distance range in texels.
    DISTANCE_RANGE = 6;
    /// Float: half width S of \[SFG22\] eq. 1.
    SMOOTHING = 7;
    /// Six floats a b c d e f: `u' = a u + c v + e`, `v' = b u + d v + f`.
    TEXTURE_MATRIX = 8;
    /// Float: eq. 2's width in texels; 0 when off.
    OUTLINE_WIDTH = 14;
    /// Paint index of eq. 2's outline.
    OUTLINE_PAINT = 15;
    /// Four floats: cells a unit of uv along both axes, then the lattice origin in cells.
    CELL_FROM_UV = 16;
    /// Four floats: the last place of the grid along both axes, in cells; base cells along a cell, a
    /// power of two; columns of base cells.
    BASE = 20;
    /// Float: units of the curve lattice along a cell.
    CURVE_UNITS = 24;
    /// Float: units by which a cell's box is wider than the cell, on each side.
    CURVE_MARGIN = 25;
    /// Lattice steps of an MSDF tile along a cell.
    TEXELS_PER_CELL = 26;
    /// Float: texels of mip 0 along a cell; 0 without mips.
    MIP_TEXELS_PER_CELL = 27;
    /// First word of the base cells, row by row, and the blocks behind them.
    CELLS = 28;
    /// First word of the commands, [`cmd::WORDS`](super::cmd::WORDS) each.
    COMMANDS = 29;
    /// First word of the paints, [`paint::WORDS`](super::paint::WORDS) each.
    PAINTS = 30;
    /// First word of the tiles, `(texels_per_cell + 1)^2` each, one RGBA8 texel a word.
    TILES = 31;
    /// First word of the image records, [`image::WORDS`](super::image::WORDS) each.
    IMAGES = 32;
    /// Of image 0: its [`image::SIZE`](super::image::SIZE), then its
    /// [`image::LAST_LEVEL`](super::image::LAST_LEVEL).
    MIP_SIZE = 33;
    /// Words of the header; the rest are zero.
    WORDS = 36;
}

/// [`FilterMode`] as stored.
mod filter = "FILTER" {
    /// [`FilterMode::Point`](super::FilterMode::Point).
    POINT = super::FilterMode::Point as u32;
    /// [`FilterMode::Footprint`](super::FilterMode::Footprint).
    FOOTPRINT = super::FilterMode::Footprint as u32;
    /// [`FilterMode::Paper`](super::FilterMode::Paper).
    PAPER = super::FilterMode::Paper as u32;
}

/// [`vtex_format::AddressMode`] as stored.
mod address = "ADDRESS" {
    /// [`vtex_format::AddressMode::Clamp`].
    CLAMP = vtex_format::AddressMode::Clamp as u32;
    /// [`vtex_format::AddressMode::Repeat`].
    REPEAT = vtex_format::AddressMode::Repeat as u32;
    /// [`vtex_format::AddressMode::Mirror`].
    MIRROR = vtex_format::AddressMode::Mirror as u32;
    /// [`vtex_format::AddressMode::Border`].
    BORDER = vtex_format::AddressMode::Border as u32;
}

/// Features that a shader asks the header for.
mod feature = "FEATURE" {
    /// [`vtex_format::Features::MASK`].
    MASK = vtex_format::Features::MASK;
    /// [`vtex_format::Features::OUTLINE`].
    OUTLINE = vtex_format::Features::OUTLINE;
    /// [`vtex_format::Features::FOOTPRINT`].
    FOOTPRINT = vtex_format::Features::FOOTPRINT;
    /// [`vtex_format::Features::CLIPS`].
    CLIPS = vtex_format::Features::CLIPS;
    /// [`vtex_format::Features::GROUPS`].
    GROUPS = vtex_format::Features::GROUPS;
    /// [`vtex_format::Features::PAPER`].
    PAPER = vtex_format::Features::PAPER;
    /// [`vtex_format::Features::MAPPING`].
    MAPPING = vtex_format::Features::MAPPING;
}

/// Parts of a fine cell's word: tags as of [`vtex_format::CellWord`], a list's payload counts
/// commands. A cell with neither list nor groups has a clearance beside its paint: so far around it, in
/// every direction, in parts of its side, the same shows. Only footprint lookups read it; for others it
/// is 0.
mod cell = "CELL" {
    /// Position of the tag.
    TAG_SHIFT = vtex_format::CELL_TAG_SHIFT;
    /// Bits below the tag: of a list the index of its first command.
    PAYLOAD_MASK = (1 << TAG_SHIFT) - 1;
    /// Bits of a paint's index.
    PAINT_MASK = vtex_format::MAX_INDEXED - 1;
    /// Position of the clearance.
    CLEARANCE_SHIFT = PAINT_MASK.count_ones();
    /// The greatest clearance, and the bits of one.
    CLEARANCE_MASK = 0x7ff;
    /// Clearances are counted in parts of a cell's side, so many to a side.
    CLEARANCE_PARTS = 8;
    /// By how much of its side the list of a cell goes beyond it on each side, as far as the
    /// file's cell goes, in sixteenths. Only footprint lookups read it; for others it does not.
    OVERLAP = 4;
    /// Position from which the word of a base cell that a block divides is `BLOCK`.
    BLOCK_SHIFT = TAG_SHIFT - 1;
    /// The bits of such a word from there: an empty cell's, and one that no empty cell has.
    BLOCK = 1;
    /// Position of a block's depth: it has 2^depth rows of as many cells.
    DEPTH_SHIFT = BLOCK_SHIFT - 3;
    /// The greatest depth, and the bits of one.
    DEPTH_MASK = 7;
    /// Position of the bit that says that a block's cells are [`half`](super::half) words.
    NARROW_SHIFT = DEPTH_SHIFT - 1;
    /// That bit.
    NARROW_BIT = 1 << NARROW_SHIFT;
    /// Bits of a block's place: its first word behind that of the first base cell.
    PLACE_MASK = NARROW_BIT - 1;
    /// Position of a float's exponent: a depth added there multiplies by 2^depth.
    EXPONENT_SHIFT = f32::MANTISSA_DIGITS - 1;
    /// Tag of an empty cell.
    EMPTY = 0;
    /// Tag of a cell of one colour.
    SOLID = 1;
    /// Tag of a cell with a list, front to back.
    LIST = 2;
    /// Tag of a cell with a list that holds groups, back to front.
    GROUPS = 3;
}

/// Cells of a narrow block, two to a word, the first in the low half. Ahead of them is a word: the first
/// command that the block's lists count from.
mod half = "HALF" {
    /// How many bits a cell has.
    BITS = 16;
    /// A cell's bits.
    MASK = (1 << BITS) - 1;
    /// Position of the tag, which is as in a whole word.
    TAG_SHIFT = BITS - 2;
    /// Bits below the tag: of a list its first command, counted from the block's; else as in a whole word.
    PAYLOAD_MASK = (1 << TAG_SHIFT) - 1;
}

/// A command of a list, four words. Curves are a command a segment: upper end, control point, lower
/// end (x in the low half, y in the high half) and the tag, the word whose parts these are. Any
/// other entry is one command whose first word is [`vtex_format::Entry::data`]. The last command of
/// an entry carries what belongs to all of it: index, base, kind, rule, opaque and last.
///
/// Where a list for points ends with two opaque entries, curves and a paint that fills the cell, both are
/// one entry, with [`BACKDROP_BIT`](cmd::BACKDROP_BIT). A fifth of all entries were such backdrops.
///
/// An entry that draws nothing has [`CONTROL_BIT`](cmd::CONTROL_BIT) there. A branch is curves;
/// others are one command whose kind is full, with [`JUMP`](cmd::JUMP), [`OPEN`](cmd::OPEN),
/// [`CLOSE`](cmd::CLOSE) or [`MASK`](cmd::MASK). The index of a branch, jump or mask is the number
/// of commands to pass over, 0 for all that follow; the opaque bit of a branch or jump says that it
/// is taken inside. First words: of open 1 when isolated; of mask its kind; of close opacity
/// (float), blend mode and 1 when isolated.
mod cmd = "CMD" {
    /// Words of a command.
    WORDS = 4;
    /// Bits of the paint or image index.
    INDEX_MASK = vtex_format::MAX_INDEXED - 1;
    /// Set in the last command of a control entry, which draws nothing.
    CONTROL_BIT = 1 << 18;
    /// Set in the last command of a list whose outline is opaque and lies over an opaque paint that fills
    /// the cell: the index is two of them. Lists for footprints have none.
    BACKDROP_BIT = 1 << 19;
    /// Position of the index of the paint behind.
    BACKDROP_SHIFT = INDEX_MASK.count_ones() / 2;
    /// Bits of either of the two.
    BACKDROP_MASK = (1 << BACKDROP_SHIFT) - 1;
    /// Left shift that brings the base winding, four bits in two's complement, to the word's top.
    BASE_LEFT = 8;
    /// Right shift that brings it down from there.
    BASE_RIGHT = 28;
    /// Bits of the entry's kind.
    KIND_MASK = 3 << 24;
    /// [`vtex_format::EntryKind::Full`].
    FULL = (vtex_format::EntryKind::Full as u32) << 24;
    /// [`vtex_format::EntryKind::Msdf`].
    MSDF = (vtex_format::EntryKind::Msdf as u32) << 24;
    /// [`vtex_format::EntryKind::Curves`].
    CURVES = (vtex_format::EntryKind::Curves as u32) << 24;
    /// [`vtex_format::EntryKind::Image`].
    IMAGE = (vtex_format::EntryKind::Image as u32) << 24;
    /// Bits that tell control entries apart.
    CONTROL_MASK = KIND_MASK | LINE_BIT | DOWN_BIT;
    /// An unconditional branch.
    JUMP = FULL;
    /// A group begins.
    OPEN = FULL | LINE_BIT;
    /// A group ends.
    CLOSE = FULL | DOWN_BIT;
    /// A mask ends.
    MASK = FULL | LINE_BIT | DOWN_BIT;
    /// Set in a straight segment, whose control point is its upper end.
    LINE_BIT = 1 << 26;
    /// Set in a segment along which the outline runs down.
    DOWN_BIT = 1 << 27;
    /// Set where an odd winding fills instead of one that is not zero.
    EVEN_ODD_BIT = 1 << 28;
    /// Set in the last command of an entry.
    END_BIT = 1 << 29;
    /// Set in the last, backmost command of a list.
    LAST_BIT = 1 << 30;
    /// Set where nothing behind a coverage of 1 shows.
    OPAQUE_BIT = 1 << 31;
    /// Bound of every loop over the commands of a list.
    LIMIT = vtex_format::MAX_LIST_COMMANDS;
}

/// The samples of a footprint, a bit each: bit 4 k + j of a mask is sample j of row k.
mod rows = "ROWS" {
    /// Samples of a row.
    COLUMNS = 4;
    /// The most that a footprint has.
    SAMPLES = 32;
    /// A mask of all samples.
    EVERY = u32::MAX;
    /// How many eighths of a column the samples of a row lie further right than those of the row
    /// above, within their columns: of all orders of eight even steps, turned by any number of eighths,
    /// the one with the least error over half planes and strips of all directions, together with the
    /// order of columns in a row (docs/decisions/0016).
    SHIFT = 3;
}

/// [`vtex_format::MaskKind`] as stored.
mod mask = "MASK" {
    /// [`vtex_format::MaskKind::Luminance`].
    LUMINANCE = vtex_format::MaskKind::Luminance as u32;
    /// [`vtex_format::MaskKind::Alpha`].
    ALPHA = vtex_format::MaskKind::Alpha as u32;
    /// [`vtex_format::MaskKind::LinearLuminance`].
    LINEAR_LUMINANCE = vtex_format::MaskKind::LinearLuminance as u32;
}

/// [`vtex_format::BlendMode`] as stored.
mod blend = "BLEND" {
    /// [`vtex_format::BlendMode::Multiply`].
    MULTIPLY = vtex_format::BlendMode::Multiply as u32;
    /// [`vtex_format::BlendMode::Screen`].
    SCREEN = vtex_format::BlendMode::Screen as u32;
    /// [`vtex_format::BlendMode::Overlay`].
    OVERLAY = vtex_format::BlendMode::Overlay as u32;
    /// [`vtex_format::BlendMode::Darken`].
    DARKEN = vtex_format::BlendMode::Darken as u32;
    /// [`vtex_format::BlendMode::Lighten`].
    LIGHTEN = vtex_format::BlendMode::Lighten as u32;
    /// [`vtex_format::BlendMode::ColorDodge`].
    COLOR_DODGE = vtex_format::BlendMode::ColorDodge as u32;
    /// [`vtex_format::BlendMode::ColorBurn`].
    COLOR_BURN = vtex_format::BlendMode::ColorBurn as u32;
    /// [`vtex_format::BlendMode::HardLight`].
    HARD_LIGHT = vtex_format::BlendMode::HardLight as u32;
    /// [`vtex_format::BlendMode::SoftLight`].
    SOFT_LIGHT = vtex_format::BlendMode::SoftLight as u32;
    /// [`vtex_format::BlendMode::Difference`].
    DIFFERENCE = vtex_format::BlendMode::Difference as u32;
    /// [`vtex_format::BlendMode::Exclusion`].
    EXCLUSION = vtex_format::BlendMode::Exclusion as u32;
    /// [`vtex_format::BlendMode::Hue`]; those behind it are not separable either.
    HUE = vtex_format::BlendMode::Hue as u32;
    /// [`vtex_format::BlendMode::Saturation`].
    SATURATION = vtex_format::BlendMode::Saturation as u32;
    /// [`vtex_format::BlendMode::Color`].
    COLOR = vtex_format::BlendMode::Color as u32;
    /// [`vtex_format::BlendMode::PlusLighter`].
    PLUS_LIGHTER = vtex_format::BlendMode::PlusLighter as u32;
}

/// A paint, one load. Of a single colour eight shares of [`UNIT`](paint::UNIT), the first in the low
/// half of the first word: red, green, blue and alpha in linear light, premultiplied, then the same
/// sRGB-encoded, straight. Of a gradient the index of its first word, then
/// [`GRADIENT`](paint::GRADIENT), then two zeros.
mod paint = "PAINT" {
    /// Words of a paint.
    WORDS = 4;
    /// What stands for 1.
    UNIT = 0xffff;
    /// Second word of a gradient: premultiplied, no colour has blue and no alpha.
    GRADIENT = 0xffff;
}

/// A gradient, in groups of four words: of circles three, else one; then the offsets of its stops,
/// the last group filled up with [`OFFSET_END`](OFFSET_END), then four floats a stop: straight
/// alpha, sRGB-encoded. Of the first group the floats a, c, e of `x = a u + c v + e`, which is t
/// of a line, and a word whose parts these are. Of circles then b, d, f of `y = b u + d v + f` and
/// [`vtex_format::GradientShape::leading`]; distance, focal radius and two zeros.
mod gradient = "GRADIENT" {
    /// Words before the stops of a line's gradient.
    LINEAR_WORDS = 4;
    /// Words before the stops of a circle's gradient.
    CIRCLE_WORDS = 12;
    /// Bits of the number of stops, from 1 to [`vtex_format::MAX_GRADIENT_STOPS`].
    COUNT_MASK = 0xffff;
    /// Bits of the [`vtex_format::Spread`].
    SPREAD_MASK = 3 << 16;
    /// [`vtex_format::Spread::Reflect`].
    REFLECT = (vtex_format::Spread::Reflect as u32) << 16;
    /// [`vtex_format::Spread::Repeat`].
    REPEAT = (vtex_format::Spread::Repeat as u32) << 16;
    /// Bits of the kind.
    KIND_MASK = 3 << 18;
    /// t is x.
    LINEAR = 0;
    /// t is the length of (x, y): circles about one centre, the focal radius 0.
    ROUND = 1 << 18;
    /// t is that of the circle through (x, y).
    CIRCLES = 2 << 18;
    /// Halvings after which one group of offsets of [`vtex_format::MAX_GRADIENT_STOPS`] is left.
    SEARCH_STEPS = (vtex_format::MAX_GRADIENT_STOPS / 4).ilog2();
}

/// Words of an image record, by index, and how its texels are looked up. They lie in the pages of
/// [`TexelPages`](crate::TexelPages).
mod image = "IMAGE" {
    /// Words of a record.
    WORDS = 24;
    /// Four floats: left, top, right, bottom in uv.
    RECT_UV = 0;
    /// Two floats: texels of the first level that is there.
    SIZE = 4;
    /// The last level, at most [`vtex_format::MAX_MIPS`] - 1.
    LAST_LEVEL = 6;
    /// For each level where its first texel lies: bits of x, of y and of the page. The texels around
    /// a level belong to it too.
    LEVELS = 8;
    /// Bits of x, and of y behind the shift.
    X_MASK = 0x1fff;
    /// Bits below y.
    Y_SHIFT = 13;
    /// Bits below the page.
    PAGE_SHIFT = 26;
    /// Bilinear lookups of a trilinear one.
    TAPS = 2;
    /// Trilinear lookups of one lookup at most: a footprint up to so many times longer than wide
    /// is filtered as it is, a longer one as if it were wider.
    PLACES = 8;
    /// Quarters of a level that a lookup reads finer than its footprint's width: bilinear
    /// interpolation blurs too. Of 14 sizes of 4 drawings, 32 to 240 pixels, one lookup a pixel
    /// has a mean PSNR of 30.8 dB for 0, 35.2 for 2, 37.1 for 3 and 37.0 for 4.
    FINER_QUARTERS = 3;
    /// A weight of less than one in so many is none: half a step of eight bits.
    WEIGHT_STEPS = 512;
}
}

/// Fills up the last group of a gradient's offsets: no t reaches it.
pub const OFFSET_END: f32 = f32::MAX;

/// Whether the word of a cell names a list.
pub(crate) fn has_list(word: u32) -> bool {
    word >> cell::TAG_SHIFT >= cell::LIST
}

/// Whether the word of a base cell names a block.
pub(crate) const fn is_block(word: u32) -> bool {
    word >> cell::BLOCK_SHIFT == cell::BLOCK
}

/// The paints that a drawing entry with this tag names: its own, or that and the one behind it.
pub(crate) fn entry_paints(tag: u32) -> impl Iterator<Item = u32> {
    let (own, behind) = match tag & cmd::BACKDROP_BIT {
        0 => (tag & cmd::INDEX_MASK, None),
        _ => (
            tag & cmd::BACKDROP_MASK,
            Some(tag >> cmd::BACKDROP_SHIFT & cmd::BACKDROP_MASK),
        ),
    };
    std::iter::once(own).chain(behind)
}

/// What a lookup returns of the picture that the cells show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum FilterMode {
    /// The picture at the lookup's place, with hard edges: the caller's samples antialias.
    #[default]
    Point = 0,
    /// The mean of the picture over the footprint, from as many samples as [`FootprintSamples`] says.
    Footprint = 1,
    /// As point, but edges of MSDFs are \[SFG22\] eq. 1: a smoothstep of constant half width S.
    Paper = 2,
}

/// How many samples of the picture make the mean over a footprint. Fewer are faster and noisier: one of
/// n at an edge is right within a 1 / n of its two sides' difference (docs/decisions/0016 has figures).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum FootprintSamples {
    /// 8 samples.
    Eight = 8,
    /// 16 samples.
    Sixteen = 16,
    /// 32 samples.
    #[default]
    ThirtyTwo = 32,
}

/// One query of the batch kernel, 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct BatchQuery {
    /// Point in uv before texture matrix and address mode.
    pub uv: [f32; 2],
    /// Zero.
    pub padding: [f32; 2],
    /// Two axes of the filter region, `axis0.u, axis0.v, axis1.u, axis1.v`, full extents in uv.
    pub footprint: [f32; 4],
}

/// A record's layout, to be compared with that of the WGSL struct.
#[derive(Clone, Copy, Debug)]
pub struct RecordLayout {
    /// Name of the struct in WGSL.
    pub name: &'static str,
    /// Bytes from one array element to the next.
    pub span_bytes: usize,
    /// Fields in order, with their offsets in bytes.
    pub fields: &'static [(&'static str, usize)],
}

/// Makes the [`RecordLayout`] of a `repr(C)` struct from its name in WGSL and all its fields.
#[macro_export]
macro_rules! gpu_record {
    ($record:ty as $name:literal { $($field:ident),* $(,)? }) => {
        $crate::layout::RecordLayout {
            name: $name,
            span_bytes: ::std::mem::size_of::<$record>(),
            fields: &[$((stringify!($field), ::std::mem::offset_of!($record, $field))),*],
        }
    };
}

/// [`BatchQuery`] as `wgsl/core/query.wgsl` has it.
pub const BATCH_QUERY: RecordLayout =
    gpu_record!(BatchQuery as "VtexBatchQuery" { uv, padding, footprint });

#[cfg(test)]
mod tests {
    use super::cell;
    use vtex_format::CellWord;

    #[test]
    fn cells_decode_as_the_format_encodes_them() {
        let word = CellWord::Paint { paint: 5 }.encode().unwrap();
        assert_eq!(
            (word >> cell::TAG_SHIFT, word & cell::PAYLOAD_MASK),
            (cell::SOLID, 5)
        );
        let word = CellWord::List { offset_words: 6 }.encode().unwrap();
        assert_eq!(
            (word >> cell::TAG_SHIFT, word & cell::PAYLOAD_MASK),
            (cell::LIST, 6)
        );
    }
}
