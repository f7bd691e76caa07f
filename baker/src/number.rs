//! Conversions between number types that can lose digits or range, each with its rule.

/// A number as the file stores it.
#[expect(clippy::cast_possible_truncation, reason = "stored as f32")]
pub(crate) fn to_f32(x: f64) -> f32 {
    x as f32
}

/// `floor(x)` as an index; negative numbers and NaN become 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates and callers clamp to their array"
)]
pub(crate) fn floor_index(x: f64) -> usize {
    x.floor() as usize
}

/// As [`floor_index`], for the sides of pictures and grids.
pub(crate) fn floor_u32(x: f64) -> u32 {
    u32::try_from(floor_index(x)).unwrap_or(u32::MAX)
}

/// A number of things in memory, exact because there are fewer than 2^52.
#[expect(clippy::cast_precision_loss, reason = "far below 2^52")]
pub(crate) fn count(n: usize) -> f64 {
    n as f64
}
