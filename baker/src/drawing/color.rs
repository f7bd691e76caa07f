//! The sRGB transfer functions of IEC 61966-2-1 and the two texel encodings of the baker.

use std::sync::LazyLock;

use vtex_format::MaskKind;

pub(crate) use vtex_shaders::srgb::{decode, encode};

/// What a mask of one colour, straight alpha and sRGB-encoded, leaves of what it fades.
pub(crate) fn mask_weight(kind: MaskKind, [r, g, b, a]: [f32; 4]) -> f32 {
    let light = |[r, g, b]: [f32; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    match kind {
        MaskKind::Alpha => a,
        MaskKind::Luminance => light([r, g, b]) * a,
        MaskKind::LinearLuminance => light([r, g, b].map(decode)) * a,
    }
}

/// A value in \[0, 1\] as the nearest of 256 codes; NaN gives 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates and the range is that of u8"
)]
pub(crate) fn unorm8(value: f32) -> u8 {
    (value * 255.0).round() as u8
}

/// Steps of [`Tables::guess`]. Fine enough that a step spans at most one code: the steepest slope
/// of [`encode`] is 12.92 * 255 codes a unit.
const GUESS_STEPS: usize = 4096;

struct Tables {
    /// `decode(code / 255)`.
    decode: [f32; 256],
    /// Smallest linear value that encodes to each code.
    threshold: [f32; 257],
    /// Code of the lower end of each step.
    guess: Vec<u8>,
}

static TABLES: LazyLock<Tables> = LazyLock::new(|| {
    let mut decode_table = [0.0; 256];
    let mut threshold = [f32::INFINITY; 257];
    for (code, (value, first)) in (0_u16..256).zip(decode_table.iter_mut().zip(&mut threshold)) {
        *value = decode(f32::from(code) / 255.0);
        *first = decode(((f32::from(code) - 0.5) / 255.0).max(0.0));
    }
    threshold[0] = f32::NEG_INFINITY;
    let guess = (0..GUESS_STEPS)
        .map(|step| unorm8(encode(step as f32 / GUESS_STEPS as f32)))
        .collect();
    Tables {
        decode: decode_table,
        threshold,
        guess,
    }
});

/// Linear light of an sRGB code.
pub(crate) fn decode_u8(code: u8) -> f32 {
    TABLES.decode[usize::from(code)]
}

/// Nearest sRGB code of a linear value; values outside \[0, 1\] are clamped, NaN gives 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates, NaN becomes 0, `min` bounds it"
)]
pub(crate) fn encode_u8(linear: f32) -> u8 {
    let tables = &*TABLES;
    let linear = linear.clamp(0.0, 1.0);
    let step = ((linear * GUESS_STEPS as f32) as usize).min(GUESS_STEPS - 1);
    let mut code = tables.guess[step];
    while linear >= tables.threshold[usize::from(code) + 1] {
        code += 1;
    }
    while linear < tables.threshold[usize::from(code)] {
        code -= 1;
    }
    code
}

/// tiny-skia's texel (sRGB-encoded colour times alpha, 8 bits) as linear light, premultiplied.
pub(crate) fn linear_from_skia(texel: [u8; 4]) -> [f32; 4] {
    let [r, g, b, a] = texel;
    if a == 0 {
        return [0.0; 4];
    }
    if a == 255 {
        return [decode_u8(r), decode_u8(g), decode_u8(b), 1.0];
    }
    let alpha = f32::from(a) / 255.0;
    let channel = |c: u8| alpha * decode((f32::from(c) / f32::from(a)).min(1.0));
    [channel(r), channel(g), channel(b), alpha]
}

/// The inverse of [`linear_from_skia`].
pub(crate) fn skia_from_linear(texel: [f32; 4]) -> [u8; 4] {
    let [r, g, b, alpha] = texel;
    let code = unorm8(alpha);
    if code == 0 {
        return [0; 4];
    }
    let channel = |c: f32| unorm8(alpha * encode((c / alpha).clamp(0.0, 1.0))).min(code);
    [channel(r), channel(g), channel(b), code]
}

/// Linear light, premultiplied, as stored in a [`vtex_format::Image`].
pub(crate) fn stored_from_linear(texel: [f32; 4]) -> [u8; 4] {
    let [r, g, b, a] = texel;
    [encode_u8(r), encode_u8(g), encode_u8(b), unorm8(a)]
}

/// The inverse of [`stored_from_linear`].
pub(crate) fn linear_from_stored(texel: [u8; 4]) -> [f32; 4] {
    let [r, g, b, a] = texel;
    [
        decode_u8(r),
        decode_u8(g),
        decode_u8(b),
        f32::from(a) / 255.0,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_encodes_as_the_formula_does() {
        for step in 0..=200_000_u32 {
            let x = step as f32 / 200_000.0;
            let distance = (encode(x) * 255.0 - f32::from(encode_u8(x))).abs();
            assert!(distance <= 0.501, "{distance} codes off at {x}");
        }
        assert_eq!(
            (encode_u8(-1.0), encode_u8(2.0), encode_u8(f32::NAN)),
            (0, 255, 0)
        );
    }

    #[test]
    fn codes_survive_the_round_trips() {
        for code in 0..=255_u8 {
            assert_eq!(encode_u8(decode_u8(code)), code);
            let opaque = [code, 255 - code, 7, 255];
            assert_eq!(skia_from_linear(linear_from_skia(opaque)), opaque);
            let half = [code / 2, code / 3, 0, 128];
            assert_eq!(skia_from_linear(linear_from_skia(half)), half);
        }
    }
}
