//!use core/layout
//!use vtex/words
//!use vtex/cell
//!use vtex/fill
//!use vtex/reach
//!use vtex/ramp
//!use vtex/source
// The picture from cells where edges are ramps and paints opaque, or of a mask: one walk over the
// items of the list, front to back, until nothing behind can show. See vtex/cells_point.

fn vtex_cells(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    let cell = vtex_cell(vt, lookup);
    let payload = cell.word & VTEX_CELL_PAYLOAD_MASK;
    let tag = cell.word >> VTEX_CELL_TAG_SHIFT;
    let inside = VtexLookup(lookup.uv, lookup.width_squared, cell.q);
    let p = vtex_reach_point(vt, cell.q);
    let first = vt.items + payload * VTEX_ITEM_WORDS;
    var value = VtexValue(0.0);
    if tag == VTEX_CELL_SOLID {
        value = vtex_fill(vt, payload, inside);
    }
    var through = 1.0;
    var winding = 0;
    var nearest = vtex_reach_squared(vt);
    var walks = tag == VTEX_CELL_LIST;
    for (var i = 0u; i < VTEX_ITEM_LIMIT; i += 1u) {
        if !walks {
            break;
        }
        let item = vtex_word4(vt, first + i * VTEX_ITEM_WORDS);
        winding += vtex_reach_winding(item, p);
        nearest = min(nearest, vtex_reach_distance_squared(vt, item, p));
        if (item.w & VTEX_ITEM_END_BIT) != 0u {
            let distance = vtex_reach_texels(vt, item, winding, nearest, cell.q);
            let coverage = vtex_ramp_coverage(vt, distance, lookup.width_squared);
            let shown = coverage * vtex_source(vt, item.w, inside);
            value += through * shown;
            through *= 1.0 - vtex_value_alpha(shown);
            walks = through > 0.0 && (item.w & VTEX_ITEM_LAST_BIT) == 0u;
            winding = 0;
            nearest = vtex_reach_squared(vt);
        }
    }
    return value;
}
