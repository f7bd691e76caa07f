//!use vtex/footprint
//!use vtex/fill
//!use vtex/source
// What hits of a walk show of a mask where some are translucent.

struct VtexHit {
    alpha: f32,
    through: f32,
    // Of a cell of one colour.
    solid: bool,
    paint: u32,
}

fn vtex_hit_solid(vt: VtexTexture, shows: bool, paint: u32, lookup: VtexLookup) -> VtexHit {
    return VtexHit(0.0, 1.0, shows, paint);
}

// Takes in an entry that `covers` the lookup or not; whether what lies behind it can show.
fn vtex_hit(
    vt: VtexTexture,
    hit: ptr<function, VtexHit>,
    covers: bool,
    head: u32,
    lookup: VtexLookup,
) -> bool {
    if covers {
        let shown = vtex_source(vt, head, lookup);
        (*hit).alpha += (*hit).through * shown;
        (*hit).through *= 1.0 - shown;
    }
    return (*hit).through > 0.0;
}

fn vtex_hit_value(vt: VtexTexture, hit: VtexHit, lookup: VtexLookup) -> VtexValue {
    if hit.solid {
        return vtex_fill(vt, hit.paint, lookup);
    }
    return hit.alpha;
}
