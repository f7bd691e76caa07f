//!use vtex/sample
// The fragment for other people's shaders: one texture, alone in its buffer and its pages.

fn vtex_sample(uv: vec2f, footprint: vec4f) -> vec4f {
    return vtex_sample_at(0u, uv, footprint);
}
