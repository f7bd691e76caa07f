//! The vtex evaluator: WGSL in `wgsl/`, its Rust twin in [`cpu`], and the linker that makes the
//! specialised text from a [`vtex_format::SpecKey`].
//!
//! Both sides read the same packed words and texels ([`pack`]), so a lookup on the CPU and on the GPU
//! walks the same numbers. `docs/format.md` section 3 says what a lookup returns.
//!
//! ```
//! use vtex_shaders::{BindingSlot, fragment};
//! # use vtex_format::{Features, SpecKey};
//! # let features = Features::LISTS | Features::MSDF;
//! # let key = SpecKey { features };
//! let text = fragment(&key, BindingSlot { group: 2, binding: 0 });
//! assert!(text.contains("fn vtex_sample(uv: vec2f, footprint: vec4f) -> vec4f"));
//! assert!(!text.contains("vtex_gradient"), "no code for what the file does not hold");
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]

#[doc(hidden)]
pub mod cores;
pub mod cpu;
mod fine;
pub mod layout;
mod link;
mod pack;
mod packed;
#[cfg(feature = "precompile")]
mod precompile;
pub mod record;
pub mod set;
mod sources;
mod spec;
mod specialize;
pub mod srgb;
mod subdivide;
mod texels;

pub use fine::{check_fine, fine_words};
pub use layout::{BatchQuery, FilterMode, FootprintSamples};
pub use link::{LinkContext, LinkError, link};
#[cfg(feature = "decode")]
pub use pack::{Loaded, load, load_in_pages};
pub use pack::{PackOptions, pack, pack_in_pages, pack_set};
pub use packed::{Packed, PackedSet};
#[cfg(feature = "precompile")]
pub use precompile::{PrecompileError, dictionary_keys, shader_blob, spirv};
pub use spec::{kernel_key, spec_key};
pub use specialize::{
    BATCH_WORKGROUP, BindingSlot, LayerKinds, LightKinds, batch_dispatch, batch_kernel, fragment,
    scene_context, scene_evaluator, with_layers, with_lights, without_cutouts, without_instances,
};
pub use texels::{MAX_PAGE_SIDE, Place, TexelPages, page_bytes};

/// Hash of a shader's text, by which a loader tells whether a file's text is its own.
pub fn hash(text: &str) -> [u8; 32] {
    *blake3::hash(text.as_bytes()).as_bytes()
}

/// The examples of README.md, which run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
