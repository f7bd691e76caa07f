//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/resolved
//!use vtex/paint
// What the samples of a footprint meet where all paints are opaque. A walk ends where its samples
// meet a third entry; those that the first two do not cover take another walk. So paints are read
// once behind the walk and not at each of its commands, which costs all lanes that walk with a
// longer one.

struct VtexComposite {
    // The samples that the walk goes on with.
    live: u32,
    // Those that see a paint, and which; then those that see another.
    first: u32,
    first_paint: u32,
    second: u32,
    second_paint: u32,
}

fn vtex_composite_start(live: u32) -> VtexComposite {
    return VtexComposite(live, 0u, 0u, 0u, 0u);
}

fn vtex_composite_draw(
    vt: VtexTexture, lookup: VtexLookup, composite: VtexComposite, samples: VtexSamples,
    covered: u32, tag: u32,
) -> VtexComposite {
    let met = covered & composite.live;
    let paint = tag & VTEX_CMD_INDEX_MASK;
    let first = met != 0u && composite.first == 0u;
    let second = met != 0u && !first && composite.second == 0u;
    let third = met != 0u && !first && !second;
    return VtexComposite(
        select(composite.live & ~met, 0u, third),
        select(composite.first, met, first),
        select(composite.first_paint, paint, first),
        select(composite.second, met, second),
        select(composite.second_paint, paint, second),
    );
}

// Those that nothing covers see nothing.
fn vtex_composite_resolve(
    vt: VtexTexture, lookup: VtexLookup, composite: VtexComposite, samples: VtexSamples,
) -> VtexResolved {
    var sum = vec4f(0.0);
    var mask = composite.first;
    var paint = composite.first_paint;
    for (var i = 0u; i < 2u; i += 1u) {
        let color = vtex_paint_linear(vt, paint, vtex_samples_uv(samples, mask));
        sum += vtex_resolved_count(mask) * color;
        mask = composite.second;
        paint = composite.second_paint;
        if mask == 0u {
            break;
        }
    }
    return VtexResolved(sum, composite.first | composite.second | composite.live);
}
