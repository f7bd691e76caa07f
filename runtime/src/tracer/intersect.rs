//! Single rays of the host: what lies under the mouse.

use wgpu::{BindGroup, BufferUsages};

use super::Tracer;
use super::pipeline::{QueryPipeline, group};
use super::records::{HitRecord, NONE, RayRecord};
use crate::RuntimeError;
use crate::device::{checked, empty_buffer, filled_buffer, read_back};

/// Rays of one workgroup of `root/intersect.wgsl`.
const WORKGROUP: u32 = 64;

/// A ray for [`Tracer::intersect_async`], world space.
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
    /// The nearest triangle along each ray, `None` for a miss. The first call compiles the kernel.
    ///
    /// # Errors
    /// [`RuntimeError::Limit`] for more rays than one dispatch takes, about four million.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn intersect(&self, rays: &[RayQuery]) -> Result<Vec<Option<RayHit>>, RuntimeError> {
        crate::device::block_on(&self.device, self.intersect_async(rays))
    }

    /// As `Tracer::intersect`, for callers that must not block.
    ///
    /// # Errors
    /// [`RuntimeError::Limit`] for more rays than one dispatch takes, about four million.
    pub async fn intersect_async(
        &self,
        rays: &[RayQuery],
    ) -> Result<Vec<Option<RayHit>>, RuntimeError> {
        // wgpu can neither bind nor map a buffer of no bytes.
        if rays.is_empty() {
            return Ok(Vec::new());
        }
        let records: Vec<RayRecord> = rays.iter().map(RayRecord::from).collect();
        let workgroups = u32::try_from(rays.len().div_ceil(WORKGROUP as usize));
        let limit = self.device.limits().max_compute_workgroups_per_dimension;
        let workgroups = workgroups.ok().filter(|&count| count <= limit);
        let workgroups = workgroups
            .ok_or_else(|| RuntimeError::Limit(format!("{} rays in one call", rays.len())))?;
        let pipeline = self.query_pipeline().await?;
        let size = (rays.len() * size_of::<HitRecord>()) as u64;
        let output = checked(&self.device, "intersect", || {
            let (device, queue) = (&self.device, &self.queue);
            let bytes = bytemuck::cast_slice(&records);
            let input = filled_buffer(device, queue, "vtex rays", bytes, BufferUsages::STORAGE)?;
            let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
            // As many hits as the input has rays, padding included: the kernel answers that too, and
            // WGSL lets a write past an array's end land on another of its elements.
            let hits = input.size() / size_of::<RayRecord>() as u64;
            let hits_bytes = hits * size_of::<HitRecord>() as u64;
            let output = empty_buffer(device, "vtex hits", hits_bytes, usage)?;
            let queries = group(device, &pipeline.query_layout, &[&input, &output]);
            self.submit_rays(pipeline, &queries, workgroups);
            Ok(output)
        })
        .await?;
        let bytes = read_back(&self.device, &self.queue, &output, size).await?;
        let hits: Vec<HitRecord> = bytemuck::pod_collect_to_vec(&bytes);
        Ok(hits.into_iter().map(|hit| self.hit(hit)).collect())
    }

    /// The kernel, compiled when it is first asked for: a picture needs none.
    async fn query_pipeline(&self) -> Result<&QueryPipeline, RuntimeError> {
        if let Some(pipeline) = self.queries.get() {
            return Ok(pipeline);
        }
        let made = QueryPipeline::new(&self.device, &self.traversal.layout, &self.scene).await?;
        // Of two calls at the same time the first to end keeps its kernel.
        Ok(self.queries.get_or_init(|| made))
    }

    fn submit_rays(&self, pipeline: &QueryPipeline, queries: &BindGroup, workgroups: u32) {
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline.intersect);
            pass.set_bind_group(0, &self.traversal.group, &[]);
            pass.set_bind_group(1, queries, &[]);
            pass.dispatch_workgroups(workgroups, 1, 1);
        }
        self.queue.submit([encoder.finish()]);
    }

    fn hit(&self, record: HitRecord) -> Option<RayHit> {
        (record.triangle != NONE).then(|| RayHit {
            t: record.t,
            triangle: self
                .scene
                .world()
                .source_triangle(record.triangle, record.instance),
        })
    }
}

impl From<&RayQuery> for RayRecord {
    fn from(ray: &RayQuery) -> Self {
        let [x, y, z] = ray.origin;
        let [dx, dy, dz] = ray.direction;
        Self {
            origin_t_max: [x, y, z, ray.t_max],
            direction: [dx, dy, dz, 0.0],
        }
    }
}
