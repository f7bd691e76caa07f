//! The properties that a picture depends on, and what kind of value each has.

use super::syntax::{Value, words};
use super::value::color::{Surroundings, srgb};
use super::value::length::Units;
use super::variables::has_variable;

/// How a property's value is read and written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Color,
    /// A colour, a paint server or none.
    Paint,
    /// A number or percentage from 0 to 1.
    Share,
    Number,
    /// A length; percentages are of the viewport's width, height or diagonal.
    Length(Axis),
    /// Lengths between blanks or commas.
    Lengths,
    /// Identifiers, which usvg wants in lower case.
    Keywords,
    /// A reference to an element, or none.
    Reference,
    /// A list of functions.
    Filter,
    FontSize,
    /// Text that usvg reads as it is.
    Verbatim,
    /// A size or place of a shape, which is an attribute of some elements.
    Geometry(Axis),
    /// `d`.
    PathData,
    /// Makes the element's matrix together with the others of this kind.
    Transform,
    /// Of the root alone.
    Background,
    /// Read by the style stage alone.
    Scheme,
    /// Changes what browsers show and nothing here, which is said.
    NotDrawn,
}

/// What percentages are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axis {
    X,
    Y,
    Both,
    /// The font's size.
    Font,
}

/// The kind of a property that a picture depends on.
pub(super) fn kind(name: &str) -> Option<Kind> {
    Some(match name {
        "color" | "stop-color" | "flood-color" | "lighting-color" => Kind::Color,
        "fill" | "stroke" => Kind::Paint,
        "opacity" | "fill-opacity" | "stroke-opacity" | "stop-opacity" | "flood-opacity" => {
            Kind::Share
        }
        "stroke-miterlimit" => Kind::Number,
        "stroke-width" | "stroke-dashoffset" => Kind::Length(Axis::Both),
        "letter-spacing" | "word-spacing" | "baseline-shift" => Kind::Length(Axis::Font),
        "stroke-dasharray" => Kind::Lengths,
        "fill-rule"
        | "clip-rule"
        | "color-interpolation"
        | "color-interpolation-filters"
        | "color-rendering"
        | "direction"
        | "display"
        | "dominant-baseline"
        | "alignment-baseline"
        | "image-rendering"
        | "isolation"
        | "mask-type"
        | "mix-blend-mode"
        | "overflow"
        | "paint-order"
        | "shape-rendering"
        | "stroke-linecap"
        | "stroke-linejoin"
        | "text-anchor"
        | "text-decoration"
        | "text-overflow"
        | "text-rendering"
        | "unicode-bidi"
        | "vector-effect"
        | "visibility"
        | "white-space"
        | "writing-mode"
        | "font-style"
        | "font-variant"
        | "font-stretch"
        | "font-weight"
        | "font-kerning"
        | "font-optical-sizing"
        | "glyph-orientation-horizontal"
        | "glyph-orientation-vertical" => Kind::Keywords,
        "marker-start" | "marker-mid" | "marker-end" | "mask" | "clip-path" => Kind::Reference,
        "filter" => Kind::Filter,
        "font-size" => Kind::FontSize,
        "font-family" | "font-variation-settings" | "font-size-adjust" => Kind::Verbatim,
        "x" | "cx" | "width" | "rx" => Kind::Geometry(Axis::X),
        "y" | "cy" | "height" | "ry" => Kind::Geometry(Axis::Y),
        "r" => Kind::Geometry(Axis::Both),
        "d" => Kind::PathData,
        "transform" | "translate" | "rotate" | "scale" | "transform-origin" | "transform-box" => {
            Kind::Transform
        }
        "background-color" => Kind::Background,
        "color-scheme" => Kind::Scheme,
        "text-transform"
        | "font-variant-caps"
        | "text-orientation"
        | "offset-path"
        | "animation"
        | "animation-name"
        | "background-image"
        | "backdrop-filter"
        | "-webkit-text-stroke"
        | "text-shadow"
        | "zoom" => Kind::NotDrawn,
        _ => return None,
    })
}

/// Whether `name` is an attribute of `element` that stands for the property of this name.
pub(super) fn is_attribute(name: &str, element: &str) -> bool {
    match kind(name) {
        None | Some(Kind::Background | Kind::Scheme | Kind::NotDrawn) => false,
        Some(Kind::Geometry(_)) => has_geometry(name, element),
        Some(Kind::PathData) => element == "path",
        // Attributes of these names are lists of other elements, or no properties.
        Some(Kind::Transform) => matches!(name, "transform" | "transform-origin"),
        Some(_) => match name {
            "mix-blend-mode" | "isolation" | "font-kerning" => false,
            // Of an animation it means something else.
            "fill" => !matches!(
                element,
                "animate" | "set" | "animateTransform" | "animateMotion"
            ),
            _ => true,
        },
    }
}

/// Whether the size or place `name` is a property of `element`.
pub(super) fn has_geometry(name: &str, element: &str) -> bool {
    match name {
        "x" | "y" | "width" | "height" => {
            matches!(element, "svg" | "rect" | "image" | "use" | "foreignObject")
        }
        "cx" | "cy" => matches!(element, "circle" | "ellipse"),
        "r" => element == "circle",
        "rx" | "ry" => matches!(element, "rect" | "ellipse"),
        _ => false,
    }
}

/// Whether children take the value of their parent.
pub(super) fn is_inherited(name: &str) -> bool {
    !matches!(
        kind(name),
        Some(Kind::Geometry(_) | Kind::PathData | Kind::Transform | Kind::Background)
            | Some(Kind::Filter | Kind::NotDrawn)
    ) && !matches!(
        name,
        "opacity"
            | "stop-opacity"
            | "flood-opacity"
            | "stop-color"
            | "flood-color"
            | "lighting-color"
            | "baseline-shift"
            | "display"
            | "dominant-baseline"
            | "alignment-baseline"
            | "isolation"
            | "mask-type"
            | "mix-blend-mode"
            | "overflow"
            | "text-decoration"
            | "text-overflow"
            | "unicode-bidi"
            | "vector-effect"
            | "mask"
            | "clip-path"
    )
}

/// The first value of a property that is inherited. Of the others it is that without an attribute.
pub(super) fn initial(name: &str) -> &'static str {
    match name {
        "color" | "fill" => "black",
        "stroke" | "stroke-dasharray" | "marker-start" | "marker-mid" | "marker-end" => "none",
        "fill-opacity" | "stroke-opacity" | "stroke-width" => "1",
        "stroke-miterlimit" => "4",
        "stroke-dashoffset" | "glyph-orientation-horizontal" => "0",
        "fill-rule" | "clip-rule" => "nonzero",
        "color-interpolation" => "sRGB",
        "color-interpolation-filters" => "linearRGB",
        "direction" => "ltr",
        "stroke-linecap" => "butt",
        "stroke-linejoin" => "miter",
        "text-anchor" => "start",
        "visibility" => "visible",
        "writing-mode" => "horizontal-tb",
        "font-size" => "medium",
        "font-family" => "serif",
        "paint-order" | "letter-spacing" | "word-spacing" | "white-space" | "font-style"
        | "font-variant" | "font-stretch" | "font-weight" => "normal",
        _ => "auto",
    }
}

/// `inherit` and those like it.
pub(super) fn wide_keyword(values: &[Value]) -> Option<String> {
    let [value] = values else {
        return None;
    };
    let name = value.keyword()?;
    let is_wide = matches!(
        name.as_str(),
        "inherit" | "initial" | "unset" | "revert" | "revert-layer"
    );
    is_wide.then_some(name)
}

/// Whether a declaration is one that is applied, as `@supports` asks.
pub(super) fn is_known(name: &str, values: &[Value]) -> bool {
    if name.starts_with("--") {
        return true;
    }
    let is_shorthand = super::shorthand::is_one(name);
    let Some(kind) = kind(name) else {
        return is_shorthand;
    };
    if wide_keyword(values).is_some() || has_variable(values) {
        return true;
    }
    let around = Surroundings {
        units: Units {
            font_size_px: 16.0,
            root_font_size_px: 16.0,
            canvas_px: [100.0; 2],
            names: &[],
        },
        current: srgb([0.0, 0.0, 0.0, 1.0]),
        is_dark: false,
    };
    match (kind, words(values).as_slice()) {
        (Kind::Color, [value]) => around.color(value).is_some(),
        (Kind::Paint, [value]) => {
            let is_word = ["none", "context-fill", "context-stroke"];
            around.color(value).is_some()
                || matches!(value, Value::Url(_))
                || value
                    .keyword()
                    .is_some_and(|word| is_word.contains(&word.as_str()))
        }
        (Kind::Color | Kind::Paint, _) => false,
        (Kind::NotDrawn, _) => false,
        _ => true,
    }
}
