//! A packed texture's bindings: words, texels, sampler.

use vtex_shaders::TexelPages;
use wgpu::{
    AddressMode, BindGroupEntry, BindGroupLayoutEntry, BindingResource, BindingType, Buffer,
    BufferBindingType, BufferUsages, Device, Features, FilterMode, Queue, Sampler,
    SamplerBindingType, SamplerDescriptor, ShaderStages, TexelCopyBufferLayout, Texture,
    TextureFormat, TextureSampleType, TextureUsages, TextureView, TextureViewDescriptor,
    TextureViewDimension,
};

use super::buffer::filled_buffer;
use crate::RuntimeError;

/// How the texels of images lie on the device: mips, patches and embedded images. Outlines are no texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TexelFormat {
    /// Four bytes a texel, as files have them.
    #[default]
    Rgba8,
    /// A byte a texel: BC7, made when a texture is loaded, at 25 to 50 million texels a second. Drawings keep
    /// 45 to 50 dB. Software drivers decode a block at each fetch, and take about 20 times as long for one. A
    /// device without [`Features::TEXTURE_COMPRESSION_BC`], which whoever opens it must ask for,
    /// has `Rgba8` instead.
    Bc7,
}

impl TexelFormat {
    /// What of it the device has.
    pub(crate) fn on(self, device: &Device) -> Self {
        match device.features().contains(Features::TEXTURE_COMPRESSION_BC) {
            true => self,
            false => Self::Rgba8,
        }
    }

    /// Of so many texels.
    pub(crate) fn bytes(self, texels: u64) -> u64 {
        match self {
            Self::Rgba8 => 4 * texels,
            Self::Bc7 => texels,
        }
    }

    /// What a copy to a texture wants instead of the pages' own bytes.
    pub(crate) fn encoded(self, pages: &TexelPages) -> Option<Vec<u8>> {
        match self {
            Self::Rgba8 => None,
            Self::Bc7 => Some(pages.blocks()),
        }
    }

    /// Where in the bytes of a copy the rows of a page are.
    pub(crate) fn layout(self, pages: &TexelPages, page: u32) -> TexelCopyBufferLayout {
        let [width, height] = pages.size();
        // Blocks of 4 x 4 texels have 16 bytes.
        let (row, rows) = match self {
            Self::Rgba8 => (4 * width, height),
            Self::Bc7 => (4 * width, height / 4),
        };
        TexelCopyBufferLayout {
            offset: u64::from(page) * u64::from(row) * u64::from(rows),
            bytes_per_row: Some(row),
            rows_per_image: Some(rows),
        }
    }

    fn texture_format(self) -> TextureFormat {
        match self {
            Self::Rgba8 => TextureFormat::Rgba8UnormSrgb,
            Self::Bc7 => TextureFormat::Bc7RgbaUnormSrgb,
        }
    }
}

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
        format: TexelFormat,
    ) -> Result<Self, RuntimeError> {
        let bytes = bytemuck::cast_slice(words);
        Ok(Self {
            words: filled_buffer(device, queue, "vtex words", bytes, BufferUsages::STORAGE)?,
            texels: texel_pages(device, queue, texels, format.on(device))?,
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
    format: TexelFormat,
) -> Result<TextureView, RuntimeError> {
    let texture = page_array(device, pages.size(), pages.count(), format)?;
    let texels = texture.as_image_copy();
    let encoded = format.encoded(pages);
    let data = encoded.as_deref().unwrap_or(pages.bytes());
    queue.write_texture(texels, data, format.layout(pages, 0), texture.size());
    Ok(array_view(&texture))
}

/// Empty pages of whole blocks. To be called in [`checked`](super::checked).
///
/// # Errors
/// [`RuntimeError::Limit`] when the device has no texture of that size.
pub(crate) fn page_array(
    device: &Device,
    [width, height]: [u32; 2],
    count: u32,
    format: TexelFormat,
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
        format: format.texture_format(),
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
