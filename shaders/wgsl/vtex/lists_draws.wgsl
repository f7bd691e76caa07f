//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/resolved
//!use vtex/draws
// What a fine cell shows where no list holds groups.

fn vtex_lists(
    vt: VtexTexture, lookup: VtexLookup, word: u32, samples: VtexSamples, live: u32,
) -> VtexResolved {
    return vtex_draws(vt, lookup, word, samples, live);
}
