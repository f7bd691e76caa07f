//!use core/layout
//!use vtex/texture
//!use vtex/settings
//!use vtex/lookup
//!use vtex/samples
//!use vtex/resolved
//!use vtex/walk
//!use vtex/paper
// What a list without groups shows, in paper mode.

fn vtex_draws(
    vt: VtexTexture, lookup: VtexLookup, word: u32, samples: VtexSamples, live: u32,
) -> VtexResolved {
    let list = (word >> VTEX_CELL_TAG_SHIFT) == VTEX_CELL_LIST;
    if list && vtex_settings_has(vt, VTEX_FEATURE_PAPER) {
        return vtex_paper(vt, lookup, word, samples, live);
    }
    return vtex_walk(vt, lookup, word, samples, live);
}
