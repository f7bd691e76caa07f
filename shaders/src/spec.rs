//! The key that a loader runs a file with, and what keys the linker takes.

use vtex_format::{Features, MAX_ENTRIES_PER_CELL, MAX_FRAMES, SHADER_ABI, SpecKey, VtexFile};

use crate::layout::FilterMode;
use crate::pack::PackOptions;

/// The key of `file` once the overrides in `options` are applied. With the default ones it is
/// [`SpecKey::for_file`].
pub fn spec_key(file: &VtexFile, options: &PackOptions) -> SpecKey {
    let sampler = options.applied_to(&file.meta.sampler);
    let [address_u, address_v] = sampler.address;
    let mut key = SpecKey {
        address_u,
        address_v,
        ..SpecKey::for_file(file)
    };
    // Set or cleared: the caller may override the file's matrix either way, and no file says how
    // lookups filter.
    for (needed, feature) in [
        (sampler.is_transformed(), Features::TEXTURE_MATRIX),
        (options.filter != FilterMode::Point, Features::RAMPS),
    ] {
        key.features &= !feature;
        key.features |= if needed { feature } else { 0 };
    }
    key
}

/// Whether there are lists for the evaluator that keeps frames (docs/decisions/0011).
pub(crate) const fn is_composited(features: u32) -> bool {
    let ramps = features & (Features::RAMPS | Features::OUTLINE) != 0;
    features & Features::GROUPS != 0 || features & Features::CLIPS != 0 && ramps
}

/// `key` with what no evaluator could be made for put right: unknown bits dropped, features that
/// need another dropped or completed, numbers brought into range.
pub(crate) fn normalized(key: &SpecKey) -> SpecKey {
    const LISTED: u32 =
        Features::MSDF | Features::CURVES | Features::IMAGES | Features::TRANSLUCENT | SCOPED;
    const SCOPED: u32 = Features::CLIPS | Features::GROUPS | Features::BLENDS;
    let mut features = key.features & Features::ALL;
    // Without lists no entry is looked at.
    if features & Features::LISTS == 0 {
        features &= !LISTED;
    }
    // Only groups blend.
    if features & Features::BLENDS != 0 {
        features |= Features::GROUPS;
    }
    // A test looks at a curve record.
    if features & Features::CLIPS != 0 {
        features |= Features::CURVES;
    }
    // Without edges there is no ramp across one and no ring around one.
    if features & (Features::MSDF | Features::CURVES) == 0 {
        features &= !(Features::OUTLINE | Features::RAMPS);
    }
    // The texels of an image may have any alpha.
    if features & Features::IMAGES != 0 {
        features |= Features::TRANSLUCENT;
    }
    SpecKey {
        abi: SHADER_ABI,
        features,
        address_u: key.address_u,
        address_v: key.address_v,
        texels_per_cell: key.texels_per_cell.clamp(1, MAX_TEXELS_PER_CELL),
        max_entries: key.max_entries.clamp(1, MAX_ENTRIES_PER_CELL),
        frames: key.frames.clamp(1, MAX_FRAMES),
        reserved: 0,
    }
}

/// Bounds a tile's side so that its texel count stays far inside a `u32`; no reader lets a larger
/// one in.
const MAX_TEXELS_PER_CELL: u32 = 1024;
