//! The sRGB transfer function, IEC 61966-2-1.

pub use vtex_shaders::srgb::{decode, decode_table, encode};

/// A value in \[0, 1\] as a byte, rounded; outside it is clamped.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to [0, 255] before the cast, NaN becomes 0"
)]
pub fn byte(value: f32) -> u8 {
    (value * 255.0 + 0.5).clamp(0.0, 255.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_survive_the_round_trip() {
        for (code, linear) in decode_table().into_iter().enumerate() {
            assert_eq!(usize::from(byte(encode(linear))), code);
        }
    }
}
