//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/resolved
//!use vtex/paint
// What a point lookup meets where all paints are opaque: the first entry, whose paint is read last.

struct VtexComposite {
    // The samples that the walk goes on with.
    live: u32,
    shows: bool,
    paint: u32,
}

fn vtex_composite_start(live: u32) -> VtexComposite {
    return VtexComposite(live, false, 0u);
}

fn vtex_composite_draw(
    vt: VtexTexture, lookup: VtexLookup, composite: VtexComposite, samples: VtexSamples,
    covered: u32, tag: u32,
) -> VtexComposite {
    let shows = (covered & composite.live) != 0u;
    let paint = select(composite.paint, tag & VTEX_CMD_INDEX_MASK, shows);
    return VtexComposite(composite.live & ~covered, composite.shows || shows, paint);
}

fn vtex_composite_resolve(
    vt: VtexTexture, lookup: VtexLookup, composite: VtexComposite, samples: VtexSamples,
) -> VtexResolved {
    // Paint 0 where nothing shows, so that no branch is needed.
    let color = vtex_paint_linear(vt, select(0u, composite.paint, composite.shows), samples.uv);
    return VtexResolved(select(vec4f(0.0), color, composite.shows), VTEX_SAMPLES_EVERY);
}
