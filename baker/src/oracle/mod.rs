//! The oracle: what a lookup must return, computed slowly in f64 from the outlines alone.
//!
//! It is for the tests of this workspace and needs the Cargo feature `oracle`. It may change or
//! disappear in any release.

mod blend;
pub(crate) mod gradient;
mod point;
mod tree;

pub use blend::blend;
pub use point::Oracle;
#[cfg(test)]
pub(crate) use point::crossing;
