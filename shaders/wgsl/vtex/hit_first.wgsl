//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/answer
//!use vtex/paint
// What a point lookup meets where all paints are opaque: the first entry, whose paint is read last.

struct VtexHit {
    // The samples that the walk goes on with.
    live: u32,
    shows: bool,
    paint: u32,
}

fn vtex_hit_start(live: u32) -> VtexHit {
    return VtexHit(live, false, 0u);
}

fn vtex_hit_draw(
    vt: VtexTexture, lookup: VtexLookup, hit: VtexHit, samples: VtexSamples, covered: u32, head: u32,
) -> VtexHit {
    let shows = (covered & hit.live) != 0u;
    let paint = select(hit.paint, head & VTEX_CMD_INDEX_MASK, shows);
    return VtexHit(hit.live & ~covered, hit.shows || shows, paint);
}

fn vtex_hit_answer(
    vt: VtexTexture, lookup: VtexLookup, hit: VtexHit, samples: VtexSamples,
) -> VtexAnswer {
    // Paint 0 where nothing shows, so that no branch is needed.
    let color = vtex_paint_linear(vt, select(0u, hit.paint, hit.shows), samples.uv);
    return VtexAnswer(select(vec4f(0.0), color, hit.shows), VTEX_SAMPLES_EVERY);
}
