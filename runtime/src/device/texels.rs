//! A packed texture's bindings: words, texels, sampler.

use vtex_shaders::TexelPages;
use wgpu::{
    AddressMode, BindGroupEntry, BindGroupLayoutEntry, BindingResource, BindingType, Buffer,
    BufferBindingType, BufferUsages, Device, FilterMode, Queue, Sampler, SamplerBindingType,
    SamplerDescriptor, ShaderStages, Texture, TextureFormat, TextureSampleType, TextureUsages,
    TextureView, TextureViewDescriptor, TextureViewDimension,
};

use super::buffer::filled_buffer;
use crate::RuntimeError;

/// What the evaluator binds at three successive bindings: one packed texture, or several.
#[derive(Clone, Debug)]
pub(crate) struct Uploaded {
    pub(crate) words: Buffer,
    pub(crate) texels: TextureView,
    pub(crate) sampler: Sampler,
}

impl Uploaded {
    /// To be called in [`checked`](super::checked).
    ///
    /// # Errors
    /// [`RuntimeError::Limit`] when the words do not fit one binding of the device, or the texels one of
    /// its textures.
    pub(crate) fn new(
        device: &Device,
        queue: &Queue,
        words: &[u32],
        texels: &TexelPages,
    ) -> Result<Self, RuntimeError> {
        let bytes = bytemuck::cast_slice(words);
        Ok(Self {
            words: filled_buffer(device, queue, "vtex words", bytes, BufferUsages::STORAGE)?,
            texels: texel_pages(device, queue, texels)?,
            sampler: texel_sampler(device),
        })
    }

    /// Whether all three are the same as another's.
    pub(crate) fn binds_the_same(&self, other: &Self) -> bool {
        self.words == other.words && self.texels == other.texels && self.sampler == other.sampler
    }

    /// Its entries in a bind group, the first at `binding`.
    pub(crate) fn entries(&self, binding: u32) -> [BindGroupEntry<'_>; 3] {
        let entry = |offset, resource| BindGroupEntry {
            binding: binding + offset,
            resource,
        };
        [
            entry(0, self.words.as_entire_binding()),
            entry(1, BindingResource::TextureView(&self.texels)),
            entry(2, BindingResource::Sampler(&self.sampler)),
        ]
    }

    /// Entries of the layout of such a group.
    pub(crate) fn layout_entries(
        binding: u32,
        visibility: ShaderStages,
    ) -> [BindGroupLayoutEntry; 3] {
        let words = BindingType::Buffer {
            ty: BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            // wgpu compares at each draw instead: the shader may be the caller's.
            min_binding_size: None,
        };
        let texels = BindingType::Texture {
            sample_type: TextureSampleType::Float { filterable: true },
            view_dimension: TextureViewDimension::D2Array,
            multisampled: false,
        };
        let sampler = BindingType::Sampler(SamplerBindingType::Filtering);
        let entry = |offset, ty| BindGroupLayoutEntry {
            binding: binding + offset,
            visibility,
            ty,
            count: None,
        };
        [entry(0, words), entry(1, texels), entry(2, sampler)]
    }
}

fn texel_pages(
    device: &Device,
    queue: &Queue,
    pages: &TexelPages,
) -> Result<TextureView, RuntimeError> {
    let [width, height] = pages.size();
    let texture = page_array(device, pages.size(), pages.count())?;
    let rows = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(4 * width),
        rows_per_image: Some(height),
    };
    let texels = texture.as_image_copy();
    queue.write_texture(texels, pages.bytes(), rows, texture.size());
    Ok(array_view(&texture))
}

/// Empty pages. To be called in [`checked`](super::checked).
///
/// # Errors
/// [`RuntimeError::Limit`] when the device has no texture of that size.
pub(crate) fn page_array(
    device: &Device,
    [width, height]: [u32; 2],
    count: u32,
) -> Result<Texture, RuntimeError> {
    let limits = device.limits();
    let [side, layers] = [
        limits.max_texture_dimension_2d,
        limits.max_texture_array_layers,
    ];
    if width.max(height) > side || count > layers {
        return Err(RuntimeError::Limit(format!(
            "images of {count} pages of {width} x {height} texels, this device has at most {layers} of \
             {side} x {side}",
        )));
    }
    Ok(device.create_texture(&wgpu::TextureDescriptor {
        label: Some("vtex texels"),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: count,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TextureFormat::Rgba8UnormSrgb,
        // A set copies its pages into larger ones.
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST | TextureUsages::COPY_SRC,
        view_formats: &[],
    }))
}

/// All pages, as an array even where there is one.
pub(crate) fn array_view(texture: &Texture) -> TextureView {
    texture.create_view(&TextureViewDescriptor {
        dimension: Some(TextureViewDimension::D2Array),
        ..TextureViewDescriptor::default()
    })
}

/// What samples pages.
pub(crate) fn texel_sampler(device: &Device) -> Sampler {
    device.create_sampler(&SamplerDescriptor {
        label: Some("vtex texels"),
        address_mode_u: AddressMode::ClampToEdge,
        address_mode_v: AddressMode::ClampToEdge,
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        ..SamplerDescriptor::default()
    })
}
