//!use core/layout
//!use vtex/key
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/resolved
//!use vtex/edge
//!use vtex/backdrop
//!use vtex/ring
//!use vtex/composite
// The walk over a cell's list, front to back: one loop over the commands, whatever entries they
// belong to. Compilers that mask lanes instead of jumping pay for the longest walk of a group once
// here, not once an entry.
//
// All samples of one walk have met the same entries so far, so one colour stands for them. Those
// that an opaque entry covers are done. At any other entry or branch the samples part: the walk
// goes on with those that do as the first of them does, and another walk begins with the rest.

fn vtex_walk(
    vt: VtexTexture, lookup: VtexLookup, word: u32, samples: VtexSamples, live: u32,
) -> VtexResolved {
    let tag = word >> VTEX_CELL_TAG_SHIFT;
    let first = vt.commands + (word & VTEX_CELL_PAYLOAD_MASK) * VTEX_CMD_WORDS;
    // A cell of one paint has a list of one entry, which fills it.
    let listed = tag == VTEX_CELL_LIST;
    let only = VTEX_CMD_END_BIT | VTEX_CMD_LAST_BIT | (word & VTEX_CELL_PAINT_MASK);
    var composite = vtex_composite_start(live);
    var winding = VtexWinding();
    var walks = listed || tag == VTEX_CELL_SOLID;
    for (var i = 0u; i < VTEX_CMD_LIMIT; i += 1u) {
        if !walks {
            break;
        }
        var command = vec4u(0u, 0u, 0u, only);
        if listed {
            command = vtex_word4(vt, first + i * VTEX_CMD_WORDS);
        }
        winding = vtex_edge_wind(samples, winding, command);
        if (command.w & VTEX_CMD_END_BIT) != 0u {
            let covered = vtex_edge_covered(vt, samples, command, winding, composite.live);
            let control = (command.w & VTEX_CMD_CONTROL_BIT) != 0u;
            let shown = vtex_backdrop(command.w, covered, composite.live);
            let drawn = select(shown.covered, 0u, control);
            composite = vtex_composite_draw(vt, lookup, composite, samples, drawn, shown.tag);
            composite = vtex_ring(vt, lookup, composite, samples, drawn, command);
            var over = 0u;
            // Textures without clips have no control commands here: there is nothing to ask the
            // header.
            if control && (VTEX_KEY_FEATURES & VTEX_FEATURE_CLIPS) != 0u {
                let inside = (command.w & VTEX_CMD_OPAQUE_BIT) != 0u;
                let taken = select(~covered, covered, inside);
                let leads = (taken & composite.live & (~composite.live + 1u)) != 0u;
                composite.live &= select(~taken, taken, leads);
                over = select(0u, command.w & VTEX_CMD_INDEX_MASK, leads);
                // A branch over nothing leaves the list.
                walks = !leads || over != 0u;
            }
            // A branch that is taken goes on whatever the command it starts from says.
            walks = walks && composite.live != 0u
                && (over != 0u || (command.w & VTEX_CMD_LAST_BIT) == 0u);
            i += over;
            winding = VtexWinding();
        }
    }
    return vtex_composite_resolve(vt, lookup, composite, samples);
}
