//! The two encodings of texels, tiny-skia's and the file's, to and from linear light.
//!
//! Both have sRGB-encoded colour and premultiplied alpha, in different order: tiny-skia multiplies
//! the encoded colour, the file encodes the multiplied light.

use std::sync::LazyLock;

use crate::drawing::color::{decode, encode};

/// The nearest of 256 codes for a value in \[0, 1\]; NaN gives 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates and the range is that of u8"
)]
pub(crate) fn unorm8(value: f32) -> u8 {
    (value * 255.0).round() as u8
}

/// Steps of [`Tables::guess`]. With this many a step spans less than one code, because the steepest
/// slope of [`encode`] is 12.92 * 255 codes a unit.
const GUESS_STEPS: usize = 4096;

/// Tables with which encoding needs no power function.
struct Tables {
    /// `decode(code / 255)`.
    decode: [f32; 256],
    /// Smallest linear value that encodes to each code.
    threshold: [f32; 257],
    /// Code of the lower end of each step, to start the search from.
    guess: Vec<u8>,
}

static TABLES: LazyLock<Tables> = LazyLock::new(|| {
    let mut decode_table = [0.0; 256];
    let mut threshold = [f32::INFINITY; 257];
    for (code, (value, first)) in (0_u16..256).zip(decode_table.iter_mut().zip(&mut threshold)) {
        *value = decode(f32::from(code) / 255.0);
        // Rounding to the nearest code changes half way between two codes, on the encoded side.
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

/// The linear light of an sRGB code.
pub(crate) fn decode_u8(code: u8) -> f32 {
    TABLES.decode[usize::from(code)]
}

/// The nearest sRGB code of a linear value. Values outside \[0, 1\] are clamped; NaN gives 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates, NaN becomes 0, `min` bounds it"
)]
pub(crate) fn encode_u8(linear: f32) -> u8 {
    let tables = &*TABLES;
    let linear = linear.clamp(0.0, 1.0);
    // The guess is off by one code at most, so the loops hardly run.
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

/// A texel of tiny-skia's (sRGB-encoded colour times alpha) as linear light, premultiplied.
pub(crate) fn linear_from_skia(texel: [u8; 4]) -> [f32; 4] {
    let [r, g, b, a] = texel;
    if a == 0 {
        return [0.0; 4];
    }
    if a == 255 {
        return [decode_u8(r), decode_u8(g), decode_u8(b), 1.0];
    }
    let alpha = f32::from(a) / 255.0;
    // Undo the multiplication before decoding: the transfer function is not linear.
    let channel = |c: u8| alpha * decode((f32::from(c) / f32::from(a)).min(1.0));
    [channel(r), channel(g), channel(b), alpha]
}

/// The inverse of [`linear_from_skia`].
#[cfg(test)]
pub(crate) fn skia_from_linear(texel: [f32; 4]) -> [u8; 4] {
    let [r, g, b, alpha] = texel;
    let code = unorm8(alpha);
    if code == 0 {
        return [0; 4];
    }
    let channel = |c: f32| unorm8(alpha * encode((c / alpha).clamp(0.0, 1.0))).min(code);
    [channel(r), channel(g), channel(b), code]
}

/// Premultiplied linear light as a texel of a [`vtex_format::Image`].
pub(crate) fn stored_from_linear(texel: [f32; 4]) -> [u8; 4] {
    let [r, g, b, a] = texel;
    [encode_u8(r), encode_u8(g), encode_u8(b), unorm8(a)]
}

/// What a texel adds where it is composited: sRGB-encoded colour times alpha, and alpha, in codes.
/// Colours are rounded to the nearest code, and then multiplied.
pub(crate) fn composited_codes([r, g, b, alpha]: [f32; 4]) -> [f32; 4] {
    if alpha <= 0.0 {
        return [0.0; 4];
    }
    let channel = |c: f32| alpha * f32::from(encode_u8(c / alpha));
    [channel(r), channel(g), channel(b), 255.0 * alpha]
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
