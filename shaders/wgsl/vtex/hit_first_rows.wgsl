//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/answer
//!use vtex/paint
// What the samples of a footprint meet where all paints are opaque. A walk ends where its samples
// meet a third entry; those that the first two do not cover take another walk. So paints are read
// once behind the walk and not at each of its commands, which costs all lanes that walk with a longer
// one.

struct VtexHit {
    // The samples that the walk goes on with.
    live: u32,
    // Those that see a paint, and which; then those that see another.
    first: u32,
    first_paint: u32,
    second: u32,
    second_paint: u32,
}

fn vtex_hit_start(live: u32) -> VtexHit {
    return VtexHit(live, 0u, 0u, 0u, 0u);
}

fn vtex_hit_draw(
    vt: VtexTexture, lookup: VtexLookup, hit: VtexHit, samples: VtexSamples, covered: u32, head: u32,
) -> VtexHit {
    let met = covered & hit.live;
    let paint = head & VTEX_CMD_INDEX_MASK;
    let first = met != 0u && hit.first == 0u;
    let second = met != 0u && !first && hit.second == 0u;
    let third = met != 0u && !first && !second;
    return VtexHit(
        select(hit.live & ~met, 0u, third),
        select(hit.first, met, first),
        select(hit.first_paint, paint, first),
        select(hit.second, met, second),
        select(hit.second_paint, paint, second),
    );
}

// Those that nothing covers see nothing.
fn vtex_hit_answer(
    vt: VtexTexture, lookup: VtexLookup, hit: VtexHit, samples: VtexSamples,
) -> VtexAnswer {
    var sum = vec4f(0.0);
    var mask = hit.first;
    var paint = hit.first_paint;
    for (var i = 0u; i < 2u; i += 1u) {
        let color = vtex_paint_linear(vt, paint, vtex_samples_uv(samples, mask));
        sum += vtex_answer_count(mask) * color;
        mask = hit.second;
        paint = hit.second_paint;
        if mask == 0u {
            break;
        }
    }
    return VtexAnswer(sum, hit.first | hit.second | hit.live);
}
