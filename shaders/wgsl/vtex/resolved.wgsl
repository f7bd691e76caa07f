// What samples see.

struct VtexResolved {
    // The sum of their colours, in linear light, premultiplied.
    sum: vec4f,
    // The samples.
    done: u32,
}

// Through a signed integer, which processors convert at once.
fn vtex_resolved_count(samples: u32) -> f32 {
    return f32(bitcast<i32>(countOneBits(samples)));
}

// Samples that all see `color`.
fn vtex_resolved(color: vec4f, samples: u32) -> VtexResolved {
    return VtexResolved(vtex_resolved_count(samples) * color, samples);
}
