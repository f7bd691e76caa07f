//!use core/layout
//!use core/color
//!use vtex/words
//!use vtex/footprint
//!use vtex/entry
//!use vtex/over
// A cell's list with translucent paints.

// Front to back through the opaque entries before the first translucent one: what lies behind an
// opaque entry enters linearly, so it can be added when it is known.
fn vtex_composite(vt: u32, first: u32, lookup: VtexLookup) -> VtexValue {
    var color = vec4f(0.0);
    var through = 1.0;
    for (var i = 0u; i < VTEX_KEY_MAX_ENTRIES; i += 1u) {
        let word = first + i * VTEX_ENTRY_WORDS;
        let entry = vtex_word2(vt, word);
        if !vtex_over_opaque(vt, entry.x) {
            color += through * vtex_composite_behind(vt, word, lookup);
            break;
        }
        let shown = vtex_entry(vt, entry, lookup);
        color += through * shown;
        through *= 1.0 - shown.a;
        if through <= 0.0 || (entry.x & VTEX_ENTRY_LAST_BIT) != 0u {
            break;
        }
    }
    return color;
}

fn vtex_composite_behind(vt: u32, first: u32, lookup: VtexLookup) -> vec4f {
    if vtex_word(vt, VTEX_HEADER_FILTER) == VTEX_FILTER_POINT {
        return vtex_composite_point(vt, first, lookup);
    }
    return vtex_composite_ramp(vt, first, lookup);
}

// Coverage is 0 or 1: front to back on sRGB-encoded values, until an opaque entry is hit.
fn vtex_composite_point(vt: u32, first: u32, lookup: VtexLookup) -> vec4f {
    var color = vec4f(0.0);
    var hit_count = 0u;
    var hit = vec2u(0u);
    for (var i = 0u; i < VTEX_KEY_MAX_ENTRIES; i += 1u) {
        let entry = vtex_word2(vt, first + i * VTEX_ENTRY_WORDS);
        let shown = vtex_over_encoded(vt, entry, lookup);
        if shown.a > 0.0 {
            color += (1.0 - color.a) * shown;
            hit_count += 1u;
            hit = entry;
        }
        if shown.a >= 1.0 || (entry.x & VTEX_ENTRY_LAST_BIT) != 0u {
            break;
        }
    }
    if hit_count == 1u {
        // Looking once more is cheaper than the transfer functions.
        return vtex_entry(vt, hit, lookup);
    }
    return vtex_color_decode_premultiplied(color);
}

// Back to front: what a translucent paint makes of the colours behind it needs them first.
fn vtex_composite_ramp(vt: u32, first: u32, lookup: VtexLookup) -> vec4f {
    var word = first;
    for (var i = 1u; i < VTEX_KEY_MAX_ENTRIES; i += 1u) {
        if (vtex_word(vt, word) & VTEX_ENTRY_LAST_BIT) != 0u {
            break;
        }
        word += VTEX_ENTRY_WORDS;
    }
    var color = vec4f(0.0);
    for (var i = 0u; i < VTEX_KEY_MAX_ENTRIES; i += 1u) {
        color = vtex_over(vt, vtex_word2(vt, word), lookup, color);
        if word == first {
            break;
        }
        word -= VTEX_ENTRY_WORDS;
    }
    return color;
}
