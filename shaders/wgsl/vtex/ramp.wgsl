//!use core/layout
//!use vtex/words
// Coverage from a signed distance in texels, inside positive.

fn vtex_ramp_coverage(vt: VtexTexture, distance: f32, width_squared: f32) -> f32 {
    switch vtex_word(vt, VTEX_HEADER_FILTER) {
        case VTEX_FILTER_FOOTPRINT: {
            let width = sqrt(width_squared) * f32(vt.texels_per_cell);
            return clamp(distance / max(width, 1e-6) + 0.5, 0.0, 1.0);
        }
        case VTEX_FILTER_PAPER: {
            // [SFG22] eq. 1.
            let m = distance / vtex_word_float(vt, VTEX_HEADER_DISTANCE_RANGE) + 0.5;
            let s = vtex_word_float(vt, VTEX_HEADER_SMOOTHING);
            return smoothstep(0.5 - s, 0.5 + s, m);
        }
        default: {
            return select(0.0, 1.0, distance > 0.0);
        }
    }
}
