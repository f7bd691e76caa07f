//! The spec key against what it was made for.

use super::cells::Bounds;
use crate::container::issue::{self, Issues};
use crate::container::tag::Tag;
use crate::file::spec::{Features, SHADER_ABI, SpecKey};
use crate::file::texture::VtexFile;

/// The key is of this ABI, knows every feature the content needs, and repeats META rightly.
pub(super) fn spec(file: &VtexFile, bounds: Bounds, issues: &mut Issues) {
    let SpecKey {
        abi,
        features,
        address_u,
        address_v,
        texels_per_cell,
        ..
    } = file.spec;
    let mut require = |holds: bool, kind, field: u64, message: std::fmt::Arguments<'_>| {
        if !holds {
            issues.add(kind, Tag::SPEC, field, message);
        }
    };
    require(
        abi == SHADER_ABI,
        issue::SPEC_ABI,
        0,
        format_args!("{abi}, not {SHADER_ABI}"),
    );
    let unknown = features & !Features::ALL;
    require(
        unknown == 0,
        issue::SPEC_FEATURES,
        4,
        format_args!("bits {unknown:#x}"),
    );
    let needed = SpecKey::features_of(file);
    let missing = needed & !features;
    require(
        missing == 0,
        issue::SPEC_FEATURE_MISSING,
        4,
        format_args!("bits {missing:#x}"),
    );
    // These two change what a lookup returns, the others only what it costs.
    let sampler = &file.meta.sampler;
    let mask = if sampler.mask { 0 } else { Features::MASK };
    let outline = if sampler.outline.is_some() {
        0
    } else {
        Features::OUTLINE
    };
    let stray = features & (mask | outline);
    require(
        stray == 0,
        issue::SPEC_FEATURE_STRAY,
        4,
        format_args!("bits {stray:#x}"),
    );
    let same = sampler.address == [address_u, address_v];
    require(
        same,
        issue::SPEC_ADDRESS,
        8,
        format_args!("{}, {}", address_u as u32, address_v as u32),
    );
    let texels = file.meta.grid.texels_per_cell;
    let same = texels == texels_per_cell;
    require(
        same,
        issue::SPEC_TEXELS,
        16,
        format_args!("{texels_per_cell}, not {texels}"),
    );
    self::bounds(&file.spec, bounds, issues);
}

/// The key's bounds are those of the lists.
fn bounds(key: &SpecKey, lists: Bounds, issues: &mut Issues) {
    let mut require = |found: u32, expected: u32, kind, field: u64| {
        if found != expected {
            let message = format_args!("{found}, not {expected}");
            issues.add(kind, Tag::SPEC, field, message);
        }
    };
    require(key.max_entries, lists.longest, issue::SPEC_ENTRIES, 20);
    require(key.frames, lists.frames, issue::SPEC_FRAMES, 24);
    require(key.reserved, 0, issue::SPEC_RESERVED, 28);
}
