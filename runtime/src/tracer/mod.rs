//! The progressive path tracer.

mod bvh;
mod film;
mod intersect;
mod options;
mod passes;
mod pipeline;
pub(crate) mod records;
mod textures;
mod timer;
mod upload;
mod world;

use std::sync::OnceLock;

use wgpu::{Buffer, BufferUsages, Device, Queue};

pub use film::{Film, ToneMap};
pub use intersect::{RayHit, RayQuery};
pub use options::{Background, LightSampling, TraceOptions};

use crate::device::{checked, empty_buffer, read_back, submitted_work};
use crate::{RuntimeError, Scene};
use passes::{MAX_FILM_SIDE, MAX_IN_FLIGHT, Passes};
use pipeline::{Bindings, Pipelines, QueryPipeline};
use records::PassRecord;
use timer::Timer;
use upload::SceneBuffers;

/// Renders a [`Scene`] by averaging random paths, a few samples at a time.
///
/// The picture depends only on the scene, the options and the number of samples, not on how the
/// samples were spread over calls or dispatches.
#[derive(Debug)]
pub struct Tracer {
    device: Device,
    queue: Queue,
    size: [u32; 2],
    samples: u32,
    scene: SceneBuffers,
    pipelines: Pipelines,
    bindings: Bindings,
    queries: OnceLock<QueryPipeline>,
    film_sum: Buffer,
    film_rays: Buffer,
    pass: Buffer,
    timer: Option<Timer>,
    /// Every pixel has `samples` samples: false while samples are added, and for ever after when
    /// that fails or its future is dropped half way.
    film_is_even: bool,
}

/// What a picture has cost so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TraceStats {
    /// Rays traced: camera, scattered and shadow rays.
    pub rays: u64,
    /// Time the device spent tracing, in nanoseconds; `None` without timestamps.
    pub device_ns: Option<u64>,
    /// Triangles in the scene, lights included and each instance of a mesh counted in full.
    pub triangles: u32,
    /// Those among them that are left out, because no ray can meet them or tell where: without area,
    /// with edges shorter than about 3e-10 units or longer than 4e9, or further out than 1e12.
    pub dropped_triangles: u32,
    /// Bytes of triangles, hierarchies and instances on the device.
    pub geometry_bytes: u64,
}

impl Tracer {
    /// Builds the BVH, uploads the scene and compiles the shader. The film is `size` pixels.
    ///
    /// # Errors
    /// [`RuntimeError::Parameter`] for a scene that contradicts itself, [`RuntimeError::Limit`]
    /// for one that does not fit the device.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn new(
        device: &Device,
        queue: &Queue,
        scene: &Scene,
        size: [u32; 2],
        options: &TraceOptions,
    ) -> Result<Self, RuntimeError> {
        let made = Self::new_async(device, queue, scene, size, options);
        crate::device::block_on(device, made)
    }

    /// As `Tracer::new`, for callers that must not block. The BVH is built before the first
    /// await: about a second for a million triangles.
    ///
    /// # Errors
    /// [`RuntimeError::Parameter`] for a scene that contradicts itself, [`RuntimeError::Limit`]
    /// for one that does not fit the device.
    pub async fn new_async(
        device: &Device,
        queue: &Queue,
        scene: &Scene,
        size: [u32; 2],
        options: &TraceOptions,
    ) -> Result<Self, RuntimeError> {
        options.check()?;
        scene.check()?;
        if size.contains(&0) || size.iter().any(|&side| side > MAX_FILM_SIDE) {
            return Err(RuntimeError::Parameter(format!(
                "film of {} by {} pixels; each side is 1 to {MAX_FILM_SIDE}",
                size[0], size[1],
            )));
        }
        // The scene first: which code the shader needs depends on the textures' features.
        let buffers = SceneBuffers::upload(device, queue, scene, size, options).await?;
        let pipelines = Pipelines::new(device, &buffers).await?;
        checked(device, "film", || {
            // Buffers, not storage textures: core WebGPU cannot read and write RGBA32Float in place.
            // New buffers hold zeros, so the film starts black.
            let pixels = u64::from(size[0]) * u64::from(size[1]);
            let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
            let film_sum = empty_buffer(device, "vtex film", pixels * 16, usage)?;
            let film_rays = empty_buffer(device, "vtex film rays", pixels * 4, usage)?;
            let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
            let pass_bytes = size_of::<PassRecord>() as u64;
            let pass = empty_buffer(device, "vtex pass", pass_bytes, usage)?;
            let bindings =
                Bindings::new(device, &pipelines, &buffers, &pass, &film_sum, &film_rays);
            Ok(Self {
                timer: Timer::new(device, queue)?,
                device: device.clone(),
                queue: queue.clone(),
                size,
                samples: 0,
                scene: buffers,
                pipelines,
                bindings,
                queries: OnceLock::new(),
                film_sum,
                film_rays,
                pass,
                film_is_even: true,
            })
        })
        .await
    }

    /// Adds `samples` paths to every pixel and waits for them. Long runs are cut into
    /// submissions of a fraction of a second even on a software driver.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device is lost.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn accumulate(&mut self, samples: u32) -> Result<(), RuntimeError> {
        let device = self.device.clone();
        crate::device::block_on(&device, self.accumulate_async(samples))
    }

    /// As `Tracer::accumulate`, for callers that must not block. A future dropped before its end
    /// leaves some pixels with more samples than others; the next call then starts the picture
    /// again.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device is lost.
    pub async fn accumulate_async(&mut self, samples: u32) -> Result<(), RuntimeError> {
        // False until the end, so that it stays false on every way out before it: an error, or a
        // caller that drops the future at an await.
        if !self.film_is_even {
            self.reset();
        }
        self.film_is_even = false;
        let passes = Passes::new(self.size, self.samples, samples);
        for (count, record) in (1..).zip(passes) {
            self.dispatch(record).await?;
            if count % MAX_IN_FLIGHT == 0 {
                self.settle().await?;
            }
        }
        self.settle().await?;
        self.samples = self.samples.saturating_add(samples);
        self.film_is_even = true;
        Ok(())
    }

    /// Waits for what was submitted and adds up its times.
    async fn settle(&mut self) -> Result<(), RuntimeError> {
        match &mut self.timer {
            Some(timer) => timer.finish(&self.device, &self.queue).await,
            None => submitted_work(&self.device, &self.queue).await,
        }
    }

    async fn dispatch(&mut self, record: PassRecord) -> Result<(), RuntimeError> {
        checked(&self.device, "render", || {
            // The queue keeps the order of writes and submissions, so one buffer serves all passes.
            let bytes = bytemuck::bytes_of(&record);
            self.queue.write_buffer(&self.pass, 0, bytes);
            let mut encoder = self
                .device
                .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                    label: Some("vtex render"),
                    timestamp_writes: self.timer.as_ref().map(Timer::writes),
                });
                pass.set_pipeline(&self.pipelines.render);
                pass.set_bind_group(0, &self.bindings.scene, &[]);
                pass.set_bind_group(1, &self.bindings.film, &[]);
                pass.set_bind_group(2, &self.bindings.textures, &[]);
                // Workgroups of 8 by 8, see `root/render.wgsl`, which drops what lies outside.
                pass.dispatch_workgroups(self.size[0].div_ceil(8), record.row_count.div_ceil(8), 1);
            }
            if let Some(timer) = &mut self.timer {
                timer.resolve(&mut encoder);
            }
            self.queue.submit([encoder.finish()]);
            Ok(())
        })
        .await
    }

    /// Samples a pixel so far.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Width and height of the film in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Starts the picture again, for example after [`Tracer::set_camera`].
    pub fn reset(&mut self) {
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.clear_buffer(&self.film_sum, 0, None);
        encoder.clear_buffer(&self.film_rays, 0, None);
        self.queue.submit([encoder.finish()]);
        self.samples = 0;
        if let Some(timer) = &mut self.timer {
            timer.discard();
        }
        self.film_is_even = true;
    }

    /// Moves the camera and starts the picture again.
    ///
    /// # Errors
    /// [`RuntimeError::Parameter`] for a camera without direction.
    pub fn set_camera(&mut self, camera: &crate::Camera) -> Result<(), RuntimeError> {
        self.scene.set_camera(&self.queue, camera)?;
        self.reset();
        Ok(())
    }

    /// Reads the mean of the samples so far.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device is lost.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn read(&self) -> Result<Film, RuntimeError> {
        crate::device::block_on(&self.device, self.read_async())
    }

    /// As `Tracer::read`, for callers that must not block.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device is lost.
    pub async fn read_async(&self) -> Result<Film, RuntimeError> {
        let size = self.film_sum.size();
        let bytes = read_back(&self.device, &self.queue, &self.film_sum, size).await?;
        let scale = 1.0 / self.samples.max(1) as f32;
        let sums: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&bytes);
        Ok(Film {
            size: self.size,
            pixels: sums.into_iter().map(|sum| sum.map(|c| c * scale)).collect(),
            samples: self.samples,
        })
    }

    /// What the picture has cost so far.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device is lost.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn stats(&self) -> Result<TraceStats, RuntimeError> {
        crate::device::block_on(&self.device, self.stats_async())
    }

    /// As `Tracer::stats`, for callers that must not block.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device is lost.
    pub async fn stats_async(&self) -> Result<TraceStats, RuntimeError> {
        let size = self.film_rays.size();
        let bytes = read_back(&self.device, &self.queue, &self.film_rays, size).await?;
        let counts: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
        Ok(TraceStats {
            // A pixel's count fits 32 bits, a picture's may not.
            rays: counts.into_iter().map(u64::from).sum(),
            device_ns: self.timer.as_ref().map(Timer::total_ns),
            triangles: self.scene.world().triangle_count,
            dropped_triangles: self.scene.world().dropped,
            geometry_bytes: self.scene.geometry_bytes(),
        })
    }
}
