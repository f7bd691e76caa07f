//! The progressive path tracer.

mod film;
mod options;
mod passes;
mod pipeline;
pub(crate) mod records;
mod upload;

use wgpu::{Buffer, Device, Queue};

pub use film::{Film, ToneMap};
pub use options::{Background, LightSampling, TraceOptions};

use crate::gpu::{checked, empty_buffer, read_buffer, wait};
use crate::{RuntimeError, Scene};
use passes::{MAX_IN_FLIGHT, Passes, Timer};
use pipeline::{Bindings, Pipelines};
use records::{HitRecord, NONE, PassRecord, RayRecord};
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
    film_sum: Buffer,
    film_rays: Buffer,
    pass: Buffer,
    timer: Option<Timer>,
}

/// What a picture has cost so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TraceStats {
    /// Rays traced: camera, scattered and shadow rays.
    pub rays: u64,
    /// Time the device spent tracing, in nanoseconds; `None` without timestamps.
    pub device_ns: Option<u64>,
    /// Triangles in the scene, lights included.
    pub triangles: u32,
}

/// A ray for [`Tracer::intersect`], world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayQuery {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Its direction; `t` counts in its length.
    pub direction: [f32; 3],
    /// Hits at or past this `t` do not count.
    pub t_max: f32,
}

/// The nearest hit of a [`RayQuery`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Distance along the ray.
    pub t: f32,
    /// Triangle, counted over the instances in order and then over the lights, two each.
    pub triangle: u32,
}

impl Tracer {
    /// Builds the BVH, uploads the scene and compiles the shader. The film is `size` pixels.
    ///
    /// # Errors
    /// [`RuntimeError::Parameter`] for a scene that contradicts itself, [`RuntimeError::Limit`]
    /// for one that does not fit the device.
    pub fn new(
        device: &Device,
        queue: &Queue,
        scene: &Scene,
        size: [u32; 2],
        options: &TraceOptions,
    ) -> Result<Self, RuntimeError> {
        options.check()?;
        scene.check()?;
        if size.contains(&0) || size.iter().any(|&side| side > passes::MAX_FILM_SIDE) {
            return Err(RuntimeError::Parameter(format!(
                "film of {} by {} pixels; each side is 1 to {}",
                size[0],
                size[1],
                passes::MAX_FILM_SIDE
            )));
        }
        let buffers = SceneBuffers::upload(device, queue, scene, size, options)?;
        let pipelines = Pipelines::new(device, buffers.texture_features())?;
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_SRC
            | wgpu::BufferUsages::COPY_DST;
        let film_sum = empty_buffer(device, "vtex film", pixels * 16, usage)?;
        let film_rays = empty_buffer(device, "vtex film rays", pixels * 4, usage)?;
        let pass = empty_buffer(
            device,
            "vtex pass",
            size_of::<PassRecord>() as u64,
            wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        )?;
        let bindings = Bindings::new(device, &pipelines, &buffers, &pass, &film_sum, &film_rays)?;
        Ok(Self {
            timer: Timer::new(device, queue)?,
            device: device.clone(),
            queue: queue.clone(),
            size,
            samples: 0,
            scene: buffers,
            pipelines,
            bindings,
            film_sum,
            film_rays,
            pass,
        })
    }

    /// Adds `samples` paths to every pixel and waits for them. Long runs are cut into
    /// submissions of a fraction of a second even on a software driver.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device is lost.
    pub fn accumulate(&mut self, samples: u32) -> Result<(), RuntimeError> {
        let passes = Passes::new(self.size, self.samples, samples);
        for (count, record) in (1..).zip(passes) {
            self.dispatch(record)?;
            if count % MAX_IN_FLIGHT == 0 {
                self.settle()?;
            }
        }
        self.samples = self.samples.saturating_add(samples);
        self.settle()
    }

    /// Waits for what was submitted and adds up its times.
    fn settle(&mut self) -> Result<(), RuntimeError> {
        wait(&self.device)?;
        match &mut self.timer {
            Some(timer) => timer.finish(&self.device, &self.queue),
            None => Ok(()),
        }
    }

    fn dispatch(&mut self, record: PassRecord) -> Result<(), RuntimeError> {
        self.queue
            .write_buffer(&self.pass, 0, bytemuck::bytes_of(&record));
        checked(&self.device, "render", || {
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
                pass.dispatch_workgroups(self.size[0].div_ceil(8), record.row_count.div_ceil(8), 1);
            }
            if let Some(timer) = &mut self.timer {
                timer.resolve(&mut encoder);
            }
            self.queue.submit([encoder.finish()]);
        })
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
    pub fn read(&self) -> Result<Film, RuntimeError> {
        let bytes = read_buffer(
            &self.device,
            &self.queue,
            &self.film_sum,
            self.film_sum.size(),
        )?;
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
    pub fn stats(&self) -> Result<TraceStats, RuntimeError> {
        let bytes = read_buffer(
            &self.device,
            &self.queue,
            &self.film_rays,
            self.film_rays.size(),
        )?;
        let counts: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
        Ok(TraceStats {
            rays: counts.into_iter().map(u64::from).sum(),
            device_ns: self.timer.as_ref().map(Timer::total_ns),
            triangles: self.scene.triangle_count(),
        })
    }

    /// The nearest triangle along each ray, `None` for a miss: picking, and the tests.
    ///
    /// # Errors
    /// [`RuntimeError::Limit`] for more rays than one binding holds.
    pub fn intersect(&self, rays: &[RayQuery]) -> Result<Vec<Option<RayHit>>, RuntimeError> {
        if rays.is_empty() {
            return Ok(Vec::new());
        }
        let records: Vec<RayRecord> = rays
            .iter()
            .map(|ray| {
                let [x, y, z] = ray.origin;
                let [dx, dy, dz] = ray.direction;
                RayRecord {
                    origin_t_max: [x, y, z, ray.t_max],
                    direction: [dx, dy, dz, 0.0],
                }
            })
            .collect();
        let hits = passes::intersect(self, &records)?;
        Ok(hits.into_iter().map(|hit| self.hit(hit)).collect())
    }

    fn hit(&self, record: HitRecord) -> Option<RayHit> {
        (record.triangle != NONE).then(|| RayHit {
            t: record.t,
            triangle: self.scene.source_triangle(record.triangle),
        })
    }
}
