//! A whole file as a value, and the key of its shader.

pub(crate) mod spec;
pub(crate) mod texture;
