//! A pool's buffer and pages on the device.

use vtex_shaders::set::{TextureHandle, table};
use vtex_shaders::{Packed, TexelPages};
use wgpu::{
    BindGroup, BindGroupLayout, Buffer, BufferUsages, CommandEncoder, Device, Extent3d, Origin3d,
    Queue, Sampler, Texture, TextureView,
};

use super::space::{Member, Move, Plan, Space};
use super::words::GROUP_BYTES;
use crate::RuntimeError;
use crate::device::{TexelFormat, Uploaded, array_view, empty_buffer, page_array};

/// What a pool binds.
#[derive(Clone, Debug)]
pub(super) struct Memory {
    pub(super) uploaded: Uploaded,
    pub(super) group: BindGroup,
}

/// What is written anew.
pub(super) struct Change<'a> {
    pub(super) plan: &'a Plan,
    pub(super) textures: &'a [Packed],
    /// Their pages as the device is to have them, where that is not as they are packed.
    pub(super) encoded: &'a [Option<Vec<u8>>],
    pub(super) fixed: &'a Fixed,
}

/// What all pools of a set have in common.
#[derive(Clone, Debug)]
pub(super) struct Fixed {
    pub(super) layout: BindGroupLayout,
    pub(super) sampler: Sampler,
    /// What the device has of what was asked for.
    pub(super) texels: TexelFormat,
    /// The words of the texture that shows nothing.
    pub(super) nothing: Vec<u32>,
}

impl Memory {
    /// What the plan needs, with everything in it. What there was before stays as it is, but for room that
    /// nobody has. To be called in [`checked`](crate::device::checked).
    pub(super) fn changed(
        before: Option<&Self>,
        device: &Device,
        queue: &Queue,
        change: &Change<'_>,
    ) -> Result<Self, RuntimeError> {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let uploaded = Uploaded {
            words: words(before, device, &mut encoder, change.plan)?,
            texels: texels(before, device, &mut encoder, change)?,
            sampler: change.fixed.sampler.clone(),
        };
        let memory = match before {
            Some(before) if before.uploaded.binds_the_same(&uploaded) => before.clone(),
            _ => Self::new(device, &change.fixed.layout, uploaded),
        };
        // Before anything is written: writes come ahead of what is submitted next.
        queue.submit([encoder.finish()]);
        memory.write(queue, change);
        Ok(memory)
    }

    fn new(device: &Device, layout: &BindGroupLayout, uploaded: Uploaded) -> Self {
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("vtex pool"),
            layout,
            entries: &uploaded.entries(0),
        });
        Self { uploaded, group }
    }

    fn write(&self, queue: &Queue, change: &Change<'_>) {
        let Plan {
            space,
            added,
            moves,
        } = change.plan;
        if moves.is_some() {
            self.write_words(queue, 0, &table_words(space));
            self.write_words(queue, space.nothing_word(), &change.fixed.nothing);
        }
        for &(index, handle) in added {
            let texture = &change.textures[index];
            if let Some(member) = space.handles.get(handle) {
                self.write_words(queue, 4 * space.first_group(member), &texture.words);
                let encoded = change.encoded.get(index).and_then(Option::as_deref);
                let data = encoded.unwrap_or(texture.texels.bytes());
                self.write_rooms(queue, member, (&texture.texels, data), change.fixed.texels);
                if moves.is_none() {
                    self.write_entry(queue, space, handle);
                }
            }
        }
    }

    /// The entry of a handle, whether a texture has it or has it no more.
    pub(super) fn write_entry(&self, queue: &Queue, space: &Space, handle: TextureHandle) {
        let word = table::ENTRIES + table::ENTRY_WORDS * handle.slot();
        self.write_words(queue, word, &entry(space, handle));
    }

    fn write_words(&self, queue: &Queue, first: u32, words: &[u32]) {
        let bytes = bytemuck::cast_slice(words);
        queue.write_buffer(&self.uploaded.words, 4 * u64::from(first), bytes);
    }

    fn write_rooms(
        &self,
        queue: &Queue,
        member: &Member,
        (texels, data): (&TexelPages, &[u8]),
        format: TexelFormat,
    ) {
        let [width, height] = texels.size();
        for (page, room) in (0..).zip(&member.rooms) {
            let [x, y] = room.place.corner;
            let z = room.place.page;
            let to = wgpu::TexelCopyTextureInfo {
                origin: Origin3d { x, y, z },
                ..self.uploaded.texels.texture().as_image_copy()
            };
            let extent = Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            };
            queue.write_texture(to, data, format.layout(texels, page), extent);
        }
    }
}

/// The buffer that there is or, where the plan needs one, a new one with what is kept.
fn words(
    before: Option<&Memory>,
    device: &Device,
    encoder: &mut CommandEncoder,
    plan: &Plan,
) -> Result<Buffer, RuntimeError> {
    let moves = match (before, &plan.moves) {
        (Some(before), None) => return Ok(before.uploaded.words.clone()),
        (_, moves) => moves.iter().flatten(),
    };
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
    let buffer = empty_buffer(device, "vtex pool", plan.space.buffer_bytes(), usage)?;
    for (&Move { from, to, groups }, before) in moves.zip(before.into_iter().cycle()) {
        let [from, to, size] = [from, to, groups].map(|at| GROUP_BYTES * u64::from(at));
        encoder.copy_buffer_to_buffer(&before.uploaded.words, from, &buffer, to, size);
    }
    Ok(buffer)
}

/// The pages that there are or, where the space needs them, more and larger ones with what is kept.
fn texels(
    before: Option<&Memory>,
    device: &Device,
    encoder: &mut CommandEncoder,
    change: &Change<'_>,
) -> Result<TextureView, RuntimeError> {
    let (space, format) = (&change.plan.space, change.fixed.texels);
    // One block is bound where there is nothing to sample.
    let size = space.pages.size().map(|side| side.max(4));
    let count = space.pages.held().max(1);
    let Some(before) = before else {
        return Ok(array_view(&page_array(device, size, count, format)?));
    };
    let view = &before.uploaded.texels;
    let old = view.texture();
    if [old.width(), old.height(), old.depth_or_array_layers()] == [size[0], size[1], count] {
        return Ok(view.clone());
    }
    let texture = page_array(device, size, count, format)?;
    let [from, to] = [old, &texture].map(Texture::as_image_copy);
    encoder.copy_texture_to_texture(from, to, old.size());
    Ok(array_view(&texture))
}

/// The whole table.
fn table_words(space: &Space) -> Vec<u32> {
    let mut words = vec![0; space.nothing_word() as usize];
    words[table::COUNT as usize] = space.entries;
    words[table::NOTHING as usize] = space.nothing_word();
    words[table::POOL as usize] = space.handles.pool();
    let entries = words[table::ENTRIES as usize..].chunks_exact_mut(table::ENTRY_WORDS as usize);
    for entry in entries {
        entry[1] = space.nothing_word();
    }
    for (handle, _) in space.handles.iter() {
        let first = table::ENTRIES + table::ENTRY_WORDS * handle.slot();
        words[first as usize..][..table::ENTRY_WORDS as usize]
            .copy_from_slice(&entry(space, handle));
    }
    words
}

/// An entry without a texture leads to the one that shows nothing, also for the handle of zeros.
fn entry(space: &Space, handle: TextureHandle) -> [u32; table::ENTRY_WORDS as usize] {
    space.handles.get(handle).map_or_else(
        || [0, space.nothing_word()],
        |member| [handle.to_bits(), 4 * space.first_group(member)],
    )
}
