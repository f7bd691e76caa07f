//! Kernels that share a scene: the path tracer in one, and the query of single rays.

use vtex_shaders::{BindingSlot, LinkContext};
use wgpu::{
    BindGroup, BindGroupEntry, BindGroupLayout, BindGroupLayoutEntry, Buffer, BufferBindingType,
    CommandEncoder, ComputePassDescriptor, ComputePassTimestampWrites, ComputePipeline, Device,
    ShaderStages,
};

use crate::RuntimeError;
use crate::device::{READ, Uploaded, WRITE, buffer_entry, buffers_layout, compiled, kernel};

use super::lights::PanoramaTexture;
use super::records::PassRecord;
use super::upload::SceneBuffers;

const UNIFORM: BufferBindingType = BufferBindingType::Uniform;

/// Bindings of `shaders/wgsl/trace/bindings.wgsl`, in order; behind them the panorama and its sampler.
const SCENE_BINDINGS: [BufferBindingType; 6] = [UNIFORM, UNIFORM, READ, READ, READ, READ];
const PANORAMA: u32 = 6;
/// Those that traversal reads: frame, pass, nodes, triangles.
pub(super) const TRAVERSAL: &[u32] = &[0, 1, 2, 3];
/// Those that shading reads: all of them, since records of instances and of lights lie among the nodes.
pub(super) const SHADING: &[u32] = &[0, 1, 2, 3, 4, 5, 6, 7];

const FILM_GROUP: &[BufferBindingType] = &[WRITE, WRITE];
const QUERY_GROUP: &[BufferBindingType] = &[READ, WRITE];

const TEXTURE_SLOT: BindingSlot = BindingSlot {
    group: 1,
    binding: 0,
};

/// What kernels of paths work on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inputs<'a> {
    pub(super) scene: &'a SceneBuffers,
    pub(super) pass: &'a Buffer,
    pub(super) film: [&'a Buffer; 2],
    pub(super) size: [u32; 2],
    pub(super) max_bounces: u32,
}

/// Group 0: the scene, or the part of it that a kernel reads.
#[derive(Debug)]
pub(super) struct SceneGroup {
    pub(super) layout: BindGroupLayout,
    pub(super) group: BindGroup,
}

/// A layout of buffers, and the buffers.
#[derive(Debug)]
pub(super) struct BufferGroup {
    pub(super) layout: BindGroupLayout,
    pub(super) group: BindGroup,
}

/// The whole path tracer in one kernel.
#[derive(Debug)]
pub(super) struct SingleKernel {
    render: ComputePipeline,
    groups: [BindGroup; 3],
    width: u32,
}

/// The compiled ray query of `shaders/wgsl/root/intersect.wgsl`.
#[derive(Debug)]
pub(super) struct QueryPipeline {
    pub(super) intersect: ComputePipeline,
    pub(super) query_layout: BindGroupLayout,
}

impl SceneGroup {
    /// Core WebGPU guarantees eight storage buffers a stage, and what a layout names counts whether a
    /// kernel reads it or not: so `numbers` names what it reads.
    pub(super) fn new(
        device: &Device,
        scene: &SceneBuffers,
        pass: &Buffer,
        numbers: &[u32],
    ) -> Self {
        let resources = scene.bindings(pass);
        let panorama = PanoramaTexture::layout_entries(PANORAMA);
        let layout: Vec<BindGroupLayoutEntry> = numbers
            .iter()
            .map(|&number| match number.checked_sub(PANORAMA) {
                Some(of_panorama) => panorama[of_panorama as usize],
                None => buffer_entry(number, SCENE_BINDINGS[number as usize]),
            })
            .collect();
        let layout = layout_of(device, "vtex scene", &layout);
        let entries: Vec<BindGroupEntry<'_>> = numbers
            .iter()
            .map(|&binding| BindGroupEntry {
                binding,
                resource: resources[binding as usize].clone(),
            })
            .collect();
        Self {
            group: group_of(device, &layout, &entries),
            layout,
        }
    }
}

impl BufferGroup {
    pub(super) fn new(
        device: &Device,
        label: &str,
        types: &[BufferBindingType],
        buffers: &[&Buffer],
    ) -> Self {
        let layout = buffers_layout(device, label, types);
        Self {
            group: group(device, &layout, buffers),
            layout,
        }
    }

    /// The sums of samples and the counts of rays.
    pub(super) fn film(device: &Device, film: [&Buffer; 2]) -> Self {
        Self::new(device, "vtex film", FILM_GROUP, &film)
    }
}

impl SingleKernel {
    pub(super) async fn new(device: &Device, inputs: Inputs<'_>) -> Result<Self, RuntimeError> {
        let scene = inputs.scene;
        let context = vtex_shaders::scene_context(scene.texture_features(), TEXTURE_SLOT);
        let context = scene.code(context);
        let wgsl = linked("root/render", &context)?;
        compiled(device, "path tracer", || {
            let scene_group = SceneGroup::new(device, scene, inputs.pass, SHADING);
            let film = BufferGroup::film(device, inputs.film);
            let entries = Uploaded::layout_entries(TEXTURE_SLOT.binding, ShaderStages::COMPUTE);
            let texture_layout = layout_of(device, "vtex textures", &entries);
            let texture_entries = scene.textures().entries(TEXTURE_SLOT.binding);
            let textures = group_of(device, &texture_layout, &texture_entries);
            let layouts = [&scene_group.layout, &texture_layout, &film.layout];
            Ok(Self {
                render: pipeline(device, &wgsl, "render", &layouts),
                groups: [scene_group.group, textures, film.group],
                width: inputs.size[0],
            })
        })
        .await
    }

    pub(super) fn record(
        &self,
        encoder: &mut CommandEncoder,
        record: &PassRecord,
        timestamps: Option<ComputePassTimestampWrites<'_>>,
    ) {
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some("vtex render"),
            timestamp_writes: timestamps,
        });
        pass.set_pipeline(&self.render);
        for (number, group) in (0..).zip(&self.groups) {
            pass.set_bind_group(number, group, &[]);
        }
        // Workgroups of 8 by 8, see `root/render.wgsl`, which drops what lies outside.
        pass.dispatch_workgroups(self.width.div_ceil(8), record.row_count.div_ceil(8), 1);
    }
}

impl QueryPipeline {
    pub(super) async fn new(
        device: &Device,
        scene_layout: &BindGroupLayout,
        scene: &SceneBuffers,
    ) -> Result<Self, RuntimeError> {
        // It reads triangles alone, so no evaluator of textures is linked.
        // And it meets surfaces wherever they are.
        let context = vtex_shaders::without_cutouts(scene.code(LinkContext::default()));
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

pub(super) fn group_of(
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

pub(super) fn pipeline(
    device: &Device,
    wgsl: &str,
    entry_point: &str,
    groups: &[&BindGroupLayout],
) -> ComputePipeline {
    let source = wgpu::ShaderSource::Wgsl(wgsl.into());
    kernel(device, "vtex tracer", source, entry_point, groups)
}

pub(super) fn linked(root: &str, context: &LinkContext) -> Result<String, RuntimeError> {
    vtex_shaders::link(root, context).map_err(|error| RuntimeError::Shader(error.to_string()))
}
