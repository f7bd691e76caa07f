//! Shader, layouts and bind groups of the tracer.

use vtex_shaders::{BindingSlot, LinkContext};
use wgpu::{
    BindGroup, BindGroupEntry, BindGroupLayout, BindGroupLayoutEntry, Buffer, BufferBindingType,
    ComputePipeline, Device, ShaderStages,
};

use crate::RuntimeError;
use crate::device::{READ, Uploaded, WRITE, buffers_layout, compiled, kernel};

use super::upload::SceneBuffers;

const UNIFORM: BufferBindingType = BufferBindingType::Uniform;

// Core WebGPU guarantees eight storage buffers a stage. `render` uses seven, so all textures of a
// scene lie in one.
/// Bindings of `shaders/wgsl/root/render.wgsl` and `root/intersect.wgsl`, group by group, in order.
const SCENE_GROUP: &[BufferBindingType] = &[UNIFORM, UNIFORM, READ, READ, READ, READ];
const FILM_GROUP: &[BufferBindingType] = &[WRITE, WRITE];
const QUERY_GROUP: &[BufferBindingType] = &[READ, WRITE];

const TEXTURE_SLOT: BindingSlot = BindingSlot {
    group: 2,
    binding: 0,
};

/// The compiled path tracer and the layouts of its groups.
#[derive(Debug)]
pub(super) struct Pipelines {
    pub(super) render: ComputePipeline,
    pub(super) scene_layout: BindGroupLayout,
    pub(super) film_layout: BindGroupLayout,
    pub(super) texture_layout: BindGroupLayout,
}

/// The compiled ray query of `shaders/wgsl/root/intersect.wgsl`.
#[derive(Debug)]
pub(super) struct QueryPipeline {
    pub(super) intersect: ComputePipeline,
    pub(super) query_layout: BindGroupLayout,
}

/// What `render` reads and writes.
#[derive(Debug)]
pub(super) struct Bindings {
    pub(super) scene: BindGroup,
    pub(super) film: BindGroup,
    pub(super) textures: BindGroup,
}

impl Pipelines {
    pub(super) async fn new(device: &Device, scene: &SceneBuffers) -> Result<Self, RuntimeError> {
        let context = vtex_shaders::scene_context(scene.texture_features(), TEXTURE_SLOT);
        let context = scene.world().levels(context);
        let wgsl = linked("root/render", &context)?;
        compiled(device, "path tracer", || {
            let scene_layout = buffers_layout(device, "vtex scene", SCENE_GROUP);
            let film_layout = buffers_layout(device, "vtex film", FILM_GROUP);
            let entries = Uploaded::layout_entries(TEXTURE_SLOT.binding, ShaderStages::COMPUTE);
            let texture_layout = layout_of(device, "vtex textures", &entries);
            let groups = [&scene_layout, &film_layout, &texture_layout];
            Ok(Self {
                render: pipeline(device, &wgsl, "render", &groups),
                scene_layout,
                film_layout,
                texture_layout,
            })
        })
        .await
    }
}

impl QueryPipeline {
    /// Its group 0 is the path tracer's.
    pub(super) async fn new(
        device: &Device,
        scene_layout: &BindGroupLayout,
        scene: &SceneBuffers,
    ) -> Result<Self, RuntimeError> {
        // It reads triangles alone, so no evaluator of textures is linked.
        let context = scene.world().levels(LinkContext::default());
        let wgsl = linked("root/intersect", &context)?;
        compiled(device, "ray query", || {
            let query_layout = buffers_layout(device, "vtex queries", QUERY_GROUP);
            let groups = [scene_layout, &query_layout];
            Ok(Self {
                intersect: pipeline(device, &wgsl, "intersect", &groups),
                query_layout,
            })
        })
        .await
    }
}

impl Bindings {
    /// To be called in [`checked`](crate::device::checked).
    pub(super) fn new(
        device: &Device,
        pipelines: &Pipelines,
        scene: &SceneBuffers,
        pass: &Buffer,
        film_sum: &Buffer,
        film_rays: &Buffer,
    ) -> Self {
        Self {
            scene: group(device, &pipelines.scene_layout, &scene.bindings(pass)),
            film: group(device, &pipelines.film_layout, &[film_sum, film_rays]),
            textures: group_of(
                device,
                &pipelines.texture_layout,
                &scene.textures().entries(TEXTURE_SLOT.binding),
            ),
        }
    }
}

fn layout_of(device: &Device, label: &str, entries: &[BindGroupLayoutEntry]) -> BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries,
    })
}

/// Binds whole buffers, numbered from 0.
pub(super) fn group(device: &Device, layout: &BindGroupLayout, buffers: &[&Buffer]) -> BindGroup {
    let entries: Vec<BindGroupEntry<'_>> = (0..)
        .zip(buffers)
        .map(|(binding, buffer)| BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    group_of(device, layout, &entries)
}

fn group_of(
    device: &Device,
    layout: &BindGroupLayout,
    entries: &[BindGroupEntry<'_>],
) -> BindGroup {
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("vtex tracer"),
        layout,
        entries,
    })
}

fn pipeline(
    device: &Device,
    wgsl: &str,
    entry_point: &str,
    groups: &[&BindGroupLayout],
) -> ComputePipeline {
    let source = wgpu::ShaderSource::Wgsl(wgsl.into());
    kernel(device, "vtex tracer", source, entry_point, groups)
}

fn linked(root: &str, context: &LinkContext) -> Result<String, RuntimeError> {
    vtex_shaders::link(root, context).map_err(|error| RuntimeError::Shader(error.to_string()))
}
