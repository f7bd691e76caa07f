//! Compute kernels, and the bindings that they ask for.

use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType,
    BufferBindingType, ComputePipeline, ComputePipelineDescriptor, Device,
    PipelineCompilationOptions, PipelineLayoutDescriptor, ShaderModuleDescriptor, ShaderSource,
    ShaderStages,
};

/// A storage buffer that a kernel reads.
pub(crate) const READ: BufferBindingType = BufferBindingType::Storage { read_only: true };
/// A storage buffer that a kernel writes.
pub(crate) const WRITE: BufferBindingType = BufferBindingType::Storage { read_only: false };

/// A buffer that kernels bind.
pub(crate) fn buffer_entry(binding: u32, ty: BufferBindingType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::COMPUTE,
        ty: BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            // The sizes are in the shader already; wgpu compares at each dispatch.
            min_binding_size: None,
        },
        count: None,
    }
}

/// A layout of buffers numbered from 0.
pub(crate) fn buffers_layout(
    device: &Device,
    label: &str,
    types: &[BufferBindingType],
) -> BindGroupLayout {
    let entries: Vec<BindGroupLayoutEntry> = (0..)
        .zip(types)
        .map(|(binding, &ty)| buffer_entry(binding, ty))
        .collect();
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &entries,
    })
}

/// Compiles a kernel whose groups have these layouts.
pub(crate) fn kernel(
    device: &Device,
    label: &str,
    source: ShaderSource<'_>,
    entry_point: &str,
    groups: &[&BindGroupLayout],
) -> ComputePipeline {
    let module = device.create_shader_module(ShaderModuleDescriptor {
        label: Some(label),
        source,
    });
    let groups: Vec<Option<&BindGroupLayout>> = groups.iter().copied().map(Some).collect();
    let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        module: &module,
        entry_point: Some(entry_point),
        compilation_options: PipelineCompilationOptions::default(),
        cache: None,
    })
}
