//!use core/layout
//!use vtex/footprint
//!use vtex/entry
// A cell's list where all paints are opaque, or of a mask: front to back in every filter mode,
// until nothing behind can show.

fn vtex_composite(vt: VtexTexture, first: u32, lookup: VtexLookup) -> VtexValue {
    var value = VtexValue(0.0);
    var through = 1.0;
    var item = first;
    for (var i = 0u; i < VTEX_KEY_MAX_ENTRIES; i += 1u) {
        let entry = vtex_entry(vt, item, lookup);
        let shown = vtex_entry_shown(entry);
        item = entry.next;
        value += through * shown;
        through *= 1.0 - vtex_value_alpha(shown);
        if through <= 0.0 || (entry.head & VTEX_ITEM_LAST_BIT) != 0u {
            break;
        }
    }
    return value;
}
