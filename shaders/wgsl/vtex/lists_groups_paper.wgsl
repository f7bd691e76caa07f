//!use core/layout
//!use vtex/texture
//!use vtex/settings
//!use vtex/lookup
//!use vtex/samples
//!use vtex/answer
//!use vtex/walk
//!use vtex/paper
//!use vtex/groups
// What a fine cell shows where some lists hold groups, in paper mode.

fn vtex_lists(
    vt: VtexTexture, lookup: VtexLookup, word: u32, samples: VtexSamples, live: u32,
) -> VtexAnswer {
    if (word >> VTEX_CELL_TAG_SHIFT) == VTEX_CELL_GROUPS {
        return vtex_groups(vt, lookup, word, samples, live);
    }
    let list = (word >> VTEX_CELL_TAG_SHIFT) == VTEX_CELL_LIST;
    if list && vtex_settings_has(vt, VTEX_FEATURE_PAPER) {
        let answer = vtex_paper(vt, lookup, word, samples, live);
        return vtex_answer(answer.sum, live);
    }
    return vtex_walk(vt, lookup, word, samples, live);
}
