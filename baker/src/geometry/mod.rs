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
pub(crate) use flatten::{clip_line, flatten, flatten_segment, pieces};
pub(crate) use overlap::{line_box_distance, line_line_distance};
pub(crate) use winding::Region;
