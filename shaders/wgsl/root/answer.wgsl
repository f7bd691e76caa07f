//!use core/query
//!use root/fragment
// The answer of a query about the texture that is alone in its buffer.

fn vtex_answer(query: VtexBatchQuery) -> vec4f {
    return vtex_sample(query.uv, query.footprint);
}
