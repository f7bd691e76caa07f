//! The key that a loader runs a file with, and the key of the text that serves it.

use vtex_format::{Features, SpecKey, VtexFile};

use crate::layout::FilterMode;
use crate::pack::PackOptions;

/// The key that a loader runs `file` with once the overrides in `options` are applied. With the
/// default ones it is [`SpecKey::for_file`].
pub fn spec_key(file: &VtexFile, options: &PackOptions) -> SpecKey {
    let sampler = options.applied_to(&file.meta.sampler);
    let mut key = SpecKey::for_file(file);
    // Eq. 1 is of distances, which MSDFs alone store.
    let paper = options.filter == FilterMode::Paper && key.features & Features::MSDF != 0;
    // Set or cleared: the caller may override the file's mapping either way, and no file says how
    // lookups filter.
    for (needed, feature) in [
        (sampler.is_mapped(), Features::MAPPING),
        (options.filter == FilterMode::Footprint, Features::FOOTPRINT),
        (paper, Features::PAPER),
    ] {
        key.features &= !feature;
        key.features |= if needed { feature } else { 0 };
    }
    key
}

/// Features that every text has code for, behind a branch on the texture's header: the branches cost
/// less than twice as many texts (docs/decisions/0017).
const ALWAYS: u32 = Features::MIPS | Features::MASK;

/// The key of the text that serves textures of `key`; two keys have the same text where this is the
/// same. Cache pipelines by it.
///
/// Unknown bits are dropped, features that need another are dropped or completed, and features that
/// all texts have are set.
pub fn kernel_key(key: &SpecKey) -> SpecKey {
    const LISTED: u32 =
        Features::MSDF | Features::CURVES | Features::IMAGES | Features::TRANSLUCENT | CONTROLS;
    const CONTROLS: u32 = Features::CLIPS | Features::GROUPS | Features::BLENDS;
    let mut features = key.features & Features::ALL | ALWAYS;
    // Without lists no entry is looked at.
    if features & Features::LISTS == 0 {
        features &= !LISTED;
    }
    // Only groups blend, and a group's text blends in every mode.
    if features & (Features::GROUPS | Features::BLENDS) != 0 {
        features |= Features::GROUPS | Features::BLENDS;
    } else {
        features &= !Features::DEEP_GROUPS;
    }
    // A branch looks at a curve record.
    if features & Features::CLIPS != 0 {
        features |= Features::CURVES;
    }
    // Eq. 1 and 2 are of distances, which MSDFs alone store.
    if features & Features::MSDF == 0 {
        features &= !(Features::OUTLINE | Features::PAPER);
    }
    // The texels of an image may have any alpha.
    if features & Features::IMAGES != 0 {
        features |= Features::TRANSLUCENT;
    }
    SpecKey { features }
}
