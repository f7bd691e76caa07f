//! What a shader or a host asks of a set.

use super::table::{POOL_MASK, POOL_SHIFT, SLOT_MASK};
use crate::gpu_record;
use crate::layout::RecordLayout;

/// Names a texture of a set: the `handle` of `vtex_sample(handle, uv, footprint)`.
///
/// No two textures of a set ever have the same one, so that a handle whose texture was removed shows
/// nothing, and never another texture.
#[repr(transparent)]
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    bytemuck::Pod,
    bytemuck::Zeroable,
)]
pub struct TextureHandle(u32);

impl TextureHandle {
    /// Of no texture, in any set. Its bits are zero, as is memory that nobody wrote.
    pub const NONE: Self = Self(0);

    /// What a shader passes to `vtex_sample`.
    pub const fn to_bits(self) -> u32 {
        self.0
    }

    /// A handle from what a shader has. Any bits are safe to look up.
    pub const fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    /// That of the `generation`th texture in entry `slot` of a pool's table, counted from 1.
    pub const fn new(pool: u32, slot: u32, generation: u32) -> Self {
        Self(slot & SLOT_MASK | (pool & POOL_MASK) << POOL_SHIFT | generation << GENERATION_SHIFT)
    }

    /// Its pool of the set, counted from 0.
    pub const fn pool(self) -> u32 {
        self.0 >> POOL_SHIFT & POOL_MASK
    }

    /// Its entry of the pool's table.
    pub const fn slot(self) -> u32 {
        self.0 & SLOT_MASK
    }
}

const GENERATION_SHIFT: u32 = POOL_SHIFT + POOL_MASK.count_ones();

/// How many pools a set can have: what a handle has bits for.
pub const MAX_POOLS: u32 = POOL_MASK + 1;

/// How many textures one entry of the table can have after each other.
pub const MAX_GENERATION: u32 = u32::MAX >> GENERATION_SHIFT;

/// One query of a queue, 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TextureQuery {
    /// Point in uv before texture matrix and address mode.
    pub uv: [f32; 2],
    /// Which texture of the set.
    pub handle: TextureHandle,
    /// Not read: a number of the caller's, such as the path that asks.
    pub user: u32,
    /// Two axes of the filter region, `axis0.u, axis0.v, axis1.u, axis1.v`, full extents in uv.
    pub footprint: [f32; 4],
}

/// [`TextureQuery`] as `wgsl/core/set.wgsl` has it.
pub const TEXTURE_QUERY: RecordLayout =
    gpu_record!(TextureQuery as "VtexTextureQuery" { uv, handle, user, footprint });

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_handle_is_a_pool_an_entry_and_a_count() {
        let last = TextureHandle::new(MAX_POOLS - 1, SLOT_MASK, MAX_GENERATION);
        assert_eq!(last.to_bits(), u32::MAX);
        assert_eq!((last.pool(), last.slot()), (MAX_POOLS - 1, SLOT_MASK));
        let first = TextureHandle::new(0, 0, 1);
        assert_eq!((first.pool(), first.slot()), (0, 0));
        assert_ne!(first, TextureHandle::NONE);
        let handle = TextureHandle::new(3, 5, 7);
        assert_eq!((handle.pool(), handle.slot()), (3, 5));
    }
}
