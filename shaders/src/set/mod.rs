//! Many textures by handle: pools of them in one buffer each, the table ahead, and the texts that read it.
//!
//! | words of the buffer | hold |
//! |---|---|
//! | 0 to 3 | [`table::COUNT`], [`table::NOTHING`], [`table::POOL`], a zero |
//! | from [`table::ENTRIES`] on | entries of [`table::ENTRY_WORDS`]: a handle, and the first word of its texture |
//! | behind them, anywhere | packed textures, each from a multiple of four on |
//!
//! No file holds any of this, so it can change without a new shader ABI.

mod query;
mod queue;

use vtex_format::{Features, SpecKey};

use crate::layout::FilterMode;
use crate::specialize::{BindingSlot, linked, scene_context};

pub use query::{MAX_GENERATION, MAX_POOLS, TEXTURE_QUERY, TextureHandle, TextureQuery};
pub use queue::{
    QUEUE_PART, QUEUE_TALLIES, QueuePart, queue_arguments_kernel, queue_kernel,
    queue_order_kernels, queue_pool_kernel,
};

/// Where the table is and what it holds.
pub mod table {
    /// Word: entries in the table.
    pub const COUNT: u32 = 0;
    /// Word: the first word of a texture that shows nothing, for handles that no texture has.
    pub const NOTHING: u32 = 1;
    /// Word: which pool of its set this is.
    pub const POOL: u32 = 2;
    /// First word of the first entry.
    pub const ENTRIES: u32 = 4;
    /// Words of an entry: the handle, and the first word of its texture.
    pub const ENTRY_WORDS: u32 = 2;
    /// Bits of a handle that are its entry's index in the table of its pool.
    pub const SLOT_MASK: u32 = 0xffff;
    /// From this bit of a handle on there is its pool, and behind it a count of the textures that had the
    /// entry.
    pub const POOL_SHIFT: u32 = SLOT_MASK.count_ones();
    /// Of the bits from there on those that are the pool.
    pub const POOL_MASK: u32 = 0x1f;
}

/// Every constant of `wgsl/core/set.wgsl` by its name there; a test compares them through naga.
pub const CONSTANTS: &[(&str, u32)] = &[
    ("VTEX_SET_COUNT", table::COUNT),
    ("VTEX_SET_NOTHING", table::NOTHING),
    ("VTEX_SET_POOL", table::POOL),
    ("VTEX_SET_ENTRIES", table::ENTRIES),
    ("VTEX_SET_ENTRY_WORDS", table::ENTRY_WORDS),
    ("VTEX_SET_SLOT_MASK", table::SLOT_MASK),
    ("VTEX_SET_POOL_SHIFT", table::POOL_SHIFT),
    ("VTEX_SET_POOL_MASK", table::POOL_MASK),
];

/// WGSL with `fn vtex_sample(handle: u32, uv: vec2f, footprint: vec4f) -> vec4f` for the textures of a
/// pool, bound from `slot` on as in [`fragment`](crate::fragment). A handle that no texture of the pool has
/// gives nothing: transparent black.
///
/// `features` is the union of the textures' [`SpecKey::features`].
pub fn set_fragment(features: u32, slot: BindingSlot) -> String {
    linked("root/set", &scene_context(features, slot))
}

/// The features of a text that serves every texture in one filter mode.
pub fn every_feature(filter: FilterMode) -> u32 {
    let modes = match filter {
        FilterMode::Point => 0,
        FilterMode::Footprint => Features::FOOTPRINT,
        FilterMode::Paper => Features::PAPER,
    };
    Features::ALL & !(Features::FOOTPRINT | Features::PAPER) | modes
}

/// The key of the text that serves textures with these features together.
pub fn set_key(features: u32) -> SpecKey {
    crate::kernel_key(&SpecKey { features })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_those_of_the_key() {
        let slot = BindingSlot::default();
        let all = every_feature(FilterMode::Footprint);
        for features in [0, Features::LISTS, all] {
            let key = set_key(features).features;
            assert_eq!(set_fragment(features, slot), set_fragment(key, slot));
            assert_eq!(queue_kernel(features), queue_kernel(key));
            assert_eq!(queue_pool_kernel(features), queue_pool_kernel(key));
        }
        assert!(set_fragment(all, slot).contains("fn vtex_sample(handle: u32"));
    }
}
