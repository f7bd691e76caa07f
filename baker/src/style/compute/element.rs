//! One property of one element: the declaration that wins, and the attribute that it becomes.

use std::rc::Rc;

use usvg::roxmltree::Node;

use super::convert::Converter;
use super::{Computer, Inherited, Styled};
use crate::error::BakeError;
use crate::style::cascade::{Entry, Origin, Weight};
use crate::style::needed;
use crate::style::property::{self, Kind};
use crate::style::syntax::{self, Value, words};
use crate::style::value::filter;

/// The value that wins.
pub(super) enum Winner {
    /// The attribute as it is.
    Kept,
    Text(String),
    Removed,
}

impl Computer<'_> {
    pub(super) fn property(
        &self,
        node: Node<'_, '_>,
        parent: Option<&Styled>,
        (name, entries): (&Rc<str>, &[Entry]),
        outer: &Inherited,
        styled: &mut Styled,
    ) {
        let element = node.tag_name().name();
        let Some(kind) = property::kind(name) else {
            return;
        };
        let is_applied = match kind {
            Kind::Geometry(_) => property::has_geometry(name, element),
            Kind::PathData => element == "path",
            Kind::Background => parent.is_none(),
            _ => true,
        };
        let Some(last) = entries.last().filter(|_| is_applied) else {
            return;
        };
        let is_css = last.weight.origin != Origin::Attribute;
        match kind {
            Kind::NotDrawn => return self.not_drawn(node, last),
            Kind::Transform if !is_css => return,
            Kind::Transform => {
                let is_wide = property::wide_keyword(&last.value).is_some();
                let value = if is_wide {
                    Rc::from([])
                } else {
                    Rc::clone(&last.value)
                };
                styled.transforms.insert(Rc::clone(name), value);
                return;
            }
            _ => {}
        }
        let is_shape = |value: &Value| matches!(value, Value::Function(..));
        if &**name == "clip-path" && is_css && last.value.iter().any(is_shape) {
            styled.clip = Some(Rc::clone(&last.value));
            styled.attributes.insert(Rc::clone(name), None);
            return;
        }
        let converter = self.converter(styled, outer);
        if kind == Kind::Filter {
            return self.filter(entries, &converter, styled);
        }
        let winner = self.winner(node, parent, (name, entries), &converter);
        let value = match winner {
            Some(Winner::Text(text)) => Some(text),
            Some(Winner::Removed) => None,
            Some(Winner::Kept) => return,
            None => {
                let value = syntax::text(&last.value);
                if is_css && last.value.iter().any(is_shape) {
                    let message = format!("{name}: {value} is not understood");
                    self.report.missing(node, name, &message);
                }
                // What CSS takes for no value must not be one to usvg.
                let is_attribute = |entry: &Entry| entry.weight.origin == Origin::Attribute;
                if entries.iter().any(is_attribute) {
                    styled.attributes.insert(Rc::clone(name), None);
                }
                return;
            }
        };
        let is_auto_size = parent.is_none() && matches!(&**name, "width" | "height");
        let is_size = |text: &String| !(text.is_empty() || is_auto_size && text.ends_with('%'));
        styled
            .attributes
            .insert(Rc::clone(name), value.filter(is_size));
    }

    /// The filter: a list for usvg, or steps that need elements. A list that names what is not there
    /// counts as none, as Filter Effects 1 has it; usvg hides the element.
    fn filter(&self, entries: &[Entry], converter: &Converter<'_>, styled: &mut Styled) {
        let read = |entry: &Entry| match property::wide_keyword(&entry.value) {
            Some(_) => Some(Vec::new()),
            None => converter.filter(&words(&entry.value)),
        };
        let has_all = entries
            .iter()
            .rev()
            .find_map(|entry| Some((read(entry)?, self.filters.has_all(&entry.value))));
        let text = match has_all {
            Some((steps, true)) if !steps.is_empty() => {
                let text = filter::plain(&steps);
                styled.filter = text.is_none().then_some(steps);
                text
            }
            _ => None,
        };
        styled.attributes.insert("filter".into(), text);
    }

    /// The strongest declaration that is one; `None` where none is.
    pub(super) fn winner(
        &self,
        node: Node<'_, '_>,
        parent: Option<&Styled>,
        (name, entries): (&str, &[Entry]),
        converter: &Converter<'_>,
    ) -> Option<Winner> {
        let kind = property::kind(name)?;
        let is_inherited = property::is_inherited(name);
        let mut reverted = None;
        for entry in entries.iter().rev() {
            let is_passed = |reverted: Weight| reverted.is_of_layer(entry.weight);
            if reverted.is_some_and(is_passed) {
                continue;
            }
            let is_attribute = entry.weight.origin == Origin::Attribute;
            if let Some(keyword) = property::wide_keyword(&entry.value) {
                return Some(match keyword.as_str() {
                    "revert-layer" => {
                        reverted = Some(entry.weight);
                        continue;
                    }
                    "inherit" if is_attribute => Winner::Kept,
                    "inherit" if !is_inherited => inherited_text(node, parent, name),
                    "initial" if is_inherited => {
                        let values = syntax::parse(property::initial(name)).unwrap_or_default();
                        let text = converter.text(kind, &values);
                        Winner::Text(text.unwrap_or_else(|| property::initial(name).to_owned()))
                    }
                    _ => Winner::Removed,
                });
            }
            if is_attribute && !entry.had_variables && !needed::is_beyond_usvg(kind, &entry.value) {
                return Some(Winner::Kept);
            }
            if let Some(text) = converter.text(kind, &entry.value) {
                return Some(Winner::Text(text));
            }
        }
        reverted.map(|_| Winner::Removed)
    }

    /// Lengths of attributes that are no properties, in units that usvg does not know.
    pub(super) fn lengths(
        &self,
        node: Node<'_, '_>,
        outer: &Inherited,
        styled: &mut Styled,
    ) -> Result<(), BakeError> {
        for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
            let (name, value) = (attribute.name(), attribute.value());
            let is_short = value.len() <= needed::MAX_ATTRIBUTE_BYTES;
            if !is_short || !needed::is_length(name) || styled.attributes.contains_key(name) {
                continue;
            }
            let values = syntax::parse(value)?;
            let axis = match name {
                "y" | "y1" | "y2" | "cy" | "ry" | "fy" | "dy" | "height" => property::Axis::Y,
                "r" | "fr" => property::Axis::Both,
                _ => property::Axis::X,
            };
            if !needed::is_beyond_usvg(Kind::Geometry(axis), &values) {
                continue;
            }
            let converter = self.converter(styled, outer);
            let items = words(&values)
                .into_iter()
                .filter(|value| !value.is_delim(','));
            let texts: Option<Vec<_>> = items.map(|v| converter.length(v, axis)).collect();
            if let Some(texts) = texts {
                styled.attributes.insert(name.into(), Some(texts.join(" ")));
            }
        }
        Ok(())
    }

    fn not_drawn(&self, node: Node<'_, '_>, entry: &Entry) {
        let text = syntax::text(&entry.value);
        let nothing = [
            "none", "normal", "auto", "mixed", "1", "inherit", "initial", "unset", "revert",
        ];
        if !nothing.contains(&text.to_ascii_lowercase().as_str()) {
            let message = format!("{}: {text} is not drawn", entry.name);
            self.report.missing(node, &entry.name, &message);
        }
    }
}

/// What an element takes from its parent where children do not by themselves.
fn inherited_text(node: Node<'_, '_>, parent: Option<&Styled>, name: &str) -> Winner {
    let styled = parent.and_then(|parent| parent.attributes.get(name));
    let text = match styled {
        Some(text) => text.clone(),
        None => {
            let above = node.parent_element();
            above
                .and_then(|above| above.attribute(name))
                .map(str::to_owned)
        }
    };
    text.map_or(Winner::Removed, Winner::Text)
}
