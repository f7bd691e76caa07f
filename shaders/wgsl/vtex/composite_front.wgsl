//!use core/layout
//!use vtex/words
//!use vtex/footprint
//!use vtex/entry
// A cell's list where all paints are opaque, or of a mask: front to back in every filter mode,
// until nothing behind can show.

fn vtex_composite(vt: u32, first: u32, lookup: VtexLookup) -> VtexValue {
    var value = VtexValue(0.0);
    var through = 1.0;
    for (var i = 0u; i < VTEX_KEY_MAX_ENTRIES; i += 1u) {
        let words = vtex_word2(vt, first + i * VTEX_ENTRY_WORDS);
        let shown = vtex_entry_shown(vtex_entry(vt, words, lookup));
        value += through * shown;
        through *= 1.0 - vtex_value_alpha(shown);
        if through <= 0.0 || (words.x & VTEX_ENTRY_LAST_BIT) != 0u {
            break;
        }
    }
    return value;
}
