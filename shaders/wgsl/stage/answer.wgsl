//!use core/query
//!use vtex/sample
// Makes of root/batch the kernel of a queue of the path tracer, whose interface is thus that of kernels
// which files carry. Lookups are dispatched by the queue's length, and up to 63 behind it, left from
// before, are answered as well.

// The texture's first word lies in the query's padding.
fn vtex_answer(query: VtexBatchQuery) -> vec4f {
    return vtex_sample_at(bitcast<u32>(query.padding.x), query.uv, query.footprint);
}
