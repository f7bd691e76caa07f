//! Pure curve maths in whatever plane the caller works in.

mod clamp;
mod flatten;
mod overlap;
pub(crate) mod prepare;
pub(crate) mod stroke;
#[cfg(test)]
mod tests;
mod winding;

pub(crate) use clamp::clamp_outline;
pub(crate) use flatten::{clip_line, flatten, flatten_segment};
pub(crate) use overlap::{line_box_distance, line_line_distance};
pub(crate) use winding::Region;

/// `floor(x)` as an index; negative and NaN become 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates and callers clamp to their array"
)]
pub(crate) fn floor_index(x: f64) -> usize {
    x.floor() as usize
}
