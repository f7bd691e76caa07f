//!use core/layout
//!use vtex/texture
//!use vtex/samples
//!use vtex/msdf
// The samples inside an MSDF.

// Those of `live` whose distance, inside positive, is greater than `least`.
fn vtex_msdf_covered(
    vt: VtexTexture, samples: VtexSamples, tile: u32, least: f32, live: u32,
) -> u32 {
    var covered = 0u;
    var rest = live;
    for (var i = 0u; i < VTEX_ROWS_SAMPLES; i += 1u) {
        if rest == 0u {
            break;
        }
        let q = vtex_samples_q(samples, firstTrailingBit(rest));
        let bit = rest & (~rest + 1u);
        covered |= select(0u, bit, vtex_msdf_distance(vt, tile, q) > least);
        rest &= ~bit;
    }
    return covered;
}
