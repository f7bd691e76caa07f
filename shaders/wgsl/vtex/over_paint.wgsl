//!use core/layout
//!use core/decode
//!use core/encode
//!use vtex/encoded
// Source-over on sRGB-encoded values, as SVG renderers composite.

// decode(paint over encode(behind)). `value` is the paint's colour; it and `behind` are linear
// light, premultiplied.
fn vtex_over_paint(vt: VtexTexture, head: u32, value: vec4f, behind: vec4f) -> vec4f {
    // Where one side alone shows, the transfer functions cancel.
    if behind.a <= 0.0 || (head & VTEX_ITEM_OPAQUE_BIT) != 0u {
        return value;
    }
    if value.a <= 0.0 {
        return behind;
    }
    let front = vtex_encoded(vt, head, value);
    let back = vtex_color_encode_premultiplied(behind);
    return vtex_color_decode_premultiplied(front + (1.0 - front.a) * back);
}
