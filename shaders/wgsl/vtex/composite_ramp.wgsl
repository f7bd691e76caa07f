//!use core/layout
//!use core/decode
//!use vtex/words
//!use vtex/footprint
//!use vtex/entry
//!use vtex/over
// A cell's list with translucent paints. One loop serves every filter mode, so that coverage and
// colour of an entry are in the compiled code once.

// First item of the last entry from the entry at `first` on.
fn vtex_composite_last(vt: VtexTexture, first: u32) -> u32 {
    var last = first;
    var item = first;
    for (var i = 0u; i < VTEX_ITEM_LIMIT; i += 1u) {
        let tail = vtex_word(vt, item + 3u);
        if (tail & VTEX_ITEM_LAST_BIT) != 0u {
            break;
        }
        item += VTEX_ITEM_WORDS;
        if (tail & VTEX_ITEM_END_BIT) != 0u {
            last = item;
        }
    }
    return last;
}

// First item of the entry before the one at `item`; no list begins behind `first`.
fn vtex_composite_before(vt: VtexTexture, first: u32, item: u32) -> u32 {
    var before = item - VTEX_ITEM_WORDS;
    for (var i = 0u; i < VTEX_ITEM_LIMIT; i += 1u) {
        if before <= first || (vtex_word(vt, before - 1u) & VTEX_ITEM_END_BIT) != 0u {
            break;
        }
        before -= VTEX_ITEM_WORDS;
    }
    return before;
}

// Last word of the entry at `first`.
fn vtex_composite_head(vt: VtexTexture, first: u32) -> u32 {
    var tail = 0u;
    var item = first;
    for (var i = 0u; i < VTEX_ITEM_LIMIT; i += 1u) {
        tail = vtex_word(vt, item + 3u);
        if (tail & VTEX_ITEM_END_BIT) != 0u {
            break;
        }
        item += VTEX_ITEM_WORDS;
    }
    return tail;
}

fn vtex_composite(vt: VtexTexture, first: u32, lookup: VtexLookup) -> VtexValue {
    let ramp = vtex_word(vt, VTEX_HEADER_FILTER) != VTEX_FILTER_POINT;
    // Opaque entries in front, linear light: what lies behind them enters in proportion to what
    // they leave uncovered, so it can be added when it is known.
    var front = vec4f(0.0);
    var through = 1.0;
    // Point mode from the first translucent entry on, front to back, sRGB-encoded. Ramps from
    // there on, back to front, linear light: what a translucent paint makes of the colours
    // behind it needs them first.
    var color = vec4f(0.0);
    var hit_count = 0u;
    var backwards = false;
    var item = first;
    var stop = first;
    for (var i = 0u; i < 2u * VTEX_KEY_MAX_ENTRIES; i += 1u) {
        let opaque = vtex_over_opaque(vt, vtex_composite_head(vt, item));
        if ramp && !backwards && !opaque {
            backwards = true;
            stop = item;
            item = vtex_composite_last(vt, item);
        }
        let entry = vtex_entry(vt, item, lookup);
        if vtex_entry_coverage(entry) > 0.0 {
            let shown = vtex_entry_shown(entry);
            if backwards {
                color = vtex_over(vt, entry, color);
            } else if opaque && hit_count == 0u {
                front += through * shown;
                through *= 1.0 - shown.a;
            } else if shown.a > 0.0 {
                // The colour of a single hit needs no transfer function.
                front = shown;
                hit_count += 1u;
                color += (1.0 - color.a) * vtex_over_encoded(vt, entry);
                through = 1.0 - color.a;
            }
        }
        if backwards {
            if item == stop {
                break;
            }
            item = vtex_composite_before(vt, stop, item);
        } else {
            if through <= 0.0 || (entry.head & VTEX_ITEM_LAST_BIT) != 0u {
                break;
            }
            item = entry.next;
        }
    }
    if backwards {
        return front + through * color;
    }
    if hit_count > 1u {
        return vtex_color_decode_premultiplied(color);
    }
    return front;
}
