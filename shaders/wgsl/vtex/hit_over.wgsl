//!use core/decode
//!use vtex/footprint
//!use vtex/paint
//!use vtex/source
//!use vtex/encoded
// What hits of a walk show where some are translucent: front to back, sRGB-encoded.

struct VtexHit {
    // The only one so far, in linear light: it needs no transfer function.
    only: vec4f,
    count: u32,
    color: vec4f,
    // Of a cell of one colour.
    solid: bool,
    paint: u32,
}

fn vtex_hit_solid(vt: VtexTexture, shows: bool, paint: u32, lookup: VtexLookup) -> VtexHit {
    return VtexHit(vec4f(0.0), 0u, vec4f(0.0), shows, paint);
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
        let value = vtex_source(vt, head, lookup);
        if value.a > 0.0 {
            (*hit).only = value;
            (*hit).count += 1u;
            (*hit).color += (1.0 - (*hit).color.a) * vtex_encoded(vt, head, value);
        }
    }
    return (*hit).color.a < 1.0;
}

fn vtex_hit_value(vt: VtexTexture, hit: VtexHit, lookup: VtexLookup) -> vec4f {
    if hit.count > 1u {
        return vtex_color_decode_premultiplied(hit.color);
    }
    if hit.solid {
        return vtex_paint_solid(vt, hit.paint);
    }
    return hit.only;
}
