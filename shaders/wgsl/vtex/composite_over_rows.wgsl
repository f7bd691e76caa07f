//!use core/color
//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/resolved
//!use vtex/brush
// What the samples of a footprint meet where some paints are translucent: front to back,
// sRGB-encoded. A walk ends where an opaque entry covers some of its samples for a second time and
// not all that are left; these take another walk. So colours are decoded once behind the walk.

// What samples have met.
struct VtexSeen {
    // Entries, and the last of them where it is the only one.
    count: u32,
    only: vec4f,
    // Of all met, premultiplied.
    color: vec4f,
}

struct VtexComposite {
    // The samples that the walk goes on with, and what they have met.
    live: u32,
    seen: VtexSeen,
    // Those that the walk has ended for, which have met the same.
    last: u32,
    // Those behind an opaque entry that did not cover all, and what they have met.
    first: u32,
    first_seen: VtexSeen,
}

fn vtex_composite_start(live: u32) -> VtexComposite {
    return VtexComposite(live, VtexSeen(), 0u, 0u, VtexSeen());
}

fn vtex_composite_draw(
    vt: VtexTexture, lookup: VtexLookup, composite: VtexComposite, samples: VtexSamples,
    covered: u32, tag: u32,
) -> VtexComposite {
    let met = vtex_brush_covered(vt, samples, tag, covered & composite.live);
    if met == 0u {
        return composite;
    }
    let brush = vtex_brush(vt, lookup, tag, vtex_samples_uv(samples, met));
    var seen = composite.seen;
    if brush.encoded.a > 0.0 {
        seen.count += 1u;
        seen.only = brush.linear;
        seen.color += (1.0 - composite.seen.color.a) * brush.encoded;
    }
    var next = composite;
    let leads = (met & (~composite.live + 1u)) != 0u;
    let opaque = (tag & VTEX_CMD_OPAQUE_BIT) != 0u;
    if opaque || (leads && seen.color.a >= 1.0) {
        if met == composite.live {
            next.live = 0u;
            next.last = met;
            next.seen = seen;
        } else if composite.first == 0u {
            next.first = met;
            next.first_seen = seen;
            // One that is not opaque has parted the samples.
            next.live = select(0u, composite.live & ~met, opaque);
        } else {
            next.live = 0u;
        }
    } else if leads {
        next.live = met;
        next.seen = seen;
    } else {
        next.live = composite.live & ~met;
    }
    return next;
}

// The samples left have met nothing more.
fn vtex_composite_resolve(
    vt: VtexTexture, lookup: VtexLookup, composite: VtexComposite, samples: VtexSamples,
) -> VtexResolved {
    let last = composite.live | composite.last;
    var mask = last;
    var seen = composite.seen;
    var sum = vec4f(0.0);
    for (var i = 0u; i < 2u; i += 1u) {
        // A single entry needs no transfer function where its linear light is known.
        var value = seen.only;
        if seen.count > 1u || seen.only.a < 0.0 {
            value = vtex_color_decode_premultiplied(seen.color);
        }
        sum += vtex_resolved_count(mask) * value;
        mask = composite.first;
        seen = composite.first_seen;
        if mask == 0u {
            break;
        }
    }
    return VtexResolved(sum, last | composite.first);
}
