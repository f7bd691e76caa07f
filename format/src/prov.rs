//! Provenance: how the file came to be. No path, no clock.

use serde::{Deserialize, Serialize};

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

/// How one shape was baked.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShapeReport {
    /// `id` of the SVG element, empty when it has none.
    pub element: String,
    /// `fill`, `stroke` or the feature of a raster patch.
    pub source: String,
    /// Preparation that was needed, empty when plain: `simplified`, `fallback`, ...
    pub note: String,
}

/// Something a user should know about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Warning {
    /// Stable code.
    pub code: WarningCode,
    /// SVG feature, such as `linearGradient` or `font-family`.
    pub feature: String,
    /// `id` of the SVG element, empty when it has none.
    pub element: String,
    /// One sentence for people.
    pub message: String,
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
    /// A budget reduced quality.
    Reduced = 7,
}
