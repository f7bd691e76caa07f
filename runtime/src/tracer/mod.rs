//! The progressive path tracer.

mod albedo;
mod bvh;
mod film;
mod intersect;
mod lights;
mod options;
mod passes;
mod pipeline;
#[cfg(test)]
#[cfg(feature = "blocking")]
mod proofs;
mod queues;
pub(crate) mod records;
mod stages;
mod textures;
mod timer;
mod upload;
mod world;

use std::sync::OnceLock;

use wgpu::{Buffer, BufferUsages, CommandEncoder, Device, Queue};

pub use film::{Film, ToneMap};
pub use intersect::{RayHit, RayQuery};
pub use options::{Background, Integrator, LightSampling, TraceOptions};
pub use stages::StageTime;

use crate::device::{checked, empty_buffer, read_back, submitted_work};
use crate::{RuntimeError, Scene};
use passes::{MAX_FILM_SIDE, MAX_IN_FLIGHT, PATHS_PER_PASS, Passes};
use pipeline::{Inputs, QueryPipeline, SceneGroup, SingleKernel, TRAVERSAL};
use records::PassRecord;
use stages::{StageTimer, Stages};
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
    kernels: Kernels,
    traversal: SceneGroup,
    queries: OnceLock<QueryPipeline>,
    film_sum: Buffer,
    film_rays: Buffer,
    pass: Buffer,
    timer: Option<Timer>,
    notices: Vec<String>,
    /// Every pixel has `samples` samples: false while samples are added, and for ever after when
    /// that fails or its future is dropped half way.
    film_is_even: bool,
}

/// What traces paths.
#[derive(Debug)]
enum Kernels {
    Single(Box<SingleKernel>),
    Staged(Box<Stages>),
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
        let [film_sum, film_rays, pass] = film_buffers(device, size).await?;
        let inputs = Inputs {
            scene: &buffers,
            pass: &pass,
            film: [&film_sum, &film_rays],
            size,
            max_bounces: options.max_bounces,
        };
        let kernels = Kernels::new(device, options.integrator, inputs).await?;
        let stored = match &kernels {
            Kernels::Single(_) => &[],
            Kernels::Staged(stages) => stages.notices(),
        };
        let notices = [stored, buffers.notices()].concat();
        checked(device, "film", || {
            Ok(Self {
                notices,
                timer: Timer::new(device, queue)?,
                traversal: SceneGroup::new(device, &buffers, &pass, TRAVERSAL),
                device: device.clone(),
                queue: queue.clone(),
                size,
                samples: 0,
                scene: buffers,
                kernels,
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
        for (count, record) in (1..).zip(self.passes(samples)) {
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

    /// As `Tracer::accumulate`, one submission after the other, and what each stage took on the device.
    /// Nothing where the device has no timestamps. The stages wait for each other longer than in
    /// `Tracer::accumulate`, so their sum is more than what that takes.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device is lost.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn accumulate_timed(&mut self, samples: u32) -> Result<Vec<StageTime>, RuntimeError> {
        let device = self.device.clone();
        crate::device::block_on(&device, self.accumulate_timed_async(samples))
    }

    /// As `Tracer::accumulate_timed`, for callers that must not block.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device is lost.
    pub async fn accumulate_timed_async(
        &mut self,
        samples: u32,
    ) -> Result<Vec<StageTime>, RuntimeError> {
        let (device, queue) = (self.device.clone(), self.queue.clone());
        let timer = checked(&device, "timer", || StageTimer::new(&device, &queue)).await?;
        let (Some(mut timer), Kernels::Staged(_)) = (timer, &self.kernels) else {
            let before = self.timer.as_ref().map(Timer::total_ns);
            self.accumulate_async(samples).await?;
            let after = self.timer.as_ref().map(Timer::total_ns);
            let time = before.zip(after).map(|(before, after)| StageTime {
                stage: "render",
                device_ns: after.saturating_sub(before),
            });
            return Ok(time.into_iter().collect());
        };
        if !self.film_is_even {
            self.reset();
        }
        self.film_is_even = false;
        for record in self.passes(samples) {
            self.dispatch_timed(record, &mut timer).await?;
        }
        self.samples = self.samples.saturating_add(samples);
        self.film_is_even = true;
        Ok(timer.times())
    }

    fn passes(&self, samples: u32) -> Passes {
        let paths = match &self.kernels {
            Kernels::Single(_) => PATHS_PER_PASS,
            Kernels::Staged(stages) => stages.paths(),
        };
        Passes::new(self.size, self.samples, samples, paths)
    }

    /// Waits for what was submitted and adds up its times.
    async fn settle(&mut self) -> Result<(), RuntimeError> {
        match &mut self.timer {
            Some(timer) => timer.finish(&self.device, &self.queue).await,
            None => submitted_work(&self.device, &self.queue).await,
        }
    }

    async fn dispatch(&mut self, record: PassRecord) -> Result<(), RuntimeError> {
        let device = self.device.clone();
        checked(&device, "render", || {
            let mut encoder = self.begin(&record);
            let timestamps = self.timer.as_ref().map(Timer::writes);
            match &self.kernels {
                Kernels::Single(kernel) => kernel.record(&mut encoder, &record, timestamps),
                Kernels::Staged(stages) => stages.record(&mut encoder, &record, timestamps),
            }
            if let Some(timer) = &mut self.timer {
                timer.resolve(&mut encoder);
            }
            self.queue.submit([encoder.finish()]);
            Ok(())
        })
        .await
    }

    async fn dispatch_timed(
        &mut self,
        record: PassRecord,
        timer: &mut StageTimer,
    ) -> Result<(), RuntimeError> {
        checked(&self.device, "render", || {
            let mut encoder = self.begin(&record);
            if let Kernels::Staged(stages) = &self.kernels {
                stages.record_timed(&mut encoder, &record, timer);
            }
            self.queue.submit([encoder.finish()]);
            Ok(())
        })
        .await?;
        timer.finish(&self.device, &self.queue).await
    }

    /// Writes what a submission reads. The queue keeps the order of writes and submissions, so one buffer
    /// serves all passes.
    fn begin(&self, record: &PassRecord) -> CommandEncoder {
        self.queue
            .write_buffer(&self.pass, 0, bytemuck::bytes_of(record));
        if let Kernels::Staged(stages) = &self.kernels {
            stages.prepare(&self.queue, record);
        }
        self.device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    /// One sentence each: where a file's own kernel differs from its key or was not used though
    /// [`TraceOptions::trust`] asks for it, and what glows but is not aimed at.
    pub fn notices(&self) -> &[String] {
        &self.notices
    }

    /// Kernels that look textures up: one for each kernel key of the scene's textures, at most 16, none in
    /// [`Integrator::Single`].
    pub fn lookup_kernels(&self) -> usize {
        match &self.kernels {
            Kernels::Single(_) => 0,
            Kernels::Staged(stages) => stages.lookup_kernels(),
        }
    }

    /// How the work is divided: never [`Integrator::Auto`].
    pub fn integrator(&self) -> Integrator {
        match &self.kernels {
            Kernels::Single(_) => Integrator::Single,
            Kernels::Staged(_) => Integrator::Staged,
        }
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

impl Kernels {
    async fn new(
        device: &Device,
        integrator: Integrator,
        inputs: Inputs<'_>,
    ) -> Result<Self, RuntimeError> {
        Ok(match integrator.chosen() {
            Integrator::Staged => Self::Staged(Box::new(Stages::new(device, inputs).await?)),
            _ => Self::Single(Box::new(SingleKernel::new(device, inputs).await?)),
        })
    }
}

/// Sums of samples, counts of rays, and what a submission is to do.
async fn film_buffers(device: &Device, size: [u32; 2]) -> Result<[Buffer; 3], RuntimeError> {
    checked(device, "film", || {
        // Buffers, not storage textures: core WebGPU cannot read and write RGBA32Float in place.
        // New buffers hold zeros, so the film starts black.
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let pass_bytes = size_of::<PassRecord>() as u64;
        Ok([
            empty_buffer(device, "vtex film", pixels * 16, usage)?,
            empty_buffer(device, "vtex film rays", pixels * 4, usage)?,
            empty_buffer(device, "vtex pass", pass_bytes, uniform)?,
        ])
    })
    .await
}
