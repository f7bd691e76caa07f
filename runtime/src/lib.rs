//! Loads `.vtex` vector textures into wgpu.
//!
//! Three ways in, all on the caller's own [`wgpu::Device`] with the limits of core WebGPU:
//! - [`GpuVtex`]: a WGSL fragment and a bind group for your own shader;
//! - [`BatchSampler`]: arrays of lookups in, colours out;
//! - [`Tracer`]: a progressive path tracer over [`Scene`]s whose materials use vector textures.
//!
//! [`Gpu::headless`] opens a device for programs that have none.

mod batch;
mod bvh;
mod camera;
mod error;
mod gpu;
mod load;
mod mesh;
mod plane;
pub mod scene;
mod tracer;

pub use batch::{BatchSampler, Trust};
pub use camera::Camera;
pub use error::RuntimeError;
pub use gpu::{ADAPTER_VARIABLE, Gpu};
pub use load::{GpuVtex, LoadOptions};
pub use mesh::{MAX_TRIANGLES, Mesh};
pub use scene::{Instance, MAX_LIGHTS, Material, RectLight, Scene, Sky, Surface};
pub use tracer::{
    Background, Film, LightSampling, RayHit, RayQuery, ToneMap, TraceOptions, TraceStats, Tracer,
};
pub use vtex_shaders::layout::{BatchQuery, FilterMode};

pub use {glam, wgpu};
