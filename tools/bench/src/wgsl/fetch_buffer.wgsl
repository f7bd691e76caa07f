// The same sample from tiles in a storage buffer: the cell's word says where the tile lies.
// Words: cells a side, texels a cell, then the first word of each cell's tile, then the tiles.

@group(0) @binding(0) var<storage, read> words: array<u32>;

fn bench_sample(uv: vec2f, footprint: vec4f) -> vec4f {
    let side_cells = words[0];
    let texels = words[1];
    let p = clamp(uv, vec2f(0.0), vec2f(1.0)) * f32(side_cells);
    let cell = min(vec2u(p), vec2u(side_cells - 1u));
    let tile = words[2u + cell.y * side_cells + cell.x];
    let x = (p - vec2f(cell)) * f32(texels);
    let low = min(vec2u(x), vec2u(texels - 1u));
    let t = x - vec2f(low);
    let row = texels + 1u;
    let word = tile + low.y * row + low.x;
    let upper = mix(unpack4x8unorm(words[word]), unpack4x8unorm(words[word + 1u]), t.x);
    let lower = mix(unpack4x8unorm(words[word + row]), unpack4x8unorm(words[word + row + 1u]), t.x);
    let c = mix(upper, lower, t.y);
    return vec4f(max(min(c.r, c.g), min(max(c.r, c.g), c.b)));
}
