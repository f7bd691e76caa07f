//!use core/layout
//!use vtex/texture
//!use vtex/samples
//!use vtex/msdf_edge
// The samples that an entry covers, where edges are curves or MSDFs.

// A command of the entry.
fn vtex_edge_wind(samples: VtexSamples, winding: VtexWinding, command: vec4u) -> VtexWinding {
    return vtex_samples_wind(samples, winding, command);
}

// `command` is the entry's last. Of samples that are not in `live` nothing is said.
fn vtex_edge_covered(
    vt: VtexTexture, samples: VtexSamples, command: vec4u, winding: VtexWinding, live: u32,
) -> u32 {
    switch command.w & VTEX_CMD_KIND_MASK {
        case VTEX_CMD_CURVES: {
            return vtex_samples_filled(winding, command.w);
        }
        case VTEX_CMD_MSDF: {
            return vtex_msdf_covered(vt, samples, command.x, 0.0, live);
        }
        default: {
            return VTEX_SAMPLES_EVERY;
        }
    }
}
