//!use core/layout
//!use vtex/words
//!use vtex/cell
//!use vtex/inside
//!use vtex/hit
// The picture from cells whose lists are clipped, where edges are hard: vtex/cells_point with tests
// that pass over items.

fn vtex_clips(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    let cell = vtex_cell(vt, lookup);
    let payload = cell.word & VTEX_CELL_PAYLOAD_MASK;
    let tag = cell.word >> VTEX_CELL_TAG_SHIFT;
    let inside = VtexLookup(lookup.uv, lookup.width_squared, cell.q);
    let p = vtex_inside_point(vt, cell.q);
    let first = vt.items + payload * VTEX_ITEM_WORDS;
    var hit = vtex_hit_solid(vt, tag == VTEX_CELL_SOLID, payload, inside);
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
            let control = (item.w & VTEX_ITEM_CONTROL_BIT) != 0u;
            walks = vtex_hit(vt, &hit, covers && !control, item.w, inside)
                && (item.w & VTEX_ITEM_LAST_BIT) == 0u;
            if control && covers == ((item.w & VTEX_ITEM_OPAQUE_BIT) != 0u) {
                let over = item.w & VTEX_ITEM_INDEX_MASK;
                walks = over != 0u;
                i += over;
            }
            winding = 0;
        }
    }
    return vtex_hit_value(vt, hit, inside);
}
