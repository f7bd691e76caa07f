//!use core/layout
//!use core/decode
//!use vtex/footprint
//!use vtex/paint
//!use vtex/tint
// What hits of a walk show where some are translucent and some gradients: front to back,
// sRGB-encoded, and decoded once.

struct VtexHit {
    count: u32,
    // The last word of the last one's last item.
    head: u32,
    color: vec4f,
}

fn vtex_hit_solid(vt: VtexTexture, shows: bool, paint: u32, lookup: VtexLookup) -> VtexHit {
    if !shows {
        return VtexHit(0u, 0u, vec4f(0.0));
    }
    return VtexHit(1u, paint, vtex_tint(vt, paint, lookup));
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
        let color = vtex_tint(vt, head, lookup);
        if color.a > 0.0 {
            (*hit).count += 1u;
            (*hit).head = head;
            (*hit).color += (1.0 - (*hit).color.a) * color;
        }
    }
    return (*hit).color.a < 1.0;
}

fn vtex_hit_value(vt: VtexTexture, hit: VtexHit, lookup: VtexLookup) -> vec4f {
    // A single solid paint needs no transfer function.
    if hit.count == 1u && (hit.head & VTEX_ITEM_KIND_MASK) != VTEX_ITEM_IMAGE {
        let solid = vtex_paint_solid(vt, hit.head & VTEX_ITEM_INDEX_MASK);
        if solid.a >= 0.0 {
            return solid;
        }
    }
    return vtex_color_decode_premultiplied(hit.color);
}
