//! Many textures in one buffer, by handle: the table ahead of them, and the texts that read it.
//!
//! | words of the buffer | hold |
//! |---|---|
//! | 0 to 3 | [`table::COUNT`], [`table::NOTHING`], zeros |
//! | from [`table::ENTRIES`] on | entries of [`table::ENTRY_WORDS`]: a handle, and the first word of its texture |
//! | behind them, anywhere | packed textures, each from a multiple of four on |
//!
//! No file holds any of this, so it can change without a new shader ABI.

mod query;

use vtex_format::{Features, SpecKey};

use crate::layout::FilterMode;
use crate::specialize::{BindingSlot, linked, scene_context};

pub use query::{MAX_GENERATION, TEXTURE_QUERY, TextureHandle, TextureQuery};

/// Where the table is and what it holds.
pub mod table {
    /// Word: entries in the table.
    pub const COUNT: u32 = 0;
    /// Word: the first word of a texture that shows nothing, for handles that no texture has.
    pub const NOTHING: u32 = 1;
    /// First word of the first entry.
    pub const ENTRIES: u32 = 4;
    /// Words of an entry: the handle, and the first word of its texture.
    pub const ENTRY_WORDS: u32 = 2;
    /// Bits of a handle that are its entry's index; the others count the textures that had the entry.
    pub const SLOT_MASK: u32 = 0xfffff;
}

/// Every constant of `wgsl/core/set.wgsl` by its name there; a test compares them through naga.
pub const CONSTANTS: &[(&str, u32)] = &[
    ("VTEX_SET_COUNT", table::COUNT),
    ("VTEX_SET_NOTHING", table::NOTHING),
    ("VTEX_SET_ENTRIES", table::ENTRIES),
    ("VTEX_SET_ENTRY_WORDS", table::ENTRY_WORDS),
    ("VTEX_SET_SLOT_MASK", table::SLOT_MASK),
];

/// WGSL with `fn vtex_sample(handle: u32, uv: vec2f, footprint: vec4f) -> vec4f` for the textures of a
/// set, bound from `slot` on as in [`fragment`](crate::fragment). A handle that no texture has gives
/// nothing: transparent black.
///
/// `features` is the union of the textures' [`SpecKey::features`].
pub fn set_fragment(features: u32, slot: BindingSlot) -> String {
    linked("root/set", &scene_context(features, slot))
}

/// WGSL of the kernel that answers a queue, entry point `vtex_queue`, for textures with these features.
///
/// Group 0: binding 0 the queries, an array of [`TextureQuery`]; binding 1 their number, a `u32`;
/// binding 2 the results, an array of `vec4f`. Group 1: the set as in [`set_fragment`]. It is dispatched
/// with the arguments that [`queue_arguments_kernel`] writes. Queries from the number on, or beyond
/// either array's end, are passed over.
pub fn queue_kernel(features: u32) -> String {
    let slot = BindingSlot {
        group: 1,
        binding: 0,
    };
    linked("root/queue_lookups", &scene_context(features, slot))
}

/// WGSL of the kernel that makes dispatch arguments of a queue's length, entry point
/// `vtex_queue_arguments`, one workgroup. It depends on nothing.
///
/// Group 0 is that of [`queue_kernel`]. Group 1, binding 0: the arguments, `array<u32, 3>`.
pub fn queue_arguments_kernel() -> String {
    linked("root/queue_arguments", &crate::LinkContext::default())
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
    use crate::specialize::{BATCH_WORKGROUP, MAX_WORKGROUPS};

    #[test]
    fn texts_are_those_of_the_key() {
        let slot = BindingSlot::default();
        let all = every_feature(FilterMode::Footprint);
        for features in [0, Features::LISTS, all] {
            let key = set_key(features).features;
            assert_eq!(set_fragment(features, slot), set_fragment(key, slot));
            assert_eq!(queue_kernel(features), queue_kernel(key));
        }
        assert!(set_fragment(all, slot).contains("fn vtex_sample(handle: u32"));
    }

    #[test]
    fn the_arguments_kernel_counts_as_the_host_does() {
        let text = queue_arguments_kernel();
        assert!(text.contains(&format!("VTEX_QUEUE_WORKGROUP: u32 = {BATCH_WORKGROUP}u;")));
        assert!(text.contains(&format!("VTEX_QUEUE_GROUPS: u32 = {MAX_WORKGROUPS}u;")));
        let kernel = queue_kernel(0);
        assert!(kernel.contains(&format!("@workgroup_size({BATCH_WORKGROUP})")));
    }
}
