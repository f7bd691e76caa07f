// Trilinear by hand from half floats in a storage buffer, as packed textures held their mips
// before decision 0020.
// Words: width, height, level count, 0, first word of each of 16 levels, texels of two words.

@group(0) @binding(0) var<storage, read> words: array<u32>;

fn halves_texel(first: u32, width: u32, at: vec2u) -> vec4f {
    let word = first + 2u * (at.y * width + at.x);
    return vec4f(unpack2x16float(words[word]), unpack2x16float(words[word + 1u]));
}

fn halves_level(level: u32, uv: vec2f) -> vec4f {
    let size = max(vec2u(words[0], words[1]) >> vec2u(level), vec2u(1u));
    let first = words[4u + level];
    let x = uv * vec2f(size) - 0.5;
    let low = floor(x);
    let t = x - low;
    let last = vec2i(size) - 1;
    let p0 = vec2u(clamp(vec2i(low), vec2i(0), last));
    let p1 = vec2u(clamp(vec2i(low) + 1, vec2i(0), last));
    let upper = mix(halves_texel(first, size.x, p0), halves_texel(first, size.x, vec2u(p1.x, p0.y)), t.x);
    let lower = mix(halves_texel(first, size.x, vec2u(p0.x, p1.y)), halves_texel(first, size.x, p1), t.x);
    return mix(upper, lower, t.y);
}

fn bench_sample(uv: vec2f, footprint: vec4f) -> vec4f {
    let size = vec2f(f32(words[0]), f32(words[1]));
    let width_texels = max(length(footprint.xy * size), length(footprint.zw * size));
    let lod = clamp(log2(width_texels), 0.0, f32(words[2] - 1u));
    let fine = u32(lod);
    let t = fract(lod);
    let value = halves_level(fine, uv);
    if t <= 0.0 {
        return value;
    }
    // The last level is whole, so there is one behind this.
    return mix(value, halves_level(fine + 1u, uv), t);
}
