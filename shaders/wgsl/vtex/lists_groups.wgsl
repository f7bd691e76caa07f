//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/resolved
//!use vtex/draws
//!use vtex/groups
// What a fine cell shows where some lists hold groups.

fn vtex_lists(
    vt: VtexTexture, lookup: VtexLookup, word: u32, samples: VtexSamples, live: u32,
) -> VtexResolved {
    if (word >> VTEX_CELL_TAG_SHIFT) == VTEX_CELL_GROUPS {
        return vtex_groups(vt, lookup, word, samples, live);
    }
    return vtex_draws(vt, lookup, word, samples, live);
}
