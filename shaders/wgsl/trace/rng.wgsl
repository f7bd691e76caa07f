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

fn rng_bits(stream: ptr<function, u32>) -> u32 {
    *stream = *stream * 747796405u + 2891336453u;
    let state = *stream;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

fn rng_next(stream: ptr<function, u32>) -> f32 {
    return rng_unit(rng_bits(stream));
}

// Below `count`: the upper half of the product of both, by halves of 16 bits.
fn rng_below(stream: ptr<function, u32>, count: u32) -> u32 {
    let bits = rng_bits(stream);
    let low = bits & 0xffffu;
    let high = bits >> 16u;
    let count_low = count & 0xffffu;
    let count_high = count >> 16u;
    let middle = high * count_low + ((low * count_low) >> 16u);
    let rest = low * count_high + (middle & 0xffffu);
    return high * count_high + (middle >> 16u) + (rest >> 16u);
}

fn rng_next2(stream: ptr<function, u32>) -> vec2f {
    let x = rng_next(stream);
    return vec2f(x, rng_next(stream));
}
