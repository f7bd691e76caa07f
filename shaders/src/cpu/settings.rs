//! The header, read once. Twin of `vtex/settings.wgsl` and of `vtex/texture.wgsl`.

use vtex_format::Features;

use super::words::word_of;
use crate::layout::rows::SAMPLES;
use crate::layout::{cmd, header, paint};

#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    pub(super) filter: u32,
    pub(super) address: [u32; 2],
    pub(super) texture_matrix: [f32; 6],
    pub(super) scale: [f32; 2],
    pub(super) offset: [f32; 2],
    /// The last place of the grid along both axes, in cells.
    pub(super) last_place: [f32; 2],
    /// Base cells along a cell, a power of two.
    pub(super) base_per_cell: f32,
    /// Columns of base cells.
    pub(super) base_columns: f32,
    pub(super) texels_per_cell: u32,
    pub(super) mip_texels_per_cell: f32,
    pub(super) distance_range: f32,
    pub(super) smoothing: f32,
    pub(super) outline_width: f32,
    /// Whether eq. 2's outline is on.
    pub(super) outline: bool,
    pub(super) outline_paint: u32,
    /// What `vtex_outline_tag` gives; without outline one that hides nothing.
    pub(super) outline_tag: u32,
    pub(super) cells: u32,
    pub(super) commands: u32,
    pub(super) paints: u32,
    pub(super) tiles: u32,
    pub(super) images: u32,
    /// Of image 0.
    pub(super) mip_size: [f32; 2],
    pub(super) mip_last_level: u32,
    /// Units of the curve lattice along a cell, and around it.
    pub(super) curve_lattice: [f32; 2],
    pub(super) features: u32,
    /// The logarithm to the base of two of the samples of a footprint.
    pub(super) halvings: u32,
}

impl Settings {
    pub(super) fn read(words: &[u32]) -> Self {
        let word = |index| word_of(words, index);
        let float = |index| f32::from_bits(word(index));
        let float2 = |index| [float(index), float(index + 1)];
        let m = header::TEXTURE_MATRIX;
        let mut settings = Self {
            filter: word(header::FILTER),
            address: [word(header::ADDRESS_U), word(header::ADDRESS_V)],
            texture_matrix: [0, 1, 2, 3, 4, 5].map(|i| float(m + i)),
            scale: float2(header::CELL_FROM_UV),
            offset: float2(header::CELL_FROM_UV + 2),
            last_place: float2(header::BASE),
            base_per_cell: float(header::BASE + 2),
            base_columns: float(header::BASE + 3),
            texels_per_cell: word(header::TEXELS_PER_CELL),
            mip_texels_per_cell: float(header::MIP_TEXELS_PER_CELL),
            distance_range: float(header::DISTANCE_RANGE),
            smoothing: float(header::SMOOTHING),
            outline_width: float(header::OUTLINE_WIDTH),
            outline: false,
            outline_paint: word(header::OUTLINE_PAINT),
            outline_tag: cmd::OPAQUE_BIT,
            cells: word(header::CELLS),
            commands: word(header::COMMANDS),
            paints: word(header::PAINTS),
            tiles: word(header::TILES),
            images: word(header::IMAGES),
            mip_size: float2(header::MIP_SIZE),
            mip_last_level: word(header::MIP_SIZE + 2),
            curve_lattice: float2(header::CURVE_UNITS),
            features: word(header::FEATURES),
            // No more than a mask has bits, whatever the words say.
            halvings: (word(header::FEATURES) >> header::SAMPLES_SHIFT).min(SAMPLES.ilog2()),
        };
        if settings.has(Features::OUTLINE) {
            let index = settings.outline_paint;
            let first = index
                .wrapping_mul(paint::WORDS)
                .wrapping_add(settings.paints);
            let alpha = word(first.wrapping_add(1)) >> 16;
            let opaque = if alpha == paint::UNIT {
                cmd::OPAQUE_BIT
            } else {
                0
            };
            settings.outline = true;
            settings.outline_tag = index | opaque;
        }
        settings
    }

    pub(super) fn has(&self, feature: u32) -> bool {
        self.features & feature != 0
    }
}
