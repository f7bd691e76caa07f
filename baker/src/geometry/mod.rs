//! Outlines in the plane, whatever its unit: inside tests, lines, distances, clamping.
//!
//! Two sub-rooms make outlines: [`stroke`] from lines with a width, [`prepare`] from outlines that
//! overlap themselves.

mod clamp;
mod flatten;
mod overlap;
pub(crate) mod prepare;
mod segment;
mod spread;
pub(crate) mod stroke;
#[cfg(test)]
mod tests;
mod winding;

pub(crate) use clamp::clamp_outline;
pub(crate) use flatten::{clip_line, flatten, flatten_segment, pieces};
pub(crate) use overlap::{line_box_distance, line_line_distance};
pub(crate) use segment::{set_end, set_start, tangent};
pub(crate) use spread::spread_point;
pub(crate) use winding::Region;
