//!use core/layout
//!use vtex/texture
//!use vtex/samples
//!use vtex/msdf_edge
// The samples that an entry covers, where edges are curves or MSDFs.

// An item of the entry.
fn vtex_edge_wind(samples: VtexSamples, winding: VtexWinding, item: vec4u) -> VtexWinding {
    return vtex_samples_wind(samples, winding, item);
}

// `item` is the entry's last. Of samples that are not in `live` nothing is said.
fn vtex_edge_covered(
    vt: VtexTexture, samples: VtexSamples, item: vec4u, winding: VtexWinding, live: u32,
) -> u32 {
    switch item.w & VTEX_ITEM_KIND_MASK {
        case VTEX_ITEM_CURVES: {
            return vtex_samples_filled(winding, item.w);
        }
        case VTEX_ITEM_MSDF: {
            return vtex_msdf_covered(vt, samples, item.x, 0.0, live);
        }
        default: {
            return VTEX_SAMPLES_EVERY;
        }
    }
}
