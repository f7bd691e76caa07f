//!use core/layout
//!use core/color
//!use vtex/words
//!use vtex/footprint
//!use vtex/entry
//!use vtex/over
// A cell's list with translucent paints. One loop serves every filter mode, so that coverage and
// colour of an entry are in the compiled code once.

fn vtex_composite_last(vt: u32, first: u32) -> u32 {
    var word = first;
    for (var i = 1u; i < VTEX_KEY_MAX_ENTRIES; i += 1u) {
        if (vtex_word(vt, word) & VTEX_ENTRY_LAST_BIT) != 0u {
            break;
        }
        word += VTEX_ENTRY_WORDS;
    }
    return word;
}

fn vtex_composite(vt: u32, first: u32, lookup: VtexLookup) -> VtexValue {
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
    var word = first;
    var stop = first;
    for (var i = 0u; i < 2u * VTEX_KEY_MAX_ENTRIES; i += 1u) {
        let opaque = vtex_over_opaque(vt, vtex_word(vt, word));
        if ramp && !backwards && !opaque {
            backwards = true;
            stop = word;
            word = vtex_composite_last(vt, word);
        }
        let words = vtex_word2(vt, word);
        let entry = vtex_entry(vt, words, lookup);
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
            if word == stop {
                break;
            }
            word -= VTEX_ENTRY_WORDS;
        } else {
            if through <= 0.0 || (words.x & VTEX_ENTRY_LAST_BIT) != 0u {
                break;
            }
            word += VTEX_ENTRY_WORDS;
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
