//! Raw bytes of a bundle to stored bytes and back.

#[cfg(any(feature = "encode", feature = "decode"))]
pub(crate) mod dictionary;
#[cfg(feature = "encode")]
pub(crate) mod pack;
#[cfg(feature = "decode")]
pub(crate) mod unpack;
#[cfg(feature = "decode")]
mod zstd_frame;
