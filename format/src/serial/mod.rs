//! A value to the bytes of a file and back.

#[cfg(any(feature = "encode", feature = "decode"))]
mod canonical;
#[cfg(all(test, feature = "encode"))]
mod layout_tests;
#[cfg(any(feature = "encode", feature = "decode"))]
mod levels;
#[cfg(any(feature = "encode", feature = "decode"))]
mod offsets;
#[cfg(any(feature = "encode", feature = "decode"))]
mod planes;
#[cfg(feature = "decode")]
pub(crate) mod read;
#[cfg(feature = "encode")]
pub(crate) mod write;
