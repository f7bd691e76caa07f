//! What a lookup needs to know besides cells and texels.

use serde::{Deserialize, Serialize};

use super::curve::CurveLattice;

/// Most cells along a side of the grid: beyond it f32 places a point in a cell to less than ten
/// bits. A larger grid is malformed.
pub const MAX_GRID_SIDE: u32 = 16_384;
/// Most lattice steps along a cell. A finer lattice is malformed.
pub const MAX_TEXELS_PER_CELL: u32 = 256;

/// Canvas, grid and sampler settings. Stored as bincode in `META`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Meta {
    /// Width and height of the canvas in SVG user units.
    pub canvas_size: [f32; 2],
    /// The cell grid.
    pub grid: Grid,
    /// Full width of the distances an MSDF texel can hold, in texels.
    pub distance_range_texels: f32,
    /// Largest zoom the geometry was prepared for; 1 shows the longer side of the canvas at 512 pixels.
    pub max_zoom: f32,
    /// How lookups address and filter unless the caller overrides it.
    pub sampler: SamplerSettings,
    /// Lattice of the curve records; `None` without any.
    pub curve_lattice: Option<CurveLattice>,
}

impl Meta {
    /// Settings with the usual values: a distance range of 4 texels, `max_zoom` 1, the default
    /// sampler, no curves. `canvas_size` is in user units.
    pub fn new(canvas_size: [f32; 2], grid: Grid) -> Self {
        Self {
            canvas_size,
            grid,
            distance_range_texels: 4.0,
            max_zoom: 1.0,
            sampler: SamplerSettings::default(),
            curve_lattice: None,
        }
    }
}

/// The uniform cell grid. Cells are square in user units.
///
/// `cell = floor(uv * cell_from_uv_scale + cell_from_uv_offset)`; the offset keeps edges at round
/// SVG coordinates off the lattice lines. Every uv in \[0, 1\] lies in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grid {
    /// Columns and rows.
    pub size_cells: [u32; 2],
    /// Cells a unit of uv.
    pub cell_from_uv_scale: [f32; 2],
    /// Cells between the lattice's origin and the canvas' top-left corner, in \[0, 1).
    pub cell_from_uv_offset: [f32; 2],
    /// Lattice steps of an MSDF tile along a cell's side.
    pub texels_per_cell: u32,
}

impl Grid {
    /// Columns and rows of cells that cover the canvas exactly, its corner in a cell's corner.
    #[expect(
        clippy::cast_precision_loss,
        reason = "grids have at most 2^14 cells a side"
    )]
    pub fn new(size_cells: [u32; 2], texels_per_cell: u32) -> Self {
        Self {
            size_cells,
            cell_from_uv_scale: size_cells.map(|side| side as f32),
            cell_from_uv_offset: [0.0, 0.0],
            texels_per_cell,
        }
    }
}

/// Settings of \[SFG22\] that a lookup applies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SamplerSettings {
    /// `u' = a u + c v + e`, `v' = b u + d v + f`, applied before the address mode.
    pub texture_matrix: [f32; 6],
    /// Address modes along u and v.
    pub address: [AddressMode; 2],
    /// Half width S of eq. 1's smoothstep in units of the stored field, in (0, 0.5].
    pub smoothing: f32,
    /// Only alpha is wanted: lookups return it in all four channels.
    pub mask: bool,
    /// The distance outline of eq. 2.
    pub outline: Option<DistanceOutline>,
}

/// The distance outline of eq. 2: a ring around every shape that MSDF tiles or curves cover.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DistanceOutline {
    /// How far it reaches outside the shape, in texels; less than half the distance range.
    pub width_texels: f32,
    /// Index of its paint, a single colour.
    pub paint: u32,
}

/// What a lookup outside \[0, 1\] sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u32)]
pub enum AddressMode {
    /// The nearest point of the canvas.
    Clamp = 0,
    /// The canvas again.
    Repeat = 1,
    /// The canvas mirrored at every turn.
    Mirror = 2,
    /// Nothing: transparent.
    Border = 3,
}

impl AddressMode {
    /// All of them; each stands at its own number.
    pub const ALL: [Self; 4] = [Self::Clamp, Self::Repeat, Self::Mirror, Self::Border];
}

impl SamplerSettings {
    /// Whether the texture matrix is not the identity.
    pub fn is_transformed(&self) -> bool {
        self.texture_matrix != Self::default().texture_matrix
    }

    /// Whether lookups do more with a place in uv than to clamp it.
    pub fn is_mapped(&self) -> bool {
        self.is_transformed() || self.address != [AddressMode::Clamp; 2]
    }
}

impl Default for SamplerSettings {
    fn default() -> Self {
        Self {
            texture_matrix: [1.0, 0.0, 0.0, 1.0, 0.0, 0.0],
            address: [AddressMode::Clamp; 2],
            // [SFG22]'s own code defaults to 1/64.
            smoothing: 1.0 / 64.0,
            mask: false,
            outline: None,
        }
    }
}
