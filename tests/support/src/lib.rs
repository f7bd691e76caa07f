//! What the tests of all packages share: the corpus of real files, the environment variables that
//! switch tests on and off, and the sRGB curve in `f64`.
//!
//! CONTRIBUTING.md documents the variables. Functions here panic when something is wrong: they
//! run inside tests. The crate depends on nothing, so that every package can use it.

pub mod corpus;
mod frozen;
pub mod srgb;
mod switch;

pub use corpus::Corpus;
pub use frozen::Frozen;
pub use switch::{gpu, skip, slow, slow_only};
