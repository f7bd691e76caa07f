//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/resolved
//!use vtex/paint
// What a fine cell shows where none has a list.

fn vtex_lists(
    vt: VtexTexture, lookup: VtexLookup, word: u32, samples: VtexSamples, live: u32,
) -> VtexResolved {
    let solid = (word >> VTEX_CELL_TAG_SHIFT) == VTEX_CELL_SOLID;
    // Paint 0 where nothing shows, so that no branch is needed.
    let paint = select(0u, word & VTEX_CELL_PAINT_MASK, solid);
    let color = vtex_paint_linear(vt, paint, vtex_samples_uv(samples, live));
    return vtex_resolved(select(vec4f(0.0), color, solid), live);
}
