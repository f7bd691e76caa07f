//! Lookups that other work on the GPU asks for.

use vtex_format::SpecKey;
use vtex_shaders::set::{
    MAX_POOLS, QUEUE_TALLIES, QueuePart, TextureQuery, queue_arguments_kernel, queue_kernel,
    queue_order_kernels, queue_pool_kernel,
};
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
/// Which of them is the count.
const COUNT: usize = 1;

/// Bytes of a query's place in the order of pools.
const PLACE_BYTES: u64 = 4;

/// Answers queues of lookups in the textures of a [`TextureSet`], whose length the host need not know.
///
/// Where the set may have several pools, a queue's handles may be of all of them, mixed in any way: the
/// device puts the queries in the order of pools first, which takes 4 bytes for each that there is room for.
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
    /// What orders a queue by pools, where the set may have several.
    order: Option<Ordering>,
    queue_layout: BindGroupLayout,
    arguments_layout: BindGroupLayout,
}

/// Kernels that put a queue in the order of its pools, in the order in which they run.
#[derive(Clone, Debug)]
struct Ordering {
    tally: ComputePipeline,
    divide: ComputePipeline,
    sort: ComputePipeline,
    layout: BindGroupLayout,
    /// Of what the lookups read.
    ordered_layout: BindGroupLayout,
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
    order: Option<Order>,
}

/// A queue in the order of its pools.
#[derive(Clone, Debug)]
struct Order {
    /// What the kernels count with.
    tallies: Buffer,
    /// Of each pool its arguments, and which part of the order is its own.
    parts: Buffer,
    group: BindGroup,
    ordered_group: BindGroup,
}

impl QueueSampler {
    /// Compiles the kernels for the textures of a set, and of every set with the same
    /// [`TextureSet::key`] or one whose features are among those; where the set may have one pool only, of
    /// every such set that has one.
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
            let order = (set.max_pools() > 1).then(|| Ordering::new(device, &queue_layout));
            let pipeline = |text: String, entry: &str, others: &[&BindGroupLayout]| {
                let source = wgpu::ShaderSource::Wgsl(text.into());
                kernel(
                    device,
                    entry,
                    source,
                    entry,
                    &[&[&queue_layout], others].concat(),
                )
            };
            let textures = set.bind_group_layout();
            Ok(Self {
                arguments: pipeline(
                    queue_arguments_kernel(),
                    "vtex_queue_arguments",
                    &[&arguments_layout],
                ),
                lookups: match &order {
                    None => pipeline(queue_kernel(key.features), "vtex_queue", &[textures]),
                    Some(order) => pipeline(
                        queue_pool_kernel(key.features),
                        "vtex_queue_pool",
                        &[textures, &order.ordered_layout],
                    ),
                },
                device: device.clone(),
                key,
                order,
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
        let mut room = u64::MAX;
        for (index, (binding, least)) in bound.into_iter().zip(LEAST_BYTES).enumerate() {
            let rest = binding.buffer.size().saturating_sub(binding.offset);
            let size = binding.size.map_or(rest, u64::from);
            if index != COUNT {
                room = room.min(size / least);
            }
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
                order: match &self.order {
                    Some(ordering) => Some(self.order(ordering, room)?),
                    None => None,
                },
            })
        })
        .await
    }

    /// Room to put so many queries in order.
    fn order(&self, ordering: &Ordering, room: u64) -> Result<Order, RuntimeError> {
        let buffer = |size, usage| {
            let usage = BufferUsages::STORAGE | usage;
            empty_buffer(&self.device, "vtex queue order", size, usage)
        };
        let part = size_of::<QueuePart>() as u64;
        let tallies = buffer(4 * u64::from(QUEUE_TALLIES), BufferUsages::COPY_DST)?;
        let parts = buffer(part * u64::from(MAX_POOLS), BufferUsages::INDIRECT)?;
        let places = buffer(PLACE_BYTES * room, BufferUsages::empty())?;
        let bound = [&tallies, &parts, &places].map(Buffer::as_entire_buffer_binding);
        let [all, ordered] =
            [&bound[..], &bound[1..]].map(|bound| bound.iter().collect::<Vec<_>>());
        Ok(Order {
            group: self.bind(&ordering.layout, &all),
            ordered_group: self.bind(&ordering.ordered_layout, &ordered),
            tallies,
            parts,
        })
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
    /// read back, and nothing is waited for. A queue is in one recording at a time.
    ///
    /// # Errors
    /// [`RuntimeError::Parameter`] when the set has features that this was not compiled for: since then
    /// textures were added that need more, so make it anew. The same when the set has several pools, and
    /// this or the queue was made for a set that may have one.
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
        if self.order.is_some() != queue.order.is_some() {
            return Err(RuntimeError::Parameter(
                "of this queue sampler and this queue one is for a set that may have several pools, the \
                 other for one that may not: make the queue by this sampler"
                    .to_owned(),
            ));
        }
        if self.order.is_none() && set.pools().len() > 1 {
            return Err(RuntimeError::Parameter(
                "the set has several pools, and this queue sampler was made for one that may not: make it \
                 by this set"
                    .to_owned(),
            ));
        }
        if let Some(order) = &queue.order {
            encoder.clear_buffer(&order.tallies, 0, None);
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("vtex queue"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.arguments);
        pass.set_bind_group(0, &queue.group, &[]);
        pass.set_bind_group(1, &queue.arguments_group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
        if let (Some(ordering), Some(order)) = (&self.order, &queue.order) {
            let pools = u32::try_from(set.pools().len()).unwrap_or(MAX_POOLS);
            pass.set_bind_group(1, &order.group, &[]);
            pass.set_pipeline(&ordering.tally);
            pass.dispatch_workgroups_indirect(&queue.arguments, 0);
            pass.set_pipeline(&ordering.divide);
            pass.dispatch_workgroups(pools, 1, 1);
            pass.set_pipeline(&ordering.sort);
            pass.dispatch_workgroups_indirect(&queue.arguments, 0);
            pass.set_pipeline(&self.lookups);
            pass.set_bind_group(2, &order.ordered_group, &[]);
            for (part, pool) in (0..).zip(set.pools()) {
                pass.set_bind_group(1, pool.bind_group, &[]);
                let offset = part * size_of::<QueuePart>() as u64;
                pass.dispatch_workgroups_indirect(&order.parts, offset);
            }
        } else {
            pass.set_pipeline(&self.lookups);
            pass.set_bind_group(1, set.bind_group(), &[]);
            pass.dispatch_workgroups_indirect(&queue.arguments, 0);
        }
        Ok(())
    }
}

impl Ordering {
    fn new(device: &Device, queue: &BindGroupLayout) -> Self {
        let layout = buffers_layout(device, "vtex queue order", &[WRITE, WRITE, WRITE]);
        let text = queue_order_kernels();
        let pipeline = |entry: &str| {
            let source = wgpu::ShaderSource::Wgsl(text.as_str().into());
            kernel(device, entry, source, entry, &[queue, &layout])
        };
        Self {
            tally: pipeline("vtex_queue_tally"),
            divide: pipeline("vtex_queue_divide"),
            sort: pipeline("vtex_queue_sort"),
            ordered_layout: buffers_layout(device, "vtex queue in order", &[READ, READ]),
            layout,
        }
    }
}
