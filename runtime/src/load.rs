//! A `.vtex` file on the GPU, for use in any shader.

use vtex_format::{SpecKey, VtexFile};
use vtex_shaders::{PackOptions, Packed};
use wgpu::{BindGroup, BindGroupLayout, Buffer, Device, Queue, Sampler, ShaderStages, TextureView};

use crate::device::{Uploaded, checked};
use crate::{RuntimeError, TexelFormat};

/// What a caller may decide at load; the file's own settings hold otherwise.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Filter mode and overrides of the file's sampler settings.
    pub pack: PackOptions,
    /// How texels lie on the device. A [`TextureSet`](crate::TextureSet) has one format for all, in
    /// [`TextureSetOptions::texels`](crate::TextureSetOptions::texels), and does not read this.
    pub texels: TexelFormat,
}

/// Reads files by all cores, each as [`VtexFile::parse`] does, in order. For one or two that is enough by
/// itself.
#[cfg(any(feature = "zstd", feature = "ruzstd"))]
pub fn parse_all<B: AsRef<[u8]> + Sync>(
    files: &[B],
    limits: &vtex_format::Limits,
) -> Vec<Result<VtexFile, vtex_format::ReadError>> {
    vtex_shaders::cores::map_all(files, 0, |bytes| VtexFile::parse(bytes.as_ref(), limits))
}

/// One vector texture on the GPU: a read-only storage buffer, a texture with the texels of its images,
/// and their sampler. For several in one shader see [`TextureSet`](crate::TextureSet).
///
/// Put the fragment in front of your own WGSL, bind the texture, call `vtex_sample`:
///
/// ```no_run
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let (device, queue): (wgpu::Device, wgpu::Queue) = unimplemented!();
/// # let my_wgsl = ""; let bytes = vec![];
/// let file = vtex_format::VtexFile::parse(&bytes, &vtex_format::Limits::default())?;
/// let texture = vtex_runtime::GpuVtex::upload(&device, &queue, &file, &Default::default())?;
/// let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
///     label: None,
///     // `vtex_sample(uv, vec4f(dpdx(uv), dpdy(uv)))` in a fragment shader.
///     source: wgpu::ShaderSource::Wgsl((texture.wgsl_fragment(1, 0) + my_wgsl).into()),
/// });
/// let layout = texture.bind_group_layout(); // group 1 of the pipeline's layout
/// // ... and when drawing: pass.set_bind_group(1, texture.bind_group(), &[]);
/// # Ok(()) }
/// ```
#[derive(Clone, Debug)]
pub struct GpuVtex {
    key: SpecKey,
    uploaded: Uploaded,
    layout: BindGroupLayout,
    group: BindGroup,
}

impl GpuVtex {
    /// Packs and uploads `file`.
    ///
    /// # Errors
    /// [`RuntimeError::Limit`] when the packed words are larger than one storage binding of the
    /// device (128 MiB on core WebGPU), or words or texels do not fit its memory.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn upload(
        device: &Device,
        queue: &Queue,
        file: &VtexFile,
        options: &LoadOptions,
    ) -> Result<Self, RuntimeError> {
        let uploaded = Self::upload_async(device, queue, file, options);
        crate::device::block_on(device, uploaded)
    }

    /// As `GpuVtex::upload`, for callers that must not block.
    ///
    /// # Errors
    /// [`RuntimeError::Limit`] when the packed words are larger than one storage binding of the
    /// device (128 MiB on core WebGPU), or words or texels do not fit its memory.
    pub async fn upload_async(
        device: &Device,
        queue: &Queue,
        file: &VtexFile,
        options: &LoadOptions,
    ) -> Result<Self, RuntimeError> {
        let packed = vtex_shaders::pack(file, &options.pack);
        // Not `file.spec`: options such as the filter mode need other code.
        let key = vtex_shaders::spec_key(file, &options.pack);
        Self::upload_packed(device, queue, &packed, &key, options.texels).await
    }

    /// Reads, packs and uploads the bytes of a file. A file of `vtex bake --profile load` carries what
    /// packing makes of it, so that it loads several times as fast as by [`VtexFile::parse`] and
    /// `GpuVtex::upload`.
    ///
    /// # Errors
    /// [`RuntimeError::File`] for bytes that are no file or ask for more than `limits`, and those of
    /// `GpuVtex::upload`.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    #[cfg(any(feature = "zstd", feature = "ruzstd"))]
    pub fn load(
        device: &Device,
        queue: &Queue,
        bytes: &[u8],
        limits: &vtex_format::Limits,
        options: &LoadOptions,
    ) -> Result<Self, RuntimeError> {
        let loaded = Self::load_async(device, queue, bytes, limits, options);
        crate::device::block_on(device, loaded)
    }

    /// As `GpuVtex::load`, for callers that must not block.
    ///
    /// # Errors
    /// [`RuntimeError::File`] for bytes that are no file or ask for more than `limits`, and those of
    /// [`GpuVtex::upload_async`].
    #[cfg(any(feature = "zstd", feature = "ruzstd"))]
    pub async fn load_async(
        device: &Device,
        queue: &Queue,
        bytes: &[u8],
        limits: &vtex_format::Limits,
        options: &LoadOptions,
    ) -> Result<Self, RuntimeError> {
        let loaded = vtex_shaders::load(bytes, limits, &options.pack)?;
        Self::upload_packed(device, queue, &loaded.packed, &loaded.key, options.texels).await
    }

    async fn upload_packed(
        device: &Device,
        queue: &Queue,
        packed: &Packed,
        key: &SpecKey,
        format: TexelFormat,
    ) -> Result<Self, RuntimeError> {
        let key = vtex_shaders::kernel_key(key);
        checked(device, "texture", || {
            let uploaded = Uploaded::new(device, queue, &packed.words, &packed.texels, format)?;
            let layout = texture_layout(device);
            let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("vtex texture"),
                layout: &layout,
                entries: &uploaded.entries(0),
            });
            Ok(Self {
                key,
                uploaded,
                layout,
                group,
            })
        })
        .await
    }

    /// WGSL that declares the texture in `group`, at `binding` and the two bindings behind it, and the
    /// function
    /// `fn vtex_sample(uv: vec2f, footprint: vec4f) -> vec4f`: linear light, premultiplied.
    ///
    /// `footprint` holds two axes of the region to average, full extents in uv: in a fragment
    /// shader `vec4f(dpdx(uv), dpdy(uv))`, zero for a point. Every name it declares starts with
    /// `vtex_`, `Vtex` or `VTEX_`. Textures of the same [`GpuVtex::key`] share one text.
    ///
    /// [`GpuVtex::bind_group`] binds the texture from binding 0 on; with another `binding` bind
    /// [`GpuVtex::buffer`], [`GpuVtex::texels`] and [`GpuVtex::sampler`] in a group of your own.
    pub fn wgsl_fragment(&self, group: u32, binding: u32) -> String {
        vtex_shaders::fragment(&self.key, vtex_shaders::BindingSlot { group, binding })
    }

    /// Layout of [`GpuVtex::bind_group`], visible to fragment and compute shaders: a read-only storage
    /// buffer at binding 0, a filterable 2D array texture at 1, and a filtering sampler at 2.
    pub fn bind_group_layout(&self) -> &BindGroupLayout {
        &self.layout
    }

    /// The texture, ready to be set.
    pub fn bind_group(&self) -> &BindGroup {
        &self.group
    }

    /// The texture's words.
    pub fn buffer(&self) -> &Buffer {
        &self.uploaded.words
    }

    /// The texels of its images, as a 2D array.
    pub fn texels(&self) -> &TextureView {
        &self.uploaded.texels
    }

    /// The sampler of [`GpuVtex::texels`].
    pub fn sampler(&self) -> &Sampler {
        &self.uploaded.sampler
    }

    /// Decides the text of [`GpuVtex::wgsl_fragment`]: cache pipelines by it. It is the
    /// [`kernel_key`](vtex_shaders::kernel_key) of what the texture holds and the options ask for.
    pub fn key(&self) -> &SpecKey {
        &self.key
    }
}

/// Of one texture or of a set, in a group of its own.
pub(crate) fn texture_layout(device: &Device) -> BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("vtex texture"),
        entries: &Uploaded::layout_entries(0, ShaderStages::FRAGMENT | ShaderStages::COMPUTE),
    })
}
