//! Images: patches, embedded images, and the mips of the canvas.
//!
//! All averaging is done in linear light, premultiplied by alpha: there a mean of colours is the
//! mean of their light.

pub(crate) mod canvas;
mod detail;
pub(crate) mod mips;
mod palette;
pub(crate) mod patch;
pub(crate) mod texel;
