//!use core/layout
//!use vtex/key
// What lookups ask of a texture's header, read once and ahead of every branch: there all lookups
// of a group share the loads, behind one each pays for its own.

struct VtexTexture {
    // First word, a multiple of four.
    first: u32,
    // Bits VTEX_FEATURE_ and, from VTEX_HEADER_SAMPLES_SHIFT on, the logarithm to the base of two of
    // the samples of a footprint; then the address modes along u and v.
    features: u32,
    address: vec2u,
    // Cells a unit of uv along both axes, then the lattice origin in cells.
    cell_from_uv: vec4f,
    // The last place of the grid along both axes, base cells along a cell (a power of two), and
    // columns of base cells.
    base: vec4f,
    // Units of curves along a cell and around it.
    curve_units: vec2f,
    texels_per_cell: u32,
    mip_texels_per_cell: f32,
    // First words of base cells, commands, paints and tiles.
    cells: u32,
    commands: u32,
    paints: u32,
    tiles: u32,
    // First word of the image records, and of image 0 its size and last level.
    images: u32,
    mip_size: vec2f,
    mip_last_level: u32,
}

// `first`: the texture's first word in the buffer.
fn vtex_texture(first: u32) -> VtexTexture {
    let group = first >> 2u;
    let about = vtex_words[group];
    let measures = vtex_words[group + VTEX_HEADER_CURVE_UNITS / 4u];
    let places = vtex_words[group + VTEX_HEADER_CELLS / 4u];
    let images = vtex_words[group + VTEX_HEADER_IMAGES / 4u];
    return VtexTexture(
        first,
        about.y,
        about.zw,
        bitcast<vec4f>(vtex_words[group + VTEX_HEADER_CELL_FROM_UV / 4u]),
        bitcast<vec4f>(vtex_words[group + VTEX_HEADER_BASE / 4u]),
        bitcast<vec2f>(measures.xy),
        measures.z,
        bitcast<f32>(measures.w),
        places.x,
        places.y,
        places.z,
        places.w,
        images.x,
        bitcast<vec2f>(images.yz),
        images.w,
    );
}

fn vtex_word(vt: VtexTexture, index: u32) -> u32 {
    let word = vt.first + index;
    return vtex_words[word >> 2u][word & 3u];
}

fn vtex_word2(vt: VtexTexture, index: u32) -> vec2u {
    return vec2u(vtex_word(vt, index), vtex_word(vt, index + 1u));
}

// Four words in one load: `index` is a multiple of four.
fn vtex_word4(vt: VtexTexture, index: u32) -> vec4u {
    return vtex_words[(vt.first + index) >> 2u];
}

fn vtex_word_float(vt: VtexTexture, index: u32) -> f32 {
    return bitcast<f32>(vtex_word(vt, index));
}

fn vtex_word_float2(vt: VtexTexture, index: u32) -> vec2f {
    return bitcast<vec2f>(vtex_word2(vt, index));
}

fn vtex_word_float4(vt: VtexTexture, index: u32) -> vec4f {
    return bitcast<vec4f>(vtex_word4(vt, index));
}
