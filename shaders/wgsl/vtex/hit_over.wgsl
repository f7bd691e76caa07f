//!use core/color
//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/answer
//!use vtex/source
// What a point lookup meets where some paints are translucent: front to back, sRGB-encoded, and
// decoded once.

struct VtexHit {
    // The samples that the walk goes on with.
    live: u32,
    // Entries met, and the last of them where it is the only one.
    count: u32,
    only: vec4f,
    // Of all met, premultiplied.
    color: vec4f,
}

fn vtex_hit_start(live: u32) -> VtexHit {
    return VtexHit(live, 0u, vec4f(0.0), vec4f(0.0));
}

fn vtex_hit_draw(
    vt: VtexTexture, lookup: VtexLookup, hit: VtexHit, samples: VtexSamples, covered: u32, head: u32,
) -> VtexHit {
    var next = hit;
    if (covered & hit.live) != 0u {
        let shown = vtex_source(vt, lookup, head, samples.uv);
        if shown.encoded.a > 0.0 {
            next.count += 1u;
            next.only = shown.linear;
            next.color += (1.0 - hit.color.a) * shown.encoded;
            // An opaque image shows nothing, and hides nothing, outside its rectangle.
            let ends = next.color.a >= 1.0 || (head & VTEX_CMD_OPAQUE_BIT) != 0u;
            next.live = select(hit.live, 0u, ends);
        }
    }
    return next;
}

fn vtex_hit_answer(
    vt: VtexTexture, lookup: VtexLookup, hit: VtexHit, samples: VtexSamples,
) -> VtexAnswer {
    // A single one needs no transfer function where its linear light is known.
    if hit.count > 1u || hit.only.a < 0.0 {
        return VtexAnswer(vtex_color_decode_premultiplied(hit.color), VTEX_SAMPLES_EVERY);
    }
    return VtexAnswer(hit.only, VTEX_SAMPLES_EVERY);
}
