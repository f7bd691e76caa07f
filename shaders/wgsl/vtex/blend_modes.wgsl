//!use core/layout
//!use vtex/blend_separable
//!use vtex/blend_hue
// Compositing and Blending Level 1, section 5.8. Both sides sRGB-encoded, premultiplied, not empty.

fn vtex_blend(mode: u32, behind: vec4f, group: vec4f) -> vec4f {
    if mode == VTEX_BLEND_PLUS_LIGHTER {
        return min(behind + group, vec4f(1.0));
    }
    let b = min(behind.rgb / behind.a, vec3f(1.0));
    let s = min(group.rgb / group.a, vec3f(1.0));
    var blended = s;
    if mode >= VTEX_BLEND_HUE {
        blended = vtex_blend_hue(mode, b, s);
    } else if mode >= VTEX_BLEND_MULTIPLY {
        blended = vtex_blend_separable(mode, b, s);
    }
    let color = (1.0 - behind.a) * group.rgb
        + (1.0 - group.a) * behind.rgb
        + group.a * behind.a * blended;
    return vec4f(color, group.a + (1.0 - group.a) * behind.a);
}
