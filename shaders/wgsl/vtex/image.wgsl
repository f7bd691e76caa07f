//!use core/layout
//!use vtex/words
//!use vtex/footprint
//!use vtex/texel
// Raster images: trilinear lookups by hand. Texel centres lie at +0.5.

// `index` of a texel left, right, above or below the edge comes back in.
fn vtex_image_neighbour(index: f32, count: f32, wraps: bool) -> f32 {
    let wrapped = index - count * floor(index / count);
    return select(clamp(index, 0.0, count - 1.0), wrapped, wraps);
}

// `t` in [0, 1] over the image.
fn vtex_image_bilinear(
    vt: u32,
    record: u32,
    level: u32,
    t: vec2f,
    wraps: vec2<bool>,
) -> VtexValue {
    let full = vtex_word2(vt, record + VTEX_IMAGE_SIZE);
    let size = max(full >> vec2u(level), vec2u(1u));
    let count = vec2f(size);
    let x = t * count - 0.5;
    let corner = floor(x);
    let f = x - corner;
    let left = u32(vtex_image_neighbour(corner.x, count.x, wraps.x));
    let right = u32(vtex_image_neighbour(corner.x + 1.0, count.x, wraps.x));
    let first = vtex_word(vt, record + VTEX_IMAGE_LEVELS + level);
    let above = first
        + u32(vtex_image_neighbour(corner.y, count.y, wraps.y)) * size.x * VTEX_IMAGE_TEXEL_WORDS;
    let below = first
        + u32(vtex_image_neighbour(corner.y + 1.0, count.y, wraps.y)) * size.x
            * VTEX_IMAGE_TEXEL_WORDS;
    let top = (1.0 - f.x) * vtex_texel(vt, above + left * VTEX_IMAGE_TEXEL_WORDS)
        + f.x * vtex_texel(vt, above + right * VTEX_IMAGE_TEXEL_WORDS);
    let bottom = (1.0 - f.x) * vtex_texel(vt, below + left * VTEX_IMAGE_TEXEL_WORDS)
        + f.x * vtex_texel(vt, below + right * VTEX_IMAGE_TEXEL_WORDS);
    return (1.0 - f.y) * top + f.y * bottom;
}

// `lod` 0 is the finest level; less is 0, and the last level is kept beyond the end.
fn vtex_image_trilinear(
    vt: u32,
    record: u32,
    lod: f32,
    t: vec2f,
    wraps: vec2<bool>,
) -> VtexValue {
    let coarsest = f32(max(vtex_word(vt, record + VTEX_IMAGE_LEVEL_COUNT), 1u) - 1u);
    let kept = clamp(lod, 0.0, min(coarsest, 15.0));
    let level = floor(kept);
    let f = kept - level;
    let fine = vtex_image_bilinear(vt, record, u32(level), t, wraps);
    if f <= 0.0 {
        return fine;
    }
    let coarse = vtex_image_bilinear(vt, record, u32(level) + 1u, t, wraps);
    return (1.0 - f) * fine + f * coarse;
}

// A patch that stands for what is not vector: nothing outside its rectangle.
fn vtex_image_entry(vt: u32, index: u32, lookup: VtexLookup) -> VtexValue {
    let record = vtex_word(vt, VTEX_HEADER_IMAGES) + index * VTEX_IMAGE_WORDS;
    let rect = vtex_word_float4(vt, record + VTEX_IMAGE_RECT_UV);
    let size = rect.zw - rect.xy;
    let t = (lookup.uv - rect.xy) / size;
    if any(t < vec2f(0.0)) || any(t > vec2f(1.0)) {
        return VtexValue(0.0);
    }
    let width = f32(vtex_word(vt, record + VTEX_IMAGE_SIZE));
    let texels = lookup.width_cells * width / (size.x * lookup.scale.x);
    return vtex_image_trilinear(vt, record, log2(max(texels, 1.0)), t, vec2<bool>(false));
}
