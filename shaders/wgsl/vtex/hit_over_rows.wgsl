//!use core/color
//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/answer
//!use vtex/source
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

struct VtexHit {
    // The samples that the walk goes on with, and what they have met.
    live: u32,
    seen: VtexSeen,
    // Those that the walk has ended for, which have met the same.
    last: u32,
    // Those behind an opaque entry that did not cover all, and what they have met.
    first: u32,
    first_seen: VtexSeen,
}

fn vtex_hit_start(live: u32) -> VtexHit {
    return VtexHit(live, VtexSeen(), 0u, 0u, VtexSeen());
}

fn vtex_hit_draw(
    vt: VtexTexture, lookup: VtexLookup, hit: VtexHit, samples: VtexSamples, covered: u32, head: u32,
) -> VtexHit {
    let met = covered & hit.live;
    if met == 0u {
        return hit;
    }
    let shown = vtex_source(vt, lookup, head, vtex_samples_uv(samples, met));
    var seen = hit.seen;
    if shown.encoded.a > 0.0 {
        seen.count += 1u;
        seen.only = shown.linear;
        seen.color += (1.0 - hit.seen.color.a) * shown.encoded;
    }
    var next = hit;
    let leads = (met & (~hit.live + 1u)) != 0u;
    // An opaque image shows nothing, and hides nothing, outside its rectangle.
    let opaque = (head & VTEX_CMD_OPAQUE_BIT) != 0u && shown.encoded.a > 0.0;
    if opaque || (leads && seen.color.a >= 1.0) {
        if met == hit.live {
            next.live = 0u;
            next.last = met;
            next.seen = seen;
        } else if hit.first == 0u {
            next.first = met;
            next.first_seen = seen;
            // One that is not opaque has parted the samples.
            next.live = select(0u, hit.live & ~met, opaque);
        } else {
            next.live = 0u;
        }
    } else if leads {
        next.live = met;
        next.seen = seen;
    } else {
        next.live = hit.live & ~met;
    }
    return next;
}

// The samples left have met nothing more.
fn vtex_hit_answer(
    vt: VtexTexture, lookup: VtexLookup, hit: VtexHit, samples: VtexSamples,
) -> VtexAnswer {
    let last = hit.live | hit.last;
    var mask = last;
    var seen = hit.seen;
    var sum = vec4f(0.0);
    for (var i = 0u; i < 2u; i += 1u) {
        // A single entry needs no transfer function where its linear light is known.
        var value = seen.only;
        if seen.count > 1u || seen.only.a < 0.0 {
            value = vtex_color_decode_premultiplied(seen.color);
        }
        sum += vtex_answer_count(mask) * value;
        mask = hit.first;
        seen = hit.first_seen;
        if mask == 0u {
            break;
        }
    }
    return VtexAnswer(sum, last | hit.first);
}
