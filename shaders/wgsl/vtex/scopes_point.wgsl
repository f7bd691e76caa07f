//!use core/layout
//!use core/decode
//!use vtex/words
//!use vtex/cell
//!use vtex/fill
//!use vtex/inside
//!use vtex/tint
//!use vtex/frames
//!use vtex/flow
//!use vtex/group
// The picture from cells whose lists hold groups, where edges are hard: one walk over the items,
// which lie back to front, sRGB-encoded.

fn vtex_scopes(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    let cell = vtex_cell(vt, lookup);
    let payload = cell.word & VTEX_CELL_PAYLOAD_MASK;
    let tag = cell.word >> VTEX_CELL_TAG_SHIFT;
    if tag == VTEX_CELL_SOLID {
        return vtex_fill(vt, payload, lookup);
    }
    let inside = VtexLookup(lookup.uv, lookup.width_squared, cell.q);
    let p = vtex_inside_point(vt, cell.q);
    let first = vt.items + payload * VTEX_ITEM_WORDS;
    var frames = vtex_frames_start();
    var winding = 0;
    var walks = tag == VTEX_CELL_LIST;
    for (var i = 0u; i < VTEX_ITEM_LIMIT; i += 1u) {
        if !walks {
            break;
        }
        let item = vtex_word4(vt, first + i * VTEX_ITEM_WORDS);
        winding += vtex_inside_winding(item, p);
        if (item.w & VTEX_ITEM_END_BIT) != 0u {
            let covers = vtex_inside(vt, item, winding, cell.q);
            walks = (item.w & VTEX_ITEM_LAST_BIT) == 0u;
            winding = 0;
            if (item.w & VTEX_ITEM_CONTROL_BIT) != 0u {
                var jumps = false;
                if vtex_flow_tests(item.w) {
                    jumps = covers == ((item.w & VTEX_ITEM_OPAQUE_BIT) != 0u);
                } else {
                    jumps = vtex_group(&frames, item);
                }
                if jumps {
                    let over = item.w & VTEX_ITEM_INDEX_MASK;
                    walks = over != 0u;
                    i += over;
                }
            } else if covers {
                let shown = vtex_tint(vt, item.w, inside);
                frames.color = shown + (1.0 - shown.a) * frames.color;
            }
        }
    }
    return vtex_color_decode_premultiplied(frames.color);
}
