//! The spec key against the content it was made for.

use crate::container::issue::{self, Issues};
use crate::container::tag::Tag;
use crate::file::spec::{Features, SpecKey};
use crate::file::texture::VtexFile;

/// The key knows every feature the content needs, and no other that changes lookups.
pub(super) fn spec(file: &VtexFile, issues: &mut Issues) {
    let features = file.spec.features;
    let mut require = |stray: u32, kind| {
        if stray != 0 {
            issues.add(kind, Tag::SPEC, 4, format_args!("bits {stray:#x}"));
        }
    };
    require(features & !Features::ALL, issue::SPEC_FEATURES);
    let needed = SpecKey::features_of(file);
    require(needed & !features, issue::SPEC_FEATURE_MISSING);
    // These two change what a lookup returns, the others only what it costs.
    let sampler = &file.meta.sampler;
    let mask = if sampler.mask { 0 } else { Features::MASK };
    let outline = if sampler.outline.is_some() {
        0
    } else {
        Features::OUTLINE
    };
    require(features & (mask | outline), issue::SPEC_FEATURE_STRAY);
}
