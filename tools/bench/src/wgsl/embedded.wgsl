// A textured rectangle, as a program that embeds the fragment draws it. The evaluator's own text
// follows.

struct EmbeddedVertex {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn embedded_vertex(@builtin(vertex_index) index: u32) -> EmbeddedVertex {
    let uv = vec2f(f32(index & 1u), f32(index >> 1u));
    return EmbeddedVertex(vec4f(2.0 * uv - 1.0, 0.0, 1.0), uv);
}

@fragment
fn embedded_fragment(in: EmbeddedVertex) -> @location(0) vec4f {
    return vtex_sample(in.uv, vec4f(dpdx(in.uv), dpdy(in.uv)));
}

