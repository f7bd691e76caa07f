//! Loads `.vtex` vector textures into wgpu.
//!
//! Three ways in, all on the caller's own [`wgpu::Device`] with the limits of core WebGPU:
//! - [`GpuVtex`]: a WGSL fragment and a bind group for your own shader;
//! - [`BatchSampler`]: arrays of lookups in, colours out;
//! - [`Tracer`]: a progressive path tracer over [`Scene`]s whose materials use vector textures.
//!
//! [`Gpu::headless`] opens a device for programs that have none.

#![cfg_attr(docsrs, feature(doc_cfg))]

mod batch;
mod device;
mod error;
mod gpu;
mod load;
#[cfg(feature = "tracer")]
pub mod scene;
#[cfg(feature = "tracer")]
mod tracer;

pub use batch::{BatchSampler, Trust};
pub use error::RuntimeError;
pub use gpu::{ADAPTER_VARIABLE, Gpu};
pub use load::{GpuVtex, LoadOptions};
#[cfg(feature = "tracer")]
pub use scene::{
    Camera, Instance, MAX_LIGHTS, MAX_TRIANGLES, Material, Mesh, RectLight, Scene, Sky, Surface,
};
#[cfg(feature = "tracer")]
pub use tracer::{
    Background, Film, LightSampling, RayHit, RayQuery, ToneMap, TraceOptions, TraceStats, Tracer,
};
pub use vtex_shaders::layout::{BatchQuery, FilterMode, FootprintSamples};

// The crates whose types stand in signatures here, so that their versions always fit.
pub use {vtex_format, wgpu};

/// The examples of README.md, which run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
