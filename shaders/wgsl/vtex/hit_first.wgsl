//!use core/layout
//!use vtex/footprint
//!use vtex/fill
// What hits of a walk show where all paints are opaque: the first one, whose paint is read last.

struct VtexHit {
    shows: bool,
    paint: u32,
}

fn vtex_hit_solid(vt: VtexTexture, shows: bool, paint: u32, lookup: VtexLookup) -> VtexHit {
    return VtexHit(shows, paint);
}

// Takes in an entry that `covers` the lookup or not; whether what lies behind it can show.
fn vtex_hit(
    vt: VtexTexture,
    hit: ptr<function, VtexHit>,
    covers: bool,
    head: u32,
    lookup: VtexLookup,
) -> bool {
    (*hit).shows = covers;
    (*hit).paint = head & VTEX_ITEM_INDEX_MASK;
    return !covers;
}

fn vtex_hit_value(vt: VtexTexture, hit: VtexHit, lookup: VtexLookup) -> VtexValue {
    // Paint 0 where nothing shows, so that no branch is needed.
    let value = vtex_fill(vt, select(0u, hit.paint, hit.shows), lookup);
    return select(VtexValue(0.0), value, hit.shows);
}
