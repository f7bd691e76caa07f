//! How long work is cut into short submissions, and how they are timed.

use wgpu::{Buffer, CommandEncoder, Device, Queue};

use super::Tracer;
use super::pipeline::group;
use super::records::{HitRecord, PassRecord, RayRecord};
use crate::RuntimeError;
use crate::gpu::{checked, empty_buffer, filled_buffer, read_buffer};

/// Longest side of a film: 8,192 workgroups of 8 pixels stay far below the dispatch limit of
/// 65,535. Larger pictures are refused.
pub(super) const MAX_FILM_SIDE: u32 = 65_536;
/// Paths of one submission. On a software driver at about a million rays a second this is a
/// fraction of a second, on a graphics card well under a millisecond's overhead a frame; drivers
/// that reset after two seconds are never met.
const PATHS_PER_PASS: u32 = 1 << 16;
/// Samples one invocation may add in one pass, so that small films need fewer submissions.
const MAX_SAMPLES_PER_PASS: u32 = 16;
/// Submissions that may be under way before the host waits, which bounds queued memory.
pub(super) const MAX_IN_FLIGHT: u32 = 8;
/// Where a submission's two timestamps lie, in words: resolve offsets are multiples of 256 bytes.
const STAMP_STRIDE: usize = 32;
const STAMP_STRIDE_BYTES: u64 = 8 * STAMP_STRIDE as u64;

/// Rows and samples of each submission: all rows of some samples, then the next samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passes {
    height: u32,
    rows_per_pass: u32,
    samples_per_pass: u32,
    row: u32,
    sample: u32,
    sample_end: u32,
}

impl Passes {
    pub(super) fn new(size: [u32; 2], sample_first: u32, sample_count: u32) -> Self {
        let rows = (PATHS_PER_PASS / size[0]).clamp(1, size[1]);
        let samples =
            (PATHS_PER_PASS / rows.saturating_mul(size[0]).max(1)).clamp(1, MAX_SAMPLES_PER_PASS);
        Self {
            height: size[1],
            rows_per_pass: rows,
            samples_per_pass: samples,
            row: 0,
            sample: sample_first,
            sample_end: sample_first.saturating_add(sample_count),
        }
    }
}

impl Iterator for Passes {
    type Item = PassRecord;

    fn next(&mut self) -> Option<PassRecord> {
        if self.sample >= self.sample_end {
            return None;
        }
        let record = PassRecord {
            row_first: self.row,
            row_count: self.rows_per_pass.min(self.height - self.row),
            sample_first: self.sample,
            sample_count: self.samples_per_pass.min(self.sample_end - self.sample),
        };
        self.row += record.row_count;
        if self.row == self.height {
            self.row = 0;
            self.sample += record.sample_count;
        }
        Some(record)
    }
}

/// Timestamps around every submission.
#[derive(Debug)]
pub(super) struct Timer {
    queries: wgpu::QuerySet,
    resolved: Buffer,
    period_ns: f32,
    pending: u32,
    ticks: u64,
}

impl Timer {
    /// `None` when the device was made without timestamps.
    pub(super) fn new(device: &Device, queue: &Queue) -> Result<Option<Self>, RuntimeError> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Ok(None);
        }
        let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("vtex timer"),
            ty: wgpu::QueryType::Timestamp,
            count: 2,
        });
        let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        let size = u64::from(MAX_IN_FLIGHT) * STAMP_STRIDE_BYTES;
        Ok(Some(Self {
            queries,
            resolved: empty_buffer(device, "vtex timer", size, usage)?,
            period_ns: queue.get_timestamp_period(),
            pending: 0,
            ticks: 0,
        }))
    }

    pub(super) fn writes(&self) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    pub(super) fn resolve(&mut self, encoder: &mut CommandEncoder) {
        let offset = u64::from(self.pending) * STAMP_STRIDE_BYTES;
        encoder.resolve_query_set(&self.queries, 0..2, &self.resolved, offset);
        self.pending += 1;
    }

    /// Adds up the times of what was resolved since; at most [`MAX_IN_FLIGHT`] passes.
    pub(super) fn finish(&mut self, device: &Device, queue: &Queue) -> Result<(), RuntimeError> {
        if self.pending == 0 {
            return Ok(());
        }
        let bytes = read_buffer(device, queue, &self.resolved, self.resolved.size())?;
        let stamps: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes);
        let spent = stamps
            .chunks(STAMP_STRIDE)
            .take(self.pending as usize)
            .map(|pair| pair[1].saturating_sub(pair[0]));
        self.ticks += spent.sum::<u64>();
        self.pending = 0;
        Ok(())
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a time in ns, far below 2^63"
    )]
    pub(super) fn total_ns(&self) -> u64 {
        (self.ticks as f64 * f64::from(self.period_ns)) as u64
    }
}

/// Runs the `intersect` kernel.
pub(super) fn intersect(
    tracer: &Tracer,
    rays: &[RayRecord],
) -> Result<Vec<HitRecord>, RuntimeError> {
    let (device, queue) = (&tracer.device, &tracer.queue);
    let storage = wgpu::BufferUsages::STORAGE;
    let count = u32::try_from(rays.len()).unwrap_or(u32::MAX);
    if count.div_ceil(64) > device.limits().max_compute_workgroups_per_dimension {
        return Err(RuntimeError::Limit(format!("{count} rays in one call")));
    }
    let input = filled_buffer(
        device,
        queue,
        "vtex rays",
        bytemuck::cast_slice(rays),
        storage,
    )?;
    let size = u64::from(count.max(4)) * size_of::<HitRecord>() as u64;
    let usage = storage | wgpu::BufferUsages::COPY_SRC;
    let output = empty_buffer(device, "vtex hits", size, usage)?;
    checked(device, "intersect", || {
        let queries = group(device, &tracer.pipelines.query_layout, &[&input, &output]);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&tracer.pipelines.intersect);
            pass.set_bind_group(0, &tracer.bindings.scene, &[]);
            pass.set_bind_group(1, &queries, &[]);
            pass.dispatch_workgroups(count.div_ceil(64), 1, 1);
        }
        queue.submit([encoder.finish()]);
    })?;
    let bytes = read_buffer(device, queue, &output, size)?;
    let mut hits: Vec<HitRecord> = bytemuck::pod_collect_to_vec(&bytes);
    hits.truncate(rays.len());
    Ok(hits)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(size: [u32; 2], first: u32, count: u32) {
        let mut seen = vec![0_u32; size[1] as usize];
        for pass in Passes::new(size, first, count) {
            assert!(pass.row_count > 0 && pass.sample_count > 0, "idle pass");
            assert!(pass.sample_first >= first, "sample twice");
            for row in pass.row_first..pass.row_first + pass.row_count {
                assert_eq!(pass.sample_first, first + seen[row as usize], "order");
                seen[row as usize] += pass.sample_count;
            }
        }
        assert!(seen.iter().all(|&n| n == count), "{size:?}: {seen:?}");
    }

    #[test]
    fn passes_cover_every_row_and_sample_once_in_order() {
        check([1, 1], 0, 1000);
        check([640, 480], 5, 3);
        check([65_536, 3], 0, 2);
        check([100, 100], 0, 0);
    }
}
