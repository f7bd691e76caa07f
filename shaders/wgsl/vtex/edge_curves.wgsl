//!use core/layout
//!use vtex/texture
//!use vtex/samples
// The samples that an entry covers, where edges are curves.

// A command of the entry.
fn vtex_edge_wind(samples: VtexSamples, winding: VtexWinding, command: vec4u) -> VtexWinding {
    return vtex_samples_wind(samples, winding, command);
}

// `command` is the entry's last. Of samples that are not in `live` nothing is said.
fn vtex_edge_covered(
    vt: VtexTexture, samples: VtexSamples, command: vec4u, winding: VtexWinding, live: u32,
) -> u32 {
    let curves = (command.w & VTEX_CMD_KIND_MASK) == VTEX_CMD_CURVES;
    return select(VTEX_SAMPLES_EVERY, vtex_samples_filled(winding, command.w), curves);
}
