//! Texels: patches, images that keep theirs, and the canvas' mips.

pub(crate) mod canvas;
pub(crate) mod detail;
pub(crate) mod mips;
pub(crate) mod native;
pub(crate) mod palette;
pub(crate) mod patch;
pub(crate) mod resample;
pub(crate) mod skia;
