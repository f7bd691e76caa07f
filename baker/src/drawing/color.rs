//! The sRGB transfer functions (IEC 61966-2-1) and the weight of a mask.

use vtex_format::MaskKind;

pub(crate) use vtex_shaders::srgb::{decode, encode};

/// The weight of a mask that has one colour: straight alpha, sRGB-encoded.
pub(crate) fn mask_weight(kind: MaskKind, [r, g, b, a]: [f32; 4]) -> f32 {
    let light = |[r, g, b]: [f32; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    match kind {
        MaskKind::Alpha => a,
        MaskKind::Luminance => light([r, g, b]) * a,
        MaskKind::LinearLuminance => light([r, g, b].map(decode)) * a,
    }
}
