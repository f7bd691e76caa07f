//! What a lookup must return, from the outlines and nothing else: for this workspace's tests.
//!
//! The Cargo feature `oracle` adds this module. It is no part of what the crate promises.

mod blend;
pub(crate) mod gradient;
mod painter;
mod tree;

pub use painter::Painter;
