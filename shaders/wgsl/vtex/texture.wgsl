//!use core/layout
//!use vtex/key
// What lookups ask of a texture's header, read once and ahead of every branch: there all lookups
// of a group share the loads, behind one each pays for its own.

struct VtexTexture {
    // First word, a multiple of four.
    first: u32,
    // Cells a unit of uv along both axes, then the lattice origin in cells.
    cell_from_uv: vec4f,
    // Columns and rows of fine cells, fine cells along a cell, and its inverse: a power of two.
    fine: vec4f,
    // Units of curves along a cell and around it.
    curve_units: vec2f,
    texels_per_cell: u32,
    mip_texels_per_cell: f32,
    // First words of fine cells, items, paints and tiles.
    cells: u32,
    items: u32,
    paints: u32,
    tiles: u32,
    // First word of the image records, and the size of image 0.
    images: u32,
    mip_size: vec2u,
    mip_levels: u32,
}

// `first`: the texture's first word in the buffer.
fn vtex_texture(first: u32) -> VtexTexture {
    let group = first >> 2u;
    let measures = vtex_words[group + VTEX_HEADER_CURVE_UNITS / 4u];
    let places = vtex_words[group + VTEX_HEADER_CELLS / 4u];
    let images = vtex_words[group + VTEX_HEADER_IMAGES / 4u];
    return VtexTexture(
        first,
        bitcast<vec4f>(vtex_words[group + VTEX_HEADER_CELL_FROM_UV / 4u]),
        bitcast<vec4f>(vtex_words[group + VTEX_HEADER_FINE / 4u]),
        bitcast<vec2f>(measures.xy),
        measures.z,
        bitcast<f32>(measures.w),
        places.x,
        places.y,
        places.z,
        places.w,
        images.x,
        images.yz,
        images.w,
    );
}
