//!use core/color
//!use core/layout
//!use vtex/texture
//!use vtex/settings
//!use vtex/lookup
//!use vtex/samples
//!use vtex/resolved
//!use vtex/edge
//!use vtex/backdrop
//!use vtex/msdf
//!use vtex/brush
//!use vtex/outline
// The filter of [SFG22], as a baseline.

// Eq. 1: a smoothstep of half width S about the edge.
fn vtex_paper_ramp(vt: VtexTexture, distance: f32) -> f32 {
    let m = distance / vtex_word_float(vt, VTEX_HEADER_DISTANCE_RANGE) + 0.5;
    let s = vtex_word_float(vt, VTEX_HEADER_SMOOTHING);
    return smoothstep(0.5 - s, 0.5 + s, m);
}

// What a list shows, front to back. The edges of MSDFs are ramps of constant width with coverage as
// alpha, and may have a ring (eq. 2); other edges are hard.
fn vtex_paper(
    vt: VtexTexture, lookup: VtexLookup, word: u32, samples: VtexSamples, live: u32,
) -> VtexResolved {
    let first = vt.commands + (word & VTEX_CELL_PAYLOAD_MASK) * VTEX_CMD_WORDS;
    let width = vtex_word_float(vt, VTEX_HEADER_OUTLINE_WIDTH);
    var color = vec4f(0.0);
    var winding = VtexWinding();
    for (var i = 0u; i < VTEX_CMD_LIMIT; i += 1u) {
        let command = vtex_word4(vt, first + i * VTEX_CMD_WORDS);
        winding = vtex_edge_wind(samples, winding, command);
        if (command.w & VTEX_CMD_END_BIT) != 0u {
            var inner = 0.0;
            var outer = 0.0;
            var tag = command.w;
            if (command.w & VTEX_CMD_KIND_MASK) == VTEX_CMD_MSDF {
                let distance = vtex_msdf_distance(vt, command.x, vtex_samples_centre(samples));
                inner = vtex_paper_ramp(vt, distance);
                outer = select(0.0, vtex_paper_ramp(vt, distance + width), width > 0.0);
            } else {
                var covered = vtex_edge_covered(vt, samples, command, winding, 1u);
                if (command.w & VTEX_CMD_CONTROL_BIT) == 0u {
                    let shown = vtex_backdrop(command.w, covered, 1u);
                    tag = shown.tag;
                    covered = vtex_brush_covered(vt, samples, tag, shown.covered);
                }
                inner = select(0.0, 1.0, (covered & 1u) != 0u);
            }
            winding = VtexWinding();
            var over = 0u;
            if (command.w & VTEX_CMD_CONTROL_BIT) != 0u {
                let inside = (command.w & VTEX_CMD_OPAQUE_BIT) != 0u;
                if (inner > 0.0) == inside {
                    over = command.w & VTEX_CMD_INDEX_MASK;
                    // A branch over nothing leaves the list.
                    if over == 0u {
                        break;
                    }
                }
            } else {
                // Shape and ring exclude each other: both lie over what is behind.
                var entry = vec4f(0.0);
                if inner > 0.0 {
                    entry += inner * vtex_brush(vt, lookup, tag, lookup.uv).encoded;
                }
                if outer > inner {
                    let ring = vtex_outline_tag(vt);
                    entry += (outer - inner) * vtex_brush(vt, lookup, ring, lookup.uv).encoded;
                }
                color += (1.0 - color.a) * entry;
            }
            i += over;
            if over == 0u && (color.a >= 1.0 || (command.w & VTEX_CMD_LAST_BIT) != 0u) {
                break;
            }
        }
    }
    return vtex_resolved(vtex_color_decode_premultiplied(color), live);
}
