//! Time that the device spends on each submission.

use wgpu::{Buffer, CommandEncoder, Device, Queue};

use super::passes::MAX_IN_FLIGHT;
use crate::RuntimeError;
use crate::device::{empty_buffer, read_back};

/// Where a submission's two timestamps lie, in words: resolve offsets are multiples of 256 bytes.
const STAMP_STRIDE: usize = 32;
const STAMP_STRIDE_BYTES: u64 = 8 * STAMP_STRIDE as u64;

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
    /// `None` when the device was made without timestamps. To be called in
    /// [`checked`](crate::device::checked).
    pub(super) fn new(device: &Device, queue: &Queue) -> Result<Option<Self>, RuntimeError> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Ok(None);
        }
        // One pair for all submissions: each copies its stamps away before the next writes them.
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

    /// Forgets what was resolved and not yet added up.
    pub(super) fn discard(&mut self) {
        self.pending = 0;
    }

    /// Waits for what was resolved since and adds up its times; at most [`MAX_IN_FLIGHT`] passes.
    pub(super) async fn finish(
        &mut self,
        device: &Device,
        queue: &Queue,
    ) -> Result<(), RuntimeError> {
        if self.pending == 0 {
            return Ok(());
        }
        let bytes = read_back(device, queue, &self.resolved, self.resolved.size()).await?;
        let stamps: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes);
        let spent = stamps
            .chunks(STAMP_STRIDE)
            .take(self.pending as usize)
            // WebGPU lets a driver reset its clock between the two.
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
