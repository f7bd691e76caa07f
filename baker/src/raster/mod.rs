//! Texels: patches, images that keep theirs, and the canvas' mips.

pub(crate) mod canvas;
mod detail;
pub(crate) mod mips;
mod palette;
pub(crate) mod patch;
pub(crate) mod texel;
