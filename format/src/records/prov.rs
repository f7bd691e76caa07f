//! Provenance: how the file came to be. No path, no clock.

use serde::{Deserialize, Serialize};

/// [`ShapeReport::source`] of an image of the SVG's own, stored with the texels it has; other images
/// stand for what no shape can be.
pub const EMBEDDED_SOURCE: &str = "embedded image";

/// Stored as bincode in the optional section `PROV`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// blake3 of the SVG as it was given to the baker.
    pub source_hash: [u8; 32],
    /// Name and version of the baker.
    pub tool: String,
    /// Bake options as `name`, `value`, sorted by name.
    pub options: Vec<(String, String)>,
    /// One report a shape, in painter's order, beside the shape records.
    pub shapes: Vec<ShapeReport>,
    /// What was approximated or left out.
    pub warnings: Vec<Warning>,
}

/// How one shape was baked. Its kind of coverage stands in its [`crate::ShapeRecord`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShapeReport {
    /// `id` of the SVG element, empty when it has none.
    pub element: String,
    /// `fill`, `stroke` or the feature of a raster patch.
    pub source: String,
    /// How the outline was made fit for its coverage.
    pub preparation: Preparation,
    /// Why the shape is not an MSDF, or what is wrong with it.
    pub finding: Finding,
    /// Longer side of the shape's box in texels of the lattice on which its MSDF was judged or is
    /// stored, rounded up; 0 where there was none.
    pub size_texels: u32,
    /// How far that MSDF is off; `None` where it was not measured.
    pub msdf_error: Option<MsdfError>,
}

/// Error of an MSDF at the file's largest zoom. Both are finite and not negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MsdfError {
    /// Share of probes around the edge, further from it than the bound on the error, that come out
    /// on the wrong side; at most 1.
    pub wrong_share: f32,
    /// 99th percentile of the edge's displacement, in pixels.
    pub p99_px: f32,
}

/// How an outline was made fit for its coverage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u32)]
pub enum Preparation {
    /// As drawn: curves and images need no more, or nothing had to be done.
    #[default]
    AsDrawn = 0,
    /// Overlaps were removed.
    Simplified = 1,
    /// The first method failed or disagreed with the drawing; the second removed the overlaps.
    SecondMethod = 2,
    /// No method agreed with the drawing; the outline is as drawn.
    Failed = 3,
}

/// Why a shape is not an MSDF, or what is wrong with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u32)]
pub enum Finding {
    /// Nothing: an MSDF within the bound, a kind that an option forces, or an image.
    #[default]
    None = 0,
    /// An MSDF would stay within the bound, but costs more than curves.
    Cost = 1,
    /// Eight bits of distance are too coarse for the largest zoom.
    Quantisation = 2,
    /// A line about a texel wide or less.
    Hairline = 3,
    /// The error sits at sharp corners.
    Cusp = 4,
    /// The error sits where the shape is about as thin as a texel.
    ThinFeature = 5,
    /// The edge is off by more than the bound.
    Displaced = 6,
    /// Overlaps could not be removed, so distances have no side to trust.
    Overlaps = 7,
    /// A cell's part has more segments than curve records can hold.
    TooManySegments = 8,
}

/// Something a user should know about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Warning {
    /// Stable code.
    pub code: WarningCode,
    /// SVG feature, such as `filter` or `font-family`.
    pub feature: String,
    /// `id` of the SVG element, empty when it has none.
    pub element: String,
    /// One sentence for people.
    pub message: String,
    /// Share of the canvas that what it speaks of covers, in \[0, 1\]; 0 when unknown or nothing.
    pub area: f32,
}

/// Stable codes of [`Warning`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u32)]
pub enum WarningCode {
    /// A subtree became a raster patch.
    RasterPatch = 1,
    /// A font was not found; text may be missing or look different.
    MissingFont = 2,
    /// An outside image was not loaded.
    ImageNotLoaded = 3,
    /// A path could not be prepared as wanted and a fallback drew it.
    PathFallback = 4,
    /// `--merge` put shapes that touch into one layer.
    MergeOverlap = 5,
    /// The drawing shows nothing.
    EmptyDrawing = 6,
    /// A budget reduced quality, or a feature of the SVG is not drawn as browsers draw it.
    Reduced = 7,
    /// The texture takes more of a GPU's memory than the caller of the bake wants.
    GpuBytes = 8,
}
