//! The sRGB transfer functions of IEC 61966-2-1 in f32: those of the evaluator, for everything that
//! makes its texels or shows its results.

pub use crate::cpu::color::{decode_channel as decode, encode_channel as encode};

/// Linear light of the 256 codes of an 8-bit channel.
pub fn decode_table() -> [f32; 256] {
    *crate::cpu::color::DECODED
}
