//! Any number of vector textures for one pipeline.

mod handles;
mod memory;
mod pages;
mod space;
mod words;

use std::fmt;

use vtex_format::{Grid, Meta, SpecKey, VtexFile};
use vtex_shaders::cores::map_all;
use vtex_shaders::layout::FilterMode;
use vtex_shaders::set::{TextureHandle, every_feature, set_fragment, set_key};
use vtex_shaders::{BindingSlot, PackOptions, Packed, pack, pack_in_pages, spec_key};
use wgpu::{BindGroup, BindGroupLayout, Buffer, Device, Queue, Sampler, TextureView};

use crate::device::checked;
use crate::load::texture_layout;
use crate::{LoadOptions, RuntimeError};

use memory::{Change, Memory};
use pages::PageLimits;
use space::{Bounds, Plan, Space};

/// What a caller may decide about a set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureSetOptions {
    /// Features that the text has code for from the start, bits of [`vtex_format::Features`]. Those of
    /// textures are added when they are. With [`TextureSetOptions::every_feature`] the text never changes.
    pub features: u32,
    /// Sides up to which a page of texels grows before there is a second, at most
    /// [`MAX_PAGE_SIDE`](vtex_shaders::MAX_PAGE_SIDE). A level of an image that is larger makes the pages
    /// larger, all of them. There are at most 64: 1 GiB of texels with the default, 2048.
    pub page_side: u32,
    /// How many threads pack textures, 0 for one a core. A browser has one.
    pub threads: usize,
}

impl Default for TextureSetOptions {
    fn default() -> Self {
        Self {
            features: 0,
            page_side: 2048,
            threads: 0,
        }
    }
}

impl TextureSetOptions {
    /// A text that serves every texture in a filter mode, so that no texture ever asks for another. It is
    /// larger, and slower where it takes more registers than the textures at hand need. A software driver,
    /// which runs all code of a lookup, takes about ten times as long.
    pub fn every_feature(filter: FilterMode) -> Self {
        Self {
            features: every_feature(filter),
            ..Self::default()
        }
    }
}

/// Any number of vector textures for one pipeline: `vtex_sample(handle, uv, footprint)` in your own WGSL.
///
/// ```no_run
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let (device, queue): (wgpu::Device, wgpu::Queue) = unimplemented!();
/// # let (my_wgsl, signs): (&str, Vec<Vec<u8>>) = ("", vec![]);
/// use vtex_runtime::{Limits, LoadOptions, TextureSet, TextureSetOptions, VtexFile, parse_all, wgpu};
///
/// let mut set = TextureSet::new(&device, &queue, &TextureSetOptions::default())?;
/// let files = parse_all(&signs, &Limits::default()).into_iter(); // by all cores, as what follows
/// let files: Vec<VtexFile> = files.collect::<Result<_, _>>()?;
/// let options = LoadOptions::default();
/// let handles = set.add_all(files.iter().map(|file| (file, &options)))?;
/// let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
///     label: None,
///     // `vtex_sample(handle, uv, vec4f(dpdx(uv), dpdy(uv)))` in a fragment shader.
///     source: wgpu::ShaderSource::Wgsl((set.wgsl_fragment(1, 0) + my_wgsl).into()),
/// });
/// let layout = set.bind_group_layout(); // group 1 of the pipeline's layout
/// // ... and in each frame: pass.set_bind_group(1, set.bind_group(), &[]);
/// set.remove(handles[0]); // whoever still draws it draws nothing
/// # Ok(()) }
/// ```
///
/// **When something of yours is out of date.** Adding textures may change two things, and neither changes
/// otherwise:
/// - [`TextureSet::key`], where a texture needs code that the text has none for. Until you build the
///   pipeline again from [`TextureSet::wgsl_fragment`], that texture looks wrong and all others right.
/// - [`TextureSet::bind_group`], where the buffer or the pages were too small; [`TextureSet::generation`]
///   counts up then. Ask for the group in each frame, or watch the count if you bind
///   [`TextureSet::buffer`], [`TextureSet::texels`] and [`TextureSet::sampler`] in a group of your own. A
///   group from before still shows the textures that it had.
///
/// **Memory.** The buffer doubles when it is too small, pages double up to
/// [`TextureSetOptions::page_side`], and then their number grows by half; nothing shrinks. While they grow,
/// the old and the new ones exist side by side. Room of a removed texture is used again. Textures that are
/// added together lie more closely than one by one.
///
/// **Limits.** The words of all textures lie in one storage binding (128 MiB on core WebGPU: about 300
/// drawings), their texels
/// on 64 pages of at most 8192 x 8192. What exceeds a limit is a [`RuntimeError::Limit`] that says which and
/// what to do, and the set stays as it was.
pub struct TextureSet {
    device: Device,
    queue: Queue,
    options: TextureSetOptions,
    key: SpecKey,
    space: Space,
    /// The words of the texture that shows nothing.
    nothing: Vec<u32>,
    layout: BindGroupLayout,
    memory: Memory,
    generation: u64,
}

/// Bytes of a set on the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SetBytes {
    /// Words of its textures, and the table of handles.
    pub words: u64,
    /// Of the buffer that holds them.
    pub words_held: u64,
    /// Texels of its textures.
    pub texels: u64,
    /// Of the pages that hold them.
    pub texels_held: u64,
}

impl fmt::Debug for TextureSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TextureSet")
            .field("len", &self.len())
            .field("key", &self.key)
            .field("generation", &self.generation)
            .field("bytes", &self.bytes())
            .finish_non_exhaustive()
    }
}

impl TextureSet {
    /// A set without textures.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device refuses a buffer of 16 KiB or is lost.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn new(
        device: &Device,
        queue: &Queue,
        options: &TextureSetOptions,
    ) -> Result<Self, RuntimeError> {
        crate::device::block_on(device, Self::new_async(device, queue, options))
    }

    /// As `TextureSet::new`, for callers that must not block.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device refuses a buffer of 16 KiB or is lost.
    pub async fn new_async(
        device: &Device,
        queue: &Queue,
        options: &TextureSetOptions,
    ) -> Result<Self, RuntimeError> {
        let nothing = nothing_words();
        let space = Space::default();
        let plan = space.with(&mut [], nothing.len(), &bounds(device, options))?;
        let (layout, memory) = checked(device, "texture set", || {
            let layout = texture_layout(device);
            let change = Change {
                plan: &plan,
                textures: &[],
                nothing: &nothing,
            };
            let memory = Memory::changed(None, device, queue, &layout, &change)?;
            Ok((layout, memory))
        })
        .await?;
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            options: *options,
            key: set_key(options.features),
            space: plan.space,
            nothing,
            layout,
            memory,
            generation: 0,
        })
    }

    /// Adds a texture.
    ///
    /// # Errors
    /// As [`TextureSet::add_all_async`].
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn add(
        &mut self,
        file: &VtexFile,
        options: &LoadOptions,
    ) -> Result<TextureHandle, RuntimeError> {
        let device = self.device.clone();
        crate::device::block_on(&device, self.add_async(file, options))
    }

    /// As `TextureSet::add`, for callers that must not block.
    ///
    /// # Errors
    /// As [`TextureSet::add_all_async`].
    pub async fn add_async(
        &mut self,
        file: &VtexFile,
        options: &LoadOptions,
    ) -> Result<TextureHandle, RuntimeError> {
        let added = self.add_all_async([(file, options)]).await?;
        Ok(added.first().copied().unwrap_or_default())
    }

    /// Adds textures, which all cores pack: a handle for each, in order, or none of them.
    ///
    /// # Errors
    /// As [`TextureSet::add_all_async`].
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn add_all<'a>(
        &mut self,
        textures: impl IntoIterator<Item = (&'a VtexFile, &'a LoadOptions)>,
    ) -> Result<Vec<TextureHandle>, RuntimeError> {
        let device = self.device.clone();
        crate::device::block_on(&device, self.add_all_async(textures))
    }

    /// As `TextureSet::add_all`, for callers that must not block. Where the future is dropped before its
    /// end, the set stays as it was.
    ///
    /// # Errors
    /// [`RuntimeError::Limit`] when the textures do not fit the device's limits or memory together with
    /// those that the set has, or there are more than 1,048,575.
    pub async fn add_all_async<'a>(
        &mut self,
        textures: impl IntoIterator<Item = (&'a VtexFile, &'a LoadOptions)>,
    ) -> Result<Vec<TextureHandle>, RuntimeError> {
        let textures: Vec<(&VtexFile, &PackOptions)> = textures
            .into_iter()
            .map(|(file, options)| (file, &options.pack))
            .collect();
        let bounds = bounds(&self.device, &self.options);
        let side = bounds.pages.side;
        let mut packed = map_all(&textures, self.options.threads, |&(file, options)| {
            pack_in_pages(file, options, side)
        });
        let plan = self.space.with(&mut packed, self.nothing.len(), &bounds)?;
        let memory = checked(&self.device, "texture set", || {
            let change = Change {
                plan: &plan,
                textures: &packed,
                nothing: &self.nothing,
            };
            let before = Some(&self.memory);
            Memory::changed(before, &self.device, &self.queue, &self.layout, &change)
        })
        .await?;
        let needed = textures
            .iter()
            .fold(self.key.features, |all, (file, options)| {
                all | spec_key(file, options).features
            });
        self.key = set_key(needed);
        Ok(self.commit(plan, memory))
    }

    fn commit(&mut self, plan: Plan, memory: Memory) -> Vec<TextureHandle> {
        if memory.group != self.memory.group {
            self.generation += 1;
        }
        self.memory = memory;
        self.space = plan.space;
        plan.added
    }

    /// Takes a texture out: from what is submitted from now on its handle shows nothing, and never another
    /// texture. Says whether the set had it.
    pub fn remove(&mut self, handle: TextureHandle) -> bool {
        let had = self.space.remove(handle);
        if had {
            self.memory.write_entry(&self.queue, &self.space, handle);
        }
        had
    }

    /// Whether the set has the texture.
    pub fn contains(&self, handle: TextureHandle) -> bool {
        self.space.handles.get(handle).is_some()
    }

    /// The handles of its textures.
    pub fn handles(&self) -> impl Iterator<Item = TextureHandle> {
        self.space.handles.iter().map(|(handle, _)| handle)
    }

    /// How many textures it has.
    pub fn len(&self) -> usize {
        self.space.handles.len()
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// WGSL that declares the set in `group`, at `binding` and the two bindings behind it, and the function
    /// `fn vtex_sample(handle: u32, uv: vec2f, footprint: vec4f) -> vec4f`: linear light, premultiplied.
    ///
    /// `handle` is [`TextureHandle::to_bits`]; any value is safe, and one that names no texture of the set
    /// gives zeros. The rest is as in [`GpuVtex::wgsl_fragment`](crate::GpuVtex::wgsl_fragment). Sets of the
    /// same [`TextureSet::key`] share one text.
    pub fn wgsl_fragment(&self, group: u32, binding: u32) -> String {
        set_fragment(self.key.features, BindingSlot { group, binding })
    }

    /// Decides the text of [`TextureSet::wgsl_fragment`]: build pipelines again when it changes. It holds
    /// [`TextureSetOptions::features`] and those of every texture that was added, also of removed ones.
    pub fn key(&self) -> &SpecKey {
        &self.key
    }

    /// Counts how often [`TextureSet::bind_group`] became another.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// Layout of [`TextureSet::bind_group`], the same for all time: as
    /// [`GpuVtex::bind_group_layout`](crate::GpuVtex::bind_group_layout).
    pub fn bind_group_layout(&self) -> &BindGroupLayout {
        &self.layout
    }

    /// The set as it is now, ready to be set. To be asked for again where textures were added since.
    pub fn bind_group(&self) -> &BindGroup {
        &self.memory.group
    }

    /// The words of its textures and the table of handles.
    pub fn buffer(&self) -> &Buffer {
        &self.memory.uploaded.words
    }

    /// The texels of its textures' images, as a 2D array.
    pub fn texels(&self) -> &TextureView {
        &self.memory.uploaded.texels
    }

    /// The sampler of [`TextureSet::texels`].
    pub fn sampler(&self) -> &Sampler {
        &self.memory.uploaded.sampler
    }

    /// What it takes on the device.
    pub fn bytes(&self) -> SetBytes {
        let held = self.space.buffer_bytes();
        let texture = self.memory.uploaded.texels.texture();
        let [x, y, layers] = [
            texture.width(),
            texture.height(),
            texture.depth_or_array_layers(),
        ]
        .map(u64::from);
        SetBytes {
            words: held - words::GROUP_BYTES * u64::from(self.space.words.free_groups()),
            words_held: held,
            texels: 4 * self.space.pages.texels(),
            texels_held: 4 * x * y * layers,
        }
    }
}

fn bounds(device: &Device, options: &TextureSetOptions) -> Bounds {
    let limits = device.limits();
    Bounds {
        buffer_bytes: limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size),
        pages: PageLimits {
            side: options.page_side.clamp(1, limits.max_texture_dimension_2d),
            device_side: limits.max_texture_dimension_2d,
            device_layers: limits.max_texture_array_layers,
        },
    }
}

/// One empty cell.
fn nothing_words() -> Vec<u32> {
    let mut file = VtexFile::blank(Meta::new([1.0; 2], Grid::new([1; 2], 1)));
    file.cells = vec![0];
    let Packed { words, .. } = pack(&file, &PackOptions::default());
    words
}
