//! A value to the bytes of a file and back.

mod codec;
mod frame;
mod offsets;
mod planes;
pub(crate) mod read;
pub(crate) mod write;
