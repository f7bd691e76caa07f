//!use vtex/footprint
//!use vtex/source
//!use vtex/encoded
// Colour of an entry at a lookup as compositing wants it, from what it shows.

// sRGB-encoded, premultiplied.
fn vtex_tint(vt: VtexTexture, head: u32, lookup: VtexLookup) -> vec4f {
    return vtex_encoded(vt, head, vtex_source(vt, head, lookup));
}
