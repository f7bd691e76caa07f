// What samples see.

struct VtexAnswer {
    // The sum of their colours, in linear light, premultiplied.
    sum: vec4f,
    // The samples.
    done: u32,
}

// Through a signed integer, which processors convert at once.
fn vtex_answer_count(samples: u32) -> f32 {
    return f32(bitcast<i32>(countOneBits(samples)));
}

// Samples that all see `color`.
fn vtex_answer(color: vec4f, samples: u32) -> VtexAnswer {
    return VtexAnswer(vtex_answer_count(samples) * color, samples);
}
