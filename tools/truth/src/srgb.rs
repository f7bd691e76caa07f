//! The sRGB transfer function, IEC 61966-2-1.

pub use vtex_shaders::cpu::color::{decode_channel as decode, encode_channel as encode};

/// A value in \[0, 1\] as a byte, rounded; outside it is clamped.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to [0, 255] before the cast, NaN becomes 0"
)]
pub fn byte(value: f32) -> u8 {
    (value * 255.0 + 0.5).clamp(0.0, 255.0) as u8
}

/// Linear values of the 256 encoded bytes.
pub fn decode_table() -> [f32; 256] {
    std::array::from_fn(|code| decode(code as f32 / 255.0))
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
