//!use core/layout
//!use vtex/texture
//!use vtex/samples
//!use vtex/msdf_edge
// The samples that an entry covers, where edges are MSDFs.

fn vtex_edge_wind(samples: VtexSamples, winding: VtexWinding, command: vec4u) -> VtexWinding {
    return winding;
}

// `command` is the entry's last. Of samples that are not in `live` nothing is said.
fn vtex_edge_covered(
    vt: VtexTexture, samples: VtexSamples, command: vec4u, winding: VtexWinding, live: u32,
) -> u32 {
    if (command.w & VTEX_CMD_KIND_MASK) == VTEX_CMD_MSDF {
        return vtex_msdf_covered(vt, samples, command.x, 0.0, live);
    }
    return VTEX_SAMPLES_EVERY;
}
