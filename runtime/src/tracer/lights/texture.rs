//! The panorama on the device.

use wgpu::{
    AddressMode, BindGroupLayoutEntry, BindingResource, BindingType, Device, Extent3d, FilterMode,
    Queue, Sampler, SamplerBindingType, SamplerDescriptor, ShaderStages, TexelCopyBufferLayout,
    TextureDescriptor, TextureDimension, TextureFormat, TextureSampleType, TextureUsages,
    TextureView, TextureViewDescriptor, TextureViewDimension,
};

/// A texture and its sampler; of scenes without a panorama one texel that nobody reads.
#[derive(Debug)]
pub(in crate::tracer) struct PanoramaTexture {
    view: TextureView,
    sampler: Sampler,
}

impl PanoramaTexture {
    /// RGB9E5 row by row, each side at most 8192. To be called in [`checked`](crate::device::checked).
    pub(in crate::tracer) fn new(
        device: &Device,
        queue: &Queue,
        [width, height]: [u32; 2],
        texels: &[u32],
    ) -> Self {
        let size = Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        };
        let texture = device.create_texture(&TextureDescriptor {
            label: Some("vtex panorama"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: TextureFormat::Rgb9e5Ufloat,
            usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let rows = TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * width),
            rows_per_image: None,
        };
        let bytes = bytemuck::cast_slice(texels);
        queue.write_texture(texture.as_image_copy(), bytes, rows, size);
        Self {
            view: texture.create_view(&TextureViewDescriptor::default()),
            sampler: device.create_sampler(&SamplerDescriptor {
                label: Some("vtex panorama"),
                address_mode_u: AddressMode::Repeat,
                address_mode_v: AddressMode::ClampToEdge,
                mag_filter: FilterMode::Linear,
                min_filter: FilterMode::Linear,
                ..SamplerDescriptor::default()
            }),
        }
    }

    pub(in crate::tracer) fn resources(&self) -> [BindingResource<'_>; 2] {
        [
            BindingResource::TextureView(&self.view),
            BindingResource::Sampler(&self.sampler),
        ]
    }

    /// Entries of a layout, the first at `binding`.
    pub(in crate::tracer) fn layout_entries(binding: u32) -> [BindGroupLayoutEntry; 2] {
        let entry = |binding, ty| BindGroupLayoutEntry {
            binding,
            visibility: ShaderStages::COMPUTE,
            ty,
            count: None,
        };
        let texture = BindingType::Texture {
            sample_type: TextureSampleType::Float { filterable: true },
            view_dimension: TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = BindingType::Sampler(SamplerBindingType::Filtering);
        [entry(binding, texture), entry(binding + 1, sampler)]
    }
}
