//! What every other file asks of a wgpu device: buffers, calls whose errors come back as values,
//! and waiting for what a device answers later.

mod buffer;
mod kernel;
mod reply;
mod scope;
mod texels;

pub(crate) use buffer::{empty_buffer, filled_buffer, read_back};
pub(crate) use kernel::{READ, WRITE, buffer_entry, buffers_layout, kernel};
#[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
pub(crate) use reply::block_on;
#[cfg(feature = "tracer")]
pub(crate) use reply::submitted_work;
pub(crate) use scope::{checked, compiled};
pub use texels::TexelFormat;
pub(crate) use texels::{Uploaded, array_view, page_array, texel_sampler};
