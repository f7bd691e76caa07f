//!use core/layout
//!use vtex/texture
//!use vtex/samples
// The samples that an entry covers, where every entry fills its cell.

fn vtex_edge_wind(samples: VtexSamples, winding: VtexWinding, command: vec4u) -> VtexWinding {
    return winding;
}

fn vtex_edge_covered(
    vt: VtexTexture, samples: VtexSamples, command: vec4u, winding: VtexWinding, live: u32,
) -> u32 {
    return VTEX_SAMPLES_EVERY;
}
