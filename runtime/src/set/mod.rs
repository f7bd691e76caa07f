//! Any number of vector textures for one pipeline.

mod handles;
#[cfg(any(feature = "zstd", feature = "ruzstd"))]
mod load;
mod memory;
mod options;
mod pages;
mod pools;
mod space;
mod words;

use std::fmt;

use vtex_format::{Grid, Meta, SpecKey, VtexFile};
use vtex_shaders::cores::map_all;
use vtex_shaders::set::{TextureHandle, set_fragment, set_key};
use vtex_shaders::{BindingSlot, PackOptions, Packed, pack, pack_in_pages, spec_key};
use wgpu::{BindGroup, BindGroupLayout, Buffer, Device, Queue, Sampler, TextureView};

use crate::device::{checked, texel_sampler};
use crate::load::texture_layout;
use crate::{LoadOptions, RuntimeError, TexelFormat};

use memory::{Change, Fixed, Memory};
use pools::{Budget, Made, PoolPlans};
use space::{Plan, Space};

pub use options::TextureSetOptions;

/// Any number of vector textures for one pipeline: `vtex_sample(handle, uv, footprint)` in your own WGSL.
///
/// ```no_run
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let (device, queue): (wgpu::Device, wgpu::Queue) = unimplemented!();
/// # let (my_wgsl, signs): (&str, Vec<Vec<u8>>) = ("", vec![]);
/// use vtex_runtime::{Limits, LoadOptions, TextureSet, TextureSetOptions, wgpu};
///
/// let mut set = TextureSet::new(&device, &queue, &TextureSetOptions::default())?;
/// let options = LoadOptions::default();
/// let files = signs.iter().map(|bytes| (&bytes[..], &options));
/// let handles = set.load_all(files, &Limits::default())?; // by all cores
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
/// **Pools.** A bind group binds a limited number of bytes, 128 MiB of words on core WebGPU: about 300
/// drawings. A set that is to hold more has several *pools*, each with a buffer, pages and a bind group of
/// its own: say how many it may have in [`TextureSetOptions::max_pools`]. Layout, text and pipeline stay one.
/// A texture goes to the first pool with room for it, a new pool is opened where none has, and it stays
/// there; [`TextureHandle::pool`] says which it is. Sort what you draw by that, and set
/// [`TextureSet::bind_group_of`] it; with the group of another pool it shows nothing, and never another
/// texture. A [`QueueSampler`](crate::QueueSampler) answers queues whose handles are of all pools.
///
/// **Memory.** A buffer doubles when it is too small, pages double up to
/// [`TextureSetOptions::page_side`], and then their number grows by half; nothing shrinks. While they grow,
/// the old and the new ones exist side by side. Room of a removed texture is used again. Textures that are
/// added together lie more closely than one by one.
///
/// **Limits.** The words of a pool lie in one storage binding, its texels on 64 pages of at most 8192 x 8192,
/// and it has at most 65,536 textures; a set has at most 32 pools. What exceeds a limit is a
/// [`RuntimeError::Limit`] that says which and what to do, and the set stays as it was.
pub struct TextureSet {
    device: Device,
    queue: Queue,
    options: TextureSetOptions,
    key: SpecKey,
    fixed: Fixed,
    /// One at least.
    pools: Vec<Pool>,
    generation: u64,
}

/// Textures that are bound together.
struct Pool {
    space: Space,
    memory: Memory,
}

/// What one pool of a set binds, for a group of your own.
#[derive(Clone, Copy, Debug)]
pub struct PoolBindings<'a> {
    /// All of it, ready to be set.
    pub bind_group: &'a BindGroup,
    /// The words of its textures and the table of handles.
    pub buffer: &'a Buffer,
    /// The texels of its textures' images, as a 2D array.
    pub texels: &'a TextureView,
    /// The sampler of the texels.
    pub sampler: &'a Sampler,
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
            .field("pools", &self.pools.len())
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
    /// [`RuntimeError::Parameter`] for options out of their range, and [`RuntimeError::Device`] when the device refuses a buffer of 16 KiB or is lost.
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
    /// [`RuntimeError::Parameter`] for options out of their range, and [`RuntimeError::Device`] when the device refuses a buffer of 16 KiB or is lost.
    pub async fn new_async(
        device: &Device,
        queue: &Queue,
        options: &TextureSetOptions,
    ) -> Result<Self, RuntimeError> {
        options.check()?;
        let (fixed, pools) = checked(device, "texture set", || {
            let fixed = Fixed {
                layout: texture_layout(device),
                sampler: texel_sampler(device),
                texels: options.texels.on(device),
                nothing: nothing_words(),
            };
            let bounds = options.bounds(device, fixed.nothing.len());
            let (first, _) = Space::of_pool(0).with(&mut [], &[], &bounds);
            let make = |plan| Pool::changed(None, (device, queue), plan, (&[], &[]), &fixed);
            let pools: Vec<Pool> = first.into_iter().map(make).collect::<Result<_, _>>()?;
            Ok((fixed, pools))
        })
        .await?;
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            options: *options,
            key: set_key(options.features),
            fixed,
            pools,
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
    /// [`RuntimeError::Limit`] when the textures do not fit the limits of the device or of the options, or
    /// the device's memory, together with those that the set has. What passes all pools' words or
    /// [`TextureSetOptions::max_bytes`] is refused before the rest is packed, and before the device is asked
    /// for anything.
    pub async fn add_all_async<'a>(
        &mut self,
        textures: impl IntoIterator<Item = (&'a VtexFile, &'a LoadOptions)>,
    ) -> Result<Vec<TextureHandle>, RuntimeError> {
        let textures: Vec<(&VtexFile, &PackOptions)> = textures
            .into_iter()
            .map(|(file, options)| (file, &options.pack))
            .collect();
        self.add_made(&textures, |&(file, options), page_side| {
            Ok(Made {
                packed: pack_in_pages(file, options, page_side),
                features: spec_key(file, options).features,
            })
        })
        .await
    }

    /// Adds what `make` makes of each of `textures`, with pages of so many texels a side, on all cores.
    async fn add_made<T: Sync>(
        &mut self,
        textures: &[T],
        make: impl Fn(&T, u32) -> Result<Made, RuntimeError> + Sync,
    ) -> Result<Vec<TextureHandle>, RuntimeError> {
        let options = &self.options;
        let bounds = options.bounds(&self.device, self.fixed.nothing.len());
        let budget = Budget::new(options, &bounds, &self.bytes(), self.fixed.texels);
        let made = map_all(textures, options.threads, |texture| {
            let made = budget.spend(|| make(texture, bounds.pages.side))?;
            let encoded = self.fixed.texels.encoded(&made.packed.texels);
            Ok::<_, RuntimeError>((made, encoded))
        });
        let made: Vec<_> = made.into_iter().collect::<Result<_, _>>()?;
        let (made, encoded): (Vec<Made>, Vec<_>) = made.into_iter().unzip();
        budget.check()?;
        let needed = made
            .iter()
            .fold(self.key.features, |all, made| all | made.features);
        let mut packed: Vec<Packed> = made.into_iter().map(|made| made.packed).collect();
        let spaces = self.pools.iter().map(|pool| &pool.space);
        let PoolPlans { plans, handles } =
            pools::plan(spaces, &mut packed, &bounds, options.most_pools())?;
        let changed = checked(&self.device, "texture set", || {
            let on = (&self.device, &self.queue);
            let change = |plan: Plan| {
                let before = self.pools.get(plan.space.handles.pool() as usize);
                Pool::changed(before, on, plan, (&packed, &encoded), &self.fixed)
            };
            let pools = plans.into_iter().map(change);
            pools.collect::<Result<Vec<Pool>, RuntimeError>>()
        })
        .await?;
        self.key = set_key(needed);
        self.commit(changed);
        Ok(handles)
    }

    fn commit(&mut self, changed: Vec<Pool>) {
        for pool in changed {
            let index = pool.space.handles.pool() as usize;
            match self.pools.get_mut(index) {
                Some(before) => {
                    self.generation += u64::from(before.memory.group != pool.memory.group);
                    *before = pool;
                }
                None => {
                    self.generation += 1;
                    self.pools.push(pool);
                }
            }
        }
    }

    /// Takes a texture out: from what is submitted from now on its handle shows nothing, and never another
    /// texture. Says whether the set had it.
    pub fn remove(&mut self, handle: TextureHandle) -> bool {
        let pool = self.pools.get_mut(handle.pool() as usize);
        pool.is_some_and(|Pool { space, memory }| {
            let had = space.remove(handle);
            if had {
                memory.write_entry(&self.queue, space, handle);
            }
            had
        })
    }

    /// Whether the set has the texture.
    pub fn contains(&self, handle: TextureHandle) -> bool {
        let pool = self.pools.get(handle.pool() as usize);
        pool.is_some_and(|pool| pool.space.handles.get(handle).is_some())
    }

    /// The handles of its textures.
    pub fn handles(&self) -> impl Iterator<Item = TextureHandle> {
        let pools = self.pools.iter();
        pools.flat_map(|pool| pool.space.handles.iter().map(|(handle, _)| handle))
    }

    /// How many textures it has.
    pub fn len(&self) -> usize {
        self.pools.iter().map(|pool| pool.space.handles.len()).sum()
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

    /// Counts how often the bind group of a pool became another, and pools came to be.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// Layout of every pool's bind group, the same for all time: as
    /// [`GpuVtex::bind_group_layout`](crate::GpuVtex::bind_group_layout).
    pub fn bind_group_layout(&self) -> &BindGroupLayout {
        &self.fixed.layout
    }

    /// The set as it is now, ready to be set; where it may have several pools, the first of them. To be asked
    /// for again where textures were added since.
    pub fn bind_group(&self) -> &BindGroup {
        &self.first().memory.group
    }

    /// That of the pool that a handle is of; where there is no such pool, of the first, with which the handle
    /// shows nothing.
    pub fn bind_group_of(&self, handle: TextureHandle) -> &BindGroup {
        let pool = self.pools.get(handle.pool() as usize);
        &pool.unwrap_or_else(|| self.first()).memory.group
    }

    /// What each pool binds, in the order of [`TextureHandle::pool`].
    pub fn pools(&self) -> impl ExactSizeIterator<Item = PoolBindings<'_>> {
        self.pools.iter().map(|Pool { memory, .. }| PoolBindings {
            bind_group: &memory.group,
            buffer: &memory.uploaded.words,
            texels: &memory.uploaded.texels,
            sampler: &memory.uploaded.sampler,
        })
    }

    /// How many pools it may have.
    pub fn max_pools(&self) -> u32 {
        self.options.most_pools()
    }

    /// The words of the first pool's textures and the table of handles.
    pub fn buffer(&self) -> &Buffer {
        &self.first().memory.uploaded.words
    }

    /// The texels of the first pool's textures' images, as a 2D array.
    pub fn texels(&self) -> &TextureView {
        &self.first().memory.uploaded.texels
    }

    /// The sampler of [`TextureSet::texels`].
    pub fn sampler(&self) -> &Sampler {
        &self.fixed.sampler
    }

    fn first(&self) -> &Pool {
        self.pools.first().expect("a set is made with a pool")
    }

    /// What it takes on the device.
    pub fn bytes(&self) -> SetBytes {
        let pools = self.pools.iter().map(|pool| pool.bytes(self.fixed.texels));
        pools.fold(SetBytes::default(), |sum, pool| SetBytes {
            words: sum.words + pool.words,
            words_held: sum.words_held + pool.words_held,
            texels: sum.texels + pool.texels,
            texels_held: sum.texels_held + pool.texels_held,
        })
    }
}

impl Pool {
    fn changed(
        before: Option<&Self>,
        (device, queue): (&Device, &Queue),
        plan: Plan,
        (textures, encoded): (&[Packed], &[Option<Vec<u8>>]),
        fixed: &Fixed,
    ) -> Result<Self, RuntimeError> {
        let change = Change {
            plan: &plan,
            textures,
            encoded,
            fixed,
        };
        let before = before.map(|pool| &pool.memory);
        let memory = Memory::changed(before, device, queue, &change)?;
        let Plan { space, .. } = plan;
        Ok(Self { space, memory })
    }

    fn bytes(&self, format: TexelFormat) -> SetBytes {
        let texture = self.memory.uploaded.texels.texture();
        let [x, y, layers] = [
            texture.width(),
            texture.height(),
            texture.depth_or_array_layers(),
        ]
        .map(u64::from);
        SetBytes {
            words: self.space.used_word_bytes(),
            words_held: self.space.buffer_bytes(),
            texels: format.bytes(self.space.pages.texels()),
            texels_held: format.bytes(x * y * layers),
        }
    }
}

/// One empty cell.
fn nothing_words() -> Vec<u32> {
    let mut file = VtexFile::blank(Meta::new([1.0; 2], Grid::new([1; 2], 1)));
    file.cells = vec![0];
    let Packed { words, .. } = pack(&file, &PackOptions::default());
    words
}
