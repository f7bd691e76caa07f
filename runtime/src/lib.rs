//! Loads `.vtex` vector textures into wgpu.
//!
//! On the caller's own [`wgpu::Device`] with the limits of core WebGPU:
//! - [`TextureSet`]: any number of textures for one pipeline, added and removed at run time, in one bind
//!   group or, where they are more than it binds, in several;
//! - [`GpuVtex`]: one texture alone;
//! - [`QueueSampler`]: lookups in a set that other work on the GPU asks for, by indirect dispatch;
//! - [`BatchSampler`]: arrays of lookups in, colours out;
//! - `Tracer` (feature `tracer`): a progressive path tracer whose materials use vector textures.
//!
//! [`Gpu::headless`] opens a device for programs that have none.
//!
//! ```no_run
//! use vtex_runtime::{Limits, LoadOptions, TextureSet, TextureSetOptions, wgpu};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let (device, queue): (wgpu::Device, wgpu::Queue) = unimplemented!();
//! # let my_wgsl = "";
//! let mut set = TextureSet::new(&device, &queue, &TextureSetOptions::default())?;
//! let file = std::fs::read("sign.vtex")?;
//! let sign = set.load(&file, &Limits::default(), &LoadOptions::default())?;
//! let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
//!     label: None,
//!     // Your fragment shader calls vtex_sample(handle, uv, vec4f(dpdx(uv), dpdy(uv))), with
//!     // sign.to_bits() as the handle.
//!     source: wgpu::ShaderSource::Wgsl((set.wgsl_fragment(1, 0) + my_wgsl).into()),
//! });
//! // Group 1 of your pipeline has the layout set.bind_group_layout(). In each frame:
//! // pass.set_bind_group(1, set.bind_group(), &[]);
//! # let _ = (module, sign); Ok(()) }
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]

mod batch;
mod device;
mod error;
mod gpu;
mod load;
mod queue;
#[cfg(feature = "tracer")]
pub mod scene;
mod set;
#[cfg(feature = "tracer")]
mod tracer;

pub use batch::{BatchSampler, Trust};
pub use device::TexelFormat;
pub use error::RuntimeError;
pub use gpu::{ADAPTER_VARIABLE, Gpu};
#[cfg(any(feature = "zstd", feature = "ruzstd"))]
pub use load::parse_all;
pub use load::{GpuVtex, LoadOptions};
pub use queue::{LookupQueue, QueueBuffers, QueueSampler};
#[cfg(feature = "tracer")]
pub use scene::{
    Camera, Coat, Dielectric, Environment, Glass, Instance, MAX_TRIANGLES, Material, Mesh,
    PunctualKind, PunctualLight, RectLight, Scene, Sky, Surface,
};
pub use set::{PoolBindings, SetBytes, TextureSet, TextureSetOptions};
#[cfg(feature = "tracer")]
pub use tracer::{
    Background, Film, Integrator, LightSampling, RayHit, RayQuery, StageTime, ToneMap,
    TraceOptions, TraceStats, Tracer,
};
pub use vtex_format::{AddressMode, Features, Limits, SpecKey, VtexFile};
pub use vtex_shaders::PackOptions;
pub use vtex_shaders::layout::{BatchQuery, FilterMode, FootprintSamples};
pub use vtex_shaders::set::{TextureHandle, TextureQuery};

// The crates whose types stand in signatures here, so that their versions always fit.
pub use {vtex_format, wgpu};

/// The examples of README.md, which run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
