//!use vtex/texture
// The sides of the canvas.

// Units along the canvas, at least: without curves there are none.
const VTEX_MAPPING_LEAST_UNITS: f32 = 131072.0;

// How far inside the canvas places are kept, in uv: three halves of a unit of the curve lattice, to which
// a shape that ends with the canvas is rounded. Its side itself may show what lies behind.
fn vtex_mapping_inset(vt: VtexTexture) -> vec2f {
    let units = vt.curve_units.x * vt.cell_from_uv.xy;
    return 1.5 / max(units, vec2f(VTEX_MAPPING_LEAST_UNITS));
}
