//! The parts of the `vtex` command that tests and benches use too: the resvg reference, picture
//! metrics, previews and comparisons.
//!
//! [`reference`] draws the truth, [`preview`] shoots pictures of a texture, [`metrics`] says how
//! far they are apart. The commands themselves live in [`command`].

pub mod color;
pub mod console;
pub mod failure;
pub mod input;
pub mod metrics;
pub mod output;
pub mod picture;
pub mod preview;
pub mod raster;
pub mod reference;
pub mod srgb;
pub mod windows;
