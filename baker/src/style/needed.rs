//! Whether a document has styles that usvg does not read as browsers do.

use std::collections::BTreeSet;

use usvg::roxmltree::{Document, Node};

use super::property::{self, Kind};
use super::sheet::selector::{Combinator, Selector, Simple};
use super::sheet::{self, Declaration, Sheets};
use super::syntax::{self, Value, words};
use super::value::color::by_name;
use crate::error::BakeError;

/// Longest attribute that is looked at. Lists of numbers are longer, and no value of CSS is.
pub(super) const MAX_ATTRIBUTE_BYTES: usize = 4096;

/// The ids of a document's filters.
#[derive(Debug, Default)]
pub(super) struct Filters(BTreeSet<String>);

impl Filters {
    pub(super) fn new(document: &Document<'_>) -> Self {
        let filters = document
            .descendants()
            .filter(|node| super::elements::is_svg(*node) && node.tag_name().name() == "filter");
        let ids = filters.filter_map(|node| node.attribute("id"));
        Self(ids.map(str::to_owned).collect())
    }

    /// Whether all filters that a value refers to are there.
    pub(super) fn has_all(&self, values: &[Value]) -> bool {
        values.iter().all(|value| match value {
            Value::Url(url) => url.strip_prefix('#').is_some_and(|id| self.0.contains(id)),
            _ => true,
        })
    }
}

/// Whether the style stage has anything to do.
///
/// # Errors
/// [`BakeError::Limit`] for values that nest too deep.
pub(super) fn is_needed(
    document: &Document<'_>,
    sheets: &Sheets,
    filters: &Filters,
) -> Result<bool, BakeError> {
    if sheets.is_beyond_usvg || has_light_shadow(document) {
        return Ok(true);
    }
    let declaration = |found: &Declaration| declaration(found, filters);
    for rule in &sheets.rules {
        if rule.selectors.iter().any(is_beyond) || rule.declarations.iter().any(declaration) {
            return Ok(true);
        }
    }
    for node in document.descendants().filter(Node::is_element) {
        if !super::elements::is_svg(node) {
            continue;
        }
        if super::elements::is_label(node) {
            return Ok(true);
        }
        for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
            let value = attribute.value();
            let is_beyond = match attribute.name() {
                "style" => {
                    let declarations = sheet::declarations(&syntax::parse(value)?);
                    declarations.iter().any(declaration)
                }
                "pathLength" => true,
                // A foreignObject is passed over all the same.
                "requiredFeatures" => node.tag_name().name() != "foreignObject",
                "color-interpolation" => value.eq_ignore_ascii_case("linearRGB"),
                name if is_plain(value) || !is_read(name, node) => false,
                name => {
                    let kind = property::kind(name).unwrap_or(Kind::Geometry(property::Axis::X));
                    let values = syntax::parse(value)?;
                    let lacks_filter = kind == Kind::Filter && !filters.has_all(&values);
                    !matches!(kind, Kind::Transform | Kind::PathData)
                        && (lacks_filter || is_beyond_usvg(kind, &values))
                }
            };
            if is_beyond {
                return Ok(true);
            }
        }
    }
    Ok(false)
}

/// Whether an attribute is a property, or a length that may have a unit.
pub(super) fn is_read(name: &str, node: Node<'_, '_>) -> bool {
    property::is_attribute(name, node.tag_name().name()) || is_length(name)
}

/// Lengths of elements that are no properties.
pub(super) fn is_length(name: &str) -> bool {
    matches!(
        name,
        "x" | "y"
            | "width"
            | "height"
            | "x1"
            | "y1"
            | "x2"
            | "y2"
            | "cx"
            | "cy"
            | "r"
            | "rx"
            | "ry"
            | "fx"
            | "fy"
            | "fr"
            | "dx"
            | "dy"
            | "textLength"
            | "startOffset"
            | "refX"
            | "refY"
            | "markerWidth"
            | "markerHeight"
    )
}

/// Most attributes are numbers and hexadecimal colours, which need no parser.
fn is_plain(value: &str) -> bool {
    let is_number = |byte: &u8| byte.is_ascii_digit() || b".-+, ".contains(byte);
    value.len() > MAX_ATTRIBUTE_BYTES
        || value.starts_with('#')
        || value.as_bytes().iter().all(is_number)
        || value == "none"
}

/// Whether there is a drop shadow, and something that may have it computed as resvg does wrongly:
/// it lightens shadows that are not in linear light.
fn has_light_shadow(document: &Document<'_>) -> bool {
    let mut elements = document
        .descendants()
        .filter(|node| super::elements::is_svg(*node));
    elements.any(|node| node.tag_name().name() == "feDropShadow")
        && document.input_text().contains("sRGB")
}

fn declaration(declaration: &Declaration, filters: &Filters) -> bool {
    let name = &*declaration.name;
    let value = &declaration.value;
    if declaration.has_capitals {
        return true;
    }
    match name {
        "font" => value.iter().any(|value| value.is_delim('/')) || is_beyond_words(value),
        "background" | "mask-image" => true,
        "color-interpolation" => is_word(value, "linearrgb"),
        "marker" => is_beyond_words(value),
        "mask" => !matches!(&**value, [Value::Url(_)]) && !is_word(value, "none"),
        "all" => true,
        _ if name.starts_with("-webkit-") => super::shorthand::is_one(name),
        _ => match property::kind(name) {
            None | Some(Kind::Scheme | Kind::NotDrawn) => false,
            Some(Kind::Geometry(_) | Kind::PathData) => true,
            Some(Kind::Filter) if !filters.has_all(value) => true,
            Some(kind) => is_beyond_usvg(kind, value),
        },
    }
}

fn is_word(values: &[Value], wanted: &str) -> bool {
    matches!(values, [value] if value.keyword().as_deref() == Some(wanted))
}

fn is_beyond_words(values: &[Value]) -> bool {
    property::wide_keyword(values).is_some_and(|word| word != "inherit")
        || values
            .iter()
            .any(|value| matches!(value, Value::Function(..)))
        || values.iter().any(has_other_unit)
}

/// Whether a value means something else, or nothing, to usvg.
pub(super) fn is_beyond_usvg(kind: Kind, values: &[Value]) -> bool {
    if property::wide_keyword(values).is_some_and(|word| word != "inherit") {
        return true;
    }
    if super::variables::has_variable(values) || values.iter().any(has_other_unit) {
        return true;
    }
    match kind {
        Kind::Color | Kind::Paint | Kind::Background => values.iter().any(is_other_color),
        Kind::Reference => values
            .iter()
            .any(|value| matches!(value, Value::Function(..))),
        Kind::FontSize => values.iter().any(|value| {
            matches!(value, Value::Function(..)) || value.keyword().is_some_and(|w| w != "inherit")
        }),
        Kind::Filter => values.iter().any(|value| match value {
            Value::Function(name, inner) => {
                matches!(&**name, "blur" | "drop-shadow")
                    || inner
                        .iter()
                        .any(|value| matches!(value, Value::Function(..)))
            }
            _ => false,
        }),
        Kind::Transform => {
            let is_plain = |value: &Value| match value {
                Value::Function(name, inner) => {
                    let is_known = matches!(
                        &**name,
                        "matrix" | "translate" | "scale" | "rotate" | "skewx" | "skewy"
                    );
                    let is_number = |v: &Value| {
                        matches!(v, Value::Number(_) | Value::Space | Value::Delim(','))
                    };
                    is_known && inner.iter().all(is_number)
                }
                Value::Space => true,
                other => other.keyword().as_deref() == Some("none"),
            };
            !values.iter().all(is_plain)
        }
        Kind::Verbatim | Kind::NotDrawn | Kind::Scheme | Kind::PathData => false,
        Kind::Share | Kind::Number | Kind::Length(_) | Kind::Lengths | Kind::Geometry(_) => values
            .iter()
            .any(|value| matches!(value, Value::Function(..))),
        Kind::Keywords => {
            let words = words(values);
            let is_calculation =
                |value: &&Value| matches!(value, Value::Function(name, _) if &**name == "calc");
            let is_effect = is_word(values, "non-scaling-stroke");
            is_effect || words.iter().any(is_calculation)
        }
    }
}

fn has_other_unit(value: &Value) -> bool {
    match value {
        Value::Dimension(_, unit) => !matches!(
            &**unit,
            "px" | "em" | "ex" | "in" | "cm" | "mm" | "pt" | "pc" | "deg" | "rad" | "grad" | "turn"
        ),
        _ => false,
    }
}

fn is_other_color(value: &Value) -> bool {
    match value {
        // usvg knows this keyword in one spelling.
        Value::Ident(name) if name.eq_ignore_ascii_case("currentcolor") => {
            &**name != "currentColor"
        }
        Value::Ident(name) if name.eq_ignore_ascii_case("inherit") => false,
        Value::Ident(name) => {
            let is_word = matches!(&**name, "none" | "context-fill" | "context-stroke");
            !is_word && !is_svg_color(name)
        }
        Value::Function(name, inner) => {
            let is_known = matches!(&**name, "rgb" | "rgba" | "hsl" | "hsla");
            let is_plain = |value: &Value| {
                matches!(value, Value::Number(_) | Value::Percent(_) | Value::Space)
                    || value.is_delim(',')
            };
            let fourth = inner
                .rsplit(|value| value.is_delim(','))
                .next()
                .unwrap_or_default();
            let commas = inner.iter().filter(|value| value.is_delim(',')).count();
            let has_percent = fourth
                .iter()
                .any(|value| matches!(value, Value::Percent(_)));
            !is_known || !inner.iter().all(is_plain) || (commas == 3 && has_percent)
        }
        _ => false,
    }
}

/// Whether usvg knows a colour by this name.
fn is_svg_color(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    name != "rebeccapurple" && by_name(&name).is_some()
}

/// Whether usvg takes a selector for another one, or for none.
fn is_beyond(selector: &Selector) -> bool {
    selector.compounds.iter().any(|(combinator, compound)| {
        *combinator == Combinator::Later
            || compound.iter().any(|simple| match simple {
                Simple::Type(_, namespace) => namespace.is_some(),
                Simple::Id(_) | Simple::Class(_) => false,
                Simple::Attribute(attribute) => {
                    attribute.ignores_case || !matches!(attribute.operator, ' ' | '=' | '~')
                }
                Simple::Nth(nth) => {
                    let is_first = nth.step == 0 && nth.offset == 1;
                    !is_first || nth.from_end || nth.of_type || nth.of.is_some()
                }
                // It matches nothing in usvg either.
                Simple::Never => false,
                _ => true,
            })
    })
}
