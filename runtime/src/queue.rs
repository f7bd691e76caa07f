//! Lookups that other work on the GPU asks for.

use vtex_format::SpecKey;
use vtex_shaders::set::{TextureQuery, queue_arguments_kernel, queue_kernel};
use wgpu::{
    BindGroup, BindGroupEntry, BindGroupLayout, Buffer, BufferBinding, BufferUsages,
    CommandEncoder, ComputePipeline, Device,
};

use crate::device::{READ, WRITE, buffers_layout, checked, compiled, empty_buffer, kernel};
use crate::{RuntimeError, TextureSet};

/// Bytes of the arguments of a dispatch.
const ARGUMENTS_BYTES: u64 = 12;
/// Bytes of a query, of the count, and of an answer: no binding may have less.
const LEAST_BYTES: [u64; 3] = [size_of::<TextureQuery>() as u64, 4, 16];

/// Answers queues of lookups in the textures of a [`TextureSet`], whose length the host need not know.
///
/// ```no_run
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # use vtex_runtime::{QueueBuffers, QueueSampler, TextureSet, wgpu};
/// # let (device, set): (wgpu::Device, TextureSet) = unimplemented!();
/// # let (queries, count, colors): (wgpu::Buffer, wgpu::Buffer, wgpu::Buffer) = unimplemented!();
/// let sampler = QueueSampler::new(&device, &set)?;
/// let queue = sampler.queue(&QueueBuffers {
///     queries: queries.as_entire_buffer_binding(), // array<VtexTextureQuery>, 32 bytes each
///     count: count.as_entire_buffer_binding(),     // u32: how many of them to answer
///     colors: colors.as_entire_buffer_binding(),   // array<vec4f>: the answers
/// })?;
/// // In each frame:
/// let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
/// // ... a pass of yours fills the queue and counts ...
/// sampler.record(&mut encoder, &set, &queue)?;
/// # Ok(()) }
/// ```
#[derive(Clone, Debug)]
pub struct QueueSampler {
    device: Device,
    key: SpecKey,
    arguments: ComputePipeline,
    lookups: ComputePipeline,
    queue_layout: BindGroupLayout,
    arguments_layout: BindGroupLayout,
}

/// What a queue consists of: three storage buffers, or parts of them.
#[derive(Clone, Debug)]
pub struct QueueBuffers<'a> {
    /// [`TextureQuery`](crate::TextureQuery)s, 32 bytes each.
    pub queries: BufferBinding<'a>,
    /// A `u32`, the number of queries. Where it is greater than there is room for queries or answers, those
    /// that fit are answered.
    pub count: BufferBinding<'a>,
    /// The answer of each query, four floats: linear light, premultiplied. Those from the count on are left
    /// as they are.
    pub colors: BufferBinding<'a>,
}

/// A queue whose buffers are bound. It stays valid whatever happens to a set.
#[derive(Clone, Debug)]
pub struct LookupQueue {
    group: BindGroup,
    arguments: Buffer,
    arguments_group: BindGroup,
}

impl QueueSampler {
    /// Compiles the kernels for the textures of a set, and of every set with the same
    /// [`TextureSet::key`] or one whose features are among those.
    ///
    /// # Errors
    /// [`RuntimeError::Shader`] when the device refuses a kernel, which is a defect.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn new(device: &Device, set: &TextureSet) -> Result<Self, RuntimeError> {
        crate::device::block_on(device, Self::new_async(device, set))
    }

    /// As `QueueSampler::new`, for callers that must not block.
    ///
    /// # Errors
    /// [`RuntimeError::Shader`] when the device refuses a kernel, which is a defect.
    pub async fn new_async(device: &Device, set: &TextureSet) -> Result<Self, RuntimeError> {
        let key = *set.key();
        compiled(device, "queue kernels", || {
            let queue_layout = buffers_layout(device, "vtex queue", &[READ, READ, WRITE]);
            let arguments_layout = buffers_layout(device, "vtex queue arguments", &[WRITE]);
            let pipeline = |text: String, entry: &str, second: &BindGroupLayout| {
                let source = wgpu::ShaderSource::Wgsl(text.into());
                kernel(device, entry, source, entry, &[&queue_layout, second])
            };
            Ok(Self {
                arguments: pipeline(
                    queue_arguments_kernel(),
                    "vtex_queue_arguments",
                    &arguments_layout,
                ),
                lookups: pipeline(
                    queue_kernel(key.features),
                    "vtex_queue",
                    set.bind_group_layout(),
                ),
                device: device.clone(),
                key,
                queue_layout,
                arguments_layout,
            })
        })
        .await
    }

    /// The key of the set that it was compiled for.
    pub fn key(&self) -> &SpecKey {
        &self.key
    }

    /// Binds a queue, once for all frames.
    ///
    /// # Errors
    /// [`RuntimeError::Parameter`] when a buffer has no room for one query, count or answer;
    /// [`RuntimeError::Device`] when it lacks the usage `STORAGE`, or is no storage binding of this device
    /// for its size or offset.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn queue(&self, buffers: &QueueBuffers<'_>) -> Result<LookupQueue, RuntimeError> {
        crate::device::block_on(&self.device, self.queue_async(buffers))
    }

    /// As `QueueSampler::queue`, for callers that must not block.
    ///
    /// # Errors
    /// [`RuntimeError::Parameter`] when a buffer has no room for one query, count or answer;
    /// [`RuntimeError::Device`] when it lacks the usage `STORAGE`, or is no storage binding of this device
    /// for its size or offset.
    pub async fn queue_async(
        &self,
        buffers: &QueueBuffers<'_>,
    ) -> Result<LookupQueue, RuntimeError> {
        let bound = [&buffers.queries, &buffers.count, &buffers.colors];
        for (binding, least) in bound.into_iter().zip(LEAST_BYTES) {
            let rest = binding.buffer.size().saturating_sub(binding.offset);
            let size = binding.size.map_or(rest, u64::from);
            if size < least {
                return Err(RuntimeError::Parameter(format!(
                    "a queue's buffer of {size} bytes, and one element takes {least}"
                )));
            }
        }
        checked(&self.device, "queue", || {
            let usage = BufferUsages::STORAGE | BufferUsages::INDIRECT;
            let label = "vtex queue arguments";
            let arguments = empty_buffer(&self.device, label, ARGUMENTS_BYTES, usage)?;
            let whole = arguments.as_entire_buffer_binding();
            Ok(LookupQueue {
                group: self.bind(&self.queue_layout, &bound),
                arguments_group: self.bind(&self.arguments_layout, &[&whole]),
                arguments,
            })
        })
        .await
    }

    fn bind(&self, layout: &BindGroupLayout, buffers: &[&BufferBinding<'_>]) -> BindGroup {
        let entries: Vec<BindGroupEntry<'_>> = (0..)
            .zip(buffers)
            .map(|(binding, &buffer)| BindGroupEntry {
                binding,
                resource: wgpu::BindingResource::Buffer(buffer.clone()),
            })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("vtex queue"),
            layout,
            entries: &entries,
        })
    }

    /// Records the lookups of a queue: as many as its count says when the device comes to them. Nothing is
    /// read back, and nothing is waited for.
    ///
    /// # Errors
    /// [`RuntimeError::Parameter`] when the set has features that this was not compiled for: since then
    /// textures were added that need more, so make it anew.
    pub fn record(
        &self,
        encoder: &mut CommandEncoder,
        set: &TextureSet,
        queue: &LookupQueue,
    ) -> Result<(), RuntimeError> {
        if set.key().features & !self.key.features != 0 {
            return Err(RuntimeError::Parameter(
                "the set has textures that need more code than this queue sampler has: make it anew"
                    .to_owned(),
            ));
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("vtex queue"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.arguments);
        pass.set_bind_group(0, &queue.group, &[]);
        pass.set_bind_group(1, &queue.arguments_group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
        pass.set_pipeline(&self.lookups);
        pass.set_bind_group(1, set.bind_group(), &[]);
        pass.dispatch_workgroups_indirect(&queue.arguments, 0);
        Ok(())
    }
}
