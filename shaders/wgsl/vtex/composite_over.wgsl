//!use core/color
//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/resolved
//!use vtex/brush
// What a point lookup meets where some paints are translucent: front to back, sRGB-encoded, and
// decoded once.

struct VtexComposite {
    // The samples that the walk goes on with.
    live: u32,
    // Entries met, and the last of them where it is the only one.
    count: u32,
    only: vec4f,
    // Of all met, premultiplied.
    color: vec4f,
}

fn vtex_composite_start(live: u32) -> VtexComposite {
    return VtexComposite(live, 0u, vec4f(0.0), vec4f(0.0));
}

fn vtex_composite_draw(
    vt: VtexTexture, lookup: VtexLookup, composite: VtexComposite, samples: VtexSamples,
    covered: u32, tag: u32,
) -> VtexComposite {
    var next = composite;
    if vtex_brush_covered(vt, samples, tag, covered & composite.live) != 0u {
        let brush = vtex_brush(vt, lookup, tag, samples.uv);
        if brush.encoded.a > 0.0 {
            next.count += 1u;
            next.only = brush.linear;
            next.color += (1.0 - composite.color.a) * brush.encoded;
            let ends = next.color.a >= 1.0 || (tag & VTEX_CMD_OPAQUE_BIT) != 0u;
            next.live = select(composite.live, 0u, ends);
        }
    }
    return next;
}

fn vtex_composite_resolve(
    vt: VtexTexture, lookup: VtexLookup, composite: VtexComposite, samples: VtexSamples,
) -> VtexResolved {
    // A single one needs no transfer function where its linear light is known.
    if composite.count > 1u || composite.only.a < 0.0 {
        return VtexResolved(vtex_color_decode_premultiplied(composite.color), VTEX_SAMPLES_EVERY);
    }
    return VtexResolved(composite.only, VTEX_SAMPLES_EVERY);
}
