//! The kernels that answer queues of lookups.

use std::num::NonZeroU64;

use vtex_shaders::{BindingSlot, scene_context};
use wgpu::{BindGroup, BindingResource, Buffer, BufferBinding, ComputePipeline, Device};

use super::super::pipeline::{group_of, linked};
use super::super::queues::{StoredKernel, TextureQueue};
use super::super::upload::SceneBuffers;
use super::{COLOR_BYTES, QUERY_BYTES};
use crate::RuntimeError;
use crate::batch::{batch_pipeline, stored_kernel};
use crate::device::compiled;

/// Where the batch kernel binds its texture.
const TEXTURE_SLOT: BindingSlot = BindingSlot {
    group: 0,
    binding: 0,
};
const WORD_BYTES: u64 = 4;

/// A queue's kernel.
#[derive(Debug)]
pub(super) struct LookupKernel {
    pub(super) pipeline: ComputePipeline,
    /// The texture that it evaluates, where the file's own kernel does; it knows no other.
    texture: Option<usize>,
}

/// Compiles the kernel of each queue; queues with equal SPIR-V share one.
pub(super) async fn compile(
    device: &Device,
    queues: &[TextureQueue],
    notices: &mut Vec<String>,
) -> Result<Vec<LookupKernel>, RuntimeError> {
    let mut kernels: Vec<LookupKernel> = Vec::with_capacity(queues.len());
    for queue in queues {
        let stored = match &queue.stored {
            Some(stored) => stored_pipeline(device, stored, &kernels, queues, notices).await,
            None => None,
        };
        kernels.push(match stored {
            Some((pipeline, texture)) => LookupKernel {
                pipeline,
                texture: Some(texture),
            },
            None => LookupKernel {
                pipeline: text_pipeline(device, queue.features).await?,
                texture: None,
            },
        });
    }
    Ok(kernels)
}

async fn stored_pipeline(
    device: &Device,
    stored: &StoredKernel,
    made: &[LookupKernel],
    queues: &[TextureQueue],
    notices: &mut Vec<String>,
) -> Option<(ComputePipeline, usize)> {
    let same = made.iter().zip(queues).find(|(kernel, queue)| {
        let other = queue.stored.as_ref();
        kernel.texture.is_some() && other.is_some_and(|other| other.spirv == stored.spirv)
    });
    if let Some((kernel, _)) = same {
        return Some((kernel.pipeline.clone(), stored.texture));
    }
    let mut told = Vec::new();
    let pipeline = stored_kernel(device, &stored.spirv, &mut told).await;
    let named = told
        .iter()
        .map(|text| format!("texture {}: {text}", stored.texture));
    notices.extend(named);
    pipeline.map(|pipeline| (pipeline, stored.texture))
}

async fn text_pipeline(device: &Device, features: u32) -> Result<ComputePipeline, RuntimeError> {
    let context = scene_context(features, TEXTURE_SLOT).fill("root/answer", "stage/answer");
    let text = linked("root/batch", &context)?;
    compiled(device, "lookup kernel", || {
        Ok(batch_pipeline(
            device,
            wgpu::ShaderSource::Wgsl(text.into()),
        ))
    })
    .await
}

/// Binds the part of both buffers that queue `index` has.
pub(super) fn bind(
    device: &Device,
    kernel: &LookupKernel,
    scene: &SceneBuffers,
    [queries, colors]: [&Buffer; 2],
    index: u64,
    paths: u64,
) -> BindGroup {
    let part = |buffer, size: u64| {
        BindingResource::Buffer(BufferBinding {
            buffer,
            offset: index * paths * size,
            size: NonZeroU64::new(paths * size),
        })
    };
    let [mut words, texels, sampler] = scene.textures().entries(TEXTURE_SLOT.binding);
    if let Some([first, count]) = kernel.texture.and_then(|texture| scene.texture(texture)) {
        words.resource = BindingResource::Buffer(BufferBinding {
            buffer: &scene.textures().words,
            offset: u64::from(first) * WORD_BYTES,
            size: NonZeroU64::new(u64::from(count) * WORD_BYTES),
        });
    }
    let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
    let entries = [
        words,
        texels,
        sampler,
        entry(3, part(queries, QUERY_BYTES)),
        entry(4, part(colors, COLOR_BYTES)),
    ];
    group_of(device, &kernel.pipeline.get_bind_group_layout(0), &entries)
}
