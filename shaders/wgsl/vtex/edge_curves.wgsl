//!use core/layout
//!use vtex/texture
//!use vtex/samples
// The samples that an entry covers, where edges are curves.

// An item of the entry.
fn vtex_edge_wind(samples: VtexSamples, winding: VtexWinding, item: vec4u) -> VtexWinding {
    return vtex_samples_wind(samples, winding, item);
}

// `item` is the entry's last. Of samples that are not in `live` nothing is said.
fn vtex_edge_covered(
    vt: VtexTexture, samples: VtexSamples, item: vec4u, winding: VtexWinding, live: u32,
) -> u32 {
    let curves = (item.w & VTEX_ITEM_KIND_MASK) == VTEX_ITEM_CURVES;
    return select(VTEX_SAMPLES_EVERY, vtex_samples_filled(winding, item.w), curves);
}
