// One query of the batch kernel, as in shaders/src/layout.rs.

struct VtexBatchQuery {
    uv: vec2f,
    padding: vec2f,
    footprint: vec4f,
}
