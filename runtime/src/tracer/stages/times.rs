//! Time that the device spends on each stage.

use wgpu::{Buffer, BufferUsages, CommandEncoder, ComputePassTimestampWrites, Device, Queue};

use super::step::Stage;
use crate::RuntimeError;
use crate::device::{empty_buffer, read_back};

/// Dispatches of one submission whose time is taken: a query set of WebGPU holds two stamps of each and
/// no more. A submission with more is one of a scene with see-through surfaces, whose last rounds have
/// hardly any paths.
const MAX_STEPS: u32 = 2048;
const STAMP_BYTES: u64 = 8;

/// What a stage took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageTime {
    /// The stage: `generate`, `hit`, `surface`, `lookups` (all kernels together), `shade`, `shadow`, and
    /// the small ones `arguments`, `advance` and `film`; `render` where all is one kernel.
    pub stage: &'static str,
    /// Nanoseconds on the device.
    pub device_ns: u64,
}

/// Timestamps around every dispatch of a submission.
#[derive(Debug)]
pub(in crate::tracer) struct StageTimer {
    queries: wgpu::QuerySet,
    resolved: Buffer,
    period_ns: f32,
    stages: Vec<Stage>,
    ticks: [u64; Stage::ALL.len()],
}

impl StageTimer {
    /// `None` when the device was made without timestamps. To be called in
    /// [`checked`](crate::device::checked).
    pub(in crate::tracer) fn new(
        device: &Device,
        queue: &Queue,
    ) -> Result<Option<Self>, RuntimeError> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Ok(None);
        }
        let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("vtex stages"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * MAX_STEPS,
        });
        let usage = BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC;
        let size = u64::from(2 * MAX_STEPS) * STAMP_BYTES;
        Ok(Some(Self {
            queries,
            resolved: empty_buffer(device, "vtex stages", size, usage)?,
            period_ns: queue.get_timestamp_period(),
            stages: Vec::new(),
            ticks: [0; Stage::ALL.len()],
        }))
    }

    /// What a pass of `stage` writes.
    pub(super) fn writes(&mut self, stage: Stage) -> Option<ComputePassTimestampWrites<'_>> {
        let first = 2 * self.steps();
        if first >= 2 * MAX_STEPS {
            return None;
        }
        self.stages.push(stage);
        Some(ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    pub(super) fn resolve(&self, encoder: &mut CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..2 * self.steps(), &self.resolved, 0);
    }

    fn steps(&self) -> u32 {
        u32::try_from(self.stages.len()).unwrap_or(MAX_STEPS)
    }

    /// Waits for the submission and adds up its times.
    pub(in crate::tracer) async fn finish(
        &mut self,
        device: &Device,
        queue: &Queue,
    ) -> Result<(), RuntimeError> {
        let size = u64::from(2 * self.steps()) * STAMP_BYTES;
        let bytes = read_back(device, queue, &self.resolved, size).await?;
        let stamps: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes);
        for (pair, stage) in stamps.chunks(2).zip(self.stages.drain(..)) {
            // WebGPU lets a driver reset its clock between the two.
            self.ticks[stage as usize] += pair[1].saturating_sub(pair[0]);
        }
        Ok(())
    }

    /// The sums, in the order of stages.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a time in ns, far below 2^63"
    )]
    pub(in crate::tracer) fn times(&self) -> Vec<StageTime> {
        let time = |(stage, &ticks): (Stage, &u64)| StageTime {
            stage: stage.name(),
            device_ns: (ticks as f64 * f64::from(self.period_ns)) as u64,
        };
        Stage::ALL.into_iter().zip(&self.ticks).map(time).collect()
    }
}
