//! Bytes of an asset: its containers, its buffers, and the numbers in them.

pub(crate) mod accessor;
pub(crate) mod glb;
pub(crate) mod source;
