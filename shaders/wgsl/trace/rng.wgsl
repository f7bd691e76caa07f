// Random numbers: PCG (O'Neill 2014), as used for graphics by Jarzynski and Olano 2020. Every
// path has its own stream from (seed, pixel, sample), so the picture does not depend on how the
// work was cut into dispatches.

fn rng_hash(value: u32) -> u32 {
    let state = value * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

fn rng_stream(seed: u32, pixel: u32, sample_index: u32) -> u32 {
    return rng_hash(pixel + rng_hash(sample_index + rng_hash(seed)));
}

// Uniform in [0, 1), 24 bits.
fn rng_unit(bits: u32) -> f32 {
    return f32(bits >> 8u) * 0x1p-24f;
}

fn rng_next(stream: ptr<function, u32>) -> f32 {
    *stream = *stream * 747796405u + 2891336453u;
    let state = *stream;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return rng_unit((word >> 22u) ^ word);
}

fn rng_next2(stream: ptr<function, u32>) -> vec2f {
    let x = rng_next(stream);
    return vec2f(x, rng_next(stream));
}
