//! Values of CSS to numbers: lengths and `calc()`, colours, transforms, shapes that clip.

pub(super) mod color;
pub(super) mod color_function;
pub(super) mod filter;
pub(super) mod length;
pub(super) mod shape;
pub(super) mod transform;

/// A number as usvg reads it: at most six digits behind the point, no exponent.
pub(super) fn number_text(number: f64) -> String {
    let rounded = (number * 1e6).round() / 1e6;
    // Not "-0".
    (rounded + 0.0).to_string()
}
