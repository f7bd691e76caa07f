//! The shader key against what it was made for.

use super::cells::Bounds;
use crate::issue::{self, Issues};
use crate::spec::{Features, SHADER_ABI, SpecKey};
use crate::{Tag, VtexFile};

/// The key is of this ABI, knows every feature the content needs, and repeats META rightly.
pub(super) fn spec(file: &VtexFile, bounds: Bounds, issues: &mut Issues) {
    let SpecKey {
        abi,
        features,
        address_u,
        address_v,
        texels_per_cell,
        max_entries,
        frames,
        reserved,
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
    let address = sampler.address.map(|mode| mode as u32);
    let same = address == [address_u, address_v];
    require(
        same,
        issue::SPEC_ADDRESS,
        8,
        format_args!("{address_u}, {address_v}"),
    );
    let texels = file.meta.grid.texels_per_cell;
    let same = texels == texels_per_cell;
    require(
        same,
        issue::SPEC_TEXELS,
        16,
        format_args!("{texels_per_cell}, not {texels}"),
    );
    let longest = bounds.longest;
    let same = max_entries == longest;
    require(
        same,
        issue::SPEC_ENTRIES,
        20,
        format_args!("{max_entries}, not {longest}"),
    );
    let deepest = bounds.frames;
    require(
        frames == deepest,
        issue::SPEC_FRAMES,
        24,
        format_args!("{frames}, not {deepest}"),
    );
    require(
        reserved == 0,
        issue::SPEC_RESERVED,
        28,
        format_args!("not zero"),
    );
}
