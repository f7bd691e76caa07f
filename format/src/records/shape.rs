//! The shapes of the drawing in painter's order, for reports and tools; lookups never read them.

use bytemuck::{Pod, Zeroable};

/// [`ShapeRecord::coverage`]: MSDF tiles of its layer.
pub const COVERAGE_MSDF: u32 = 1;
/// [`ShapeRecord::coverage`]: curve records.
pub const COVERAGE_CURVES: u32 = 2;
/// [`ShapeRecord::coverage`]: a raster image.
pub const COVERAGE_IMAGE: u32 = 3;
/// [`ShapeRecord::fill_rule`]: inside where the winding is not zero (SVG 2 sec. 13.3.2).
pub const FILL_NON_ZERO: u32 = 0;
/// [`ShapeRecord::fill_rule`]: inside where the winding is odd.
pub const FILL_EVEN_ODD: u32 = 1;

/// One shape, 40 bytes. A fill and a stroke of one SVG path are two shapes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ShapeRecord {
    /// [`COVERAGE_MSDF`], [`COVERAGE_CURVES`] or [`COVERAGE_IMAGE`].
    pub coverage: u32,
    /// [`FILL_NON_ZERO`] or [`FILL_EVEN_ODD`].
    pub fill_rule: u32,
    /// Index of the layer it is packed into, or of its image.
    pub layer_or_image: u32,
    /// Index into the paints; 0 for an image.
    pub paint: u32,
    /// Left, top, right, bottom of the true shape, in uv. May reach outside the canvas.
    pub bounds_uv: [f32; 4],
    /// Segments of the prepared outline.
    pub segment_count: u32,
    /// Zero.
    pub reserved: u32,
}
