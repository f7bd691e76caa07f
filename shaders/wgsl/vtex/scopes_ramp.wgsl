//!use core/layout
//!use vtex/words
//!use vtex/cell
//!use vtex/fill
//!use vtex/coverage
//!use vtex/entry
//!use vtex/over
//!use vtex/frames
//!use vtex/flow
//!use vtex/group
// The picture from cells whose lists hold groups, or clips, where edges are ramps: entry by entry,
// which lie back to front, in linear light.

fn vtex_scopes(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    let cell = vtex_cell(vt, lookup);
    let payload = cell.word & VTEX_CELL_PAYLOAD_MASK;
    let tag = cell.word >> VTEX_CELL_TAG_SHIFT;
    if tag == VTEX_CELL_SOLID {
        return vtex_fill(vt, payload, lookup);
    }
    let inside = VtexLookup(lookup.uv, lookup.width_squared, cell.q);
    var frames = vtex_frames_start();
    var at = vt.items + payload * VTEX_ITEM_WORDS;
    if tag != VTEX_CELL_LIST {
        at = VTEX_ITEM_BEYOND;
    }
    for (var i = 0u; i < VTEX_ITEM_LIMIT; i += 1u) {
        if at == VTEX_ITEM_BEYOND {
            break;
        }
        vtex_flow_arrive(&frames, at);
        let covered = vtex_coverage(vt, at, inside);
        let tail = covered.item.w;
        at = select(covered.next, VTEX_ITEM_BEYOND, (tail & VTEX_ITEM_LAST_BIT) != 0u);
        if (tail & VTEX_ITEM_CONTROL_BIT) != 0u {
            let over = tail & VTEX_ITEM_INDEX_MASK;
            let ends = select(covered.next + over * VTEX_ITEM_WORDS, VTEX_ITEM_BEYOND, over == 0u);
            if vtex_flow_tests(tail) {
                let c = vtex_coverage_of_shape(covered);
                let jumps = select(1.0 - c, c, (tail & VTEX_ITEM_OPAQUE_BIT) != 0u);
                at = vtex_flow_test(&frames, jumps, at, ends);
            } else if vtex_group(&frames, covered.item) {
                at = ends;
            }
        } else {
            let entry = vtex_entry_of(vt, covered, inside);
            if vtex_entry_coverage(entry) > 0.0 {
                frames.color = vtex_over(vt, entry, frames.color);
            }
        }
    }
    vtex_flow_arrive(&frames, VTEX_ITEM_BEYOND);
    return frames.color;
}
