//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/resolved
//!use vtex/walk
// What a list without groups shows.

fn vtex_draws(
    vt: VtexTexture, lookup: VtexLookup, word: u32, samples: VtexSamples, live: u32,
) -> VtexResolved {
    return vtex_walk(vt, lookup, word, samples, live);
}
