//!use core/set
//!use vtex/sample
// The fragment for other people's shaders: many textures in one buffer, by handle.

// The first word of a handle's texture. Where no texture has the handle, or has it any more, that of one
// that shows nothing: all lookups then take one way.
fn vtex_set_first(handle: u32) -> u32 {
    // Neither load waits for the other.
    let head = vtex_words[0];
    let slot = handle & VTEX_SET_SLOT_MASK;
    let word = VTEX_SET_ENTRIES + slot * VTEX_SET_ENTRY_WORDS;
    let entries = vtex_words[word >> 2u];
    let entry = select(entries.xy, entries.zw, (word & 2u) != 0u);
    let is_there = slot < head[VTEX_SET_COUNT] && entry.x == handle;
    return select(head[VTEX_SET_NOTHING], entry.y, is_there);
}

fn vtex_sample(handle: u32, uv: vec2f, footprint: vec4f) -> vec4f {
    return vtex_sample_at(vtex_set_first(handle), uv, footprint);
}
