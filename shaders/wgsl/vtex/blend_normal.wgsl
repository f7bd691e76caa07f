// Source-over, the only blend mode here. Both sides sRGB-encoded, premultiplied.

fn vtex_blend(mode: u32, behind: vec4f, group: vec4f) -> vec4f {
    return group + (1.0 - group.a) * behind;
}
