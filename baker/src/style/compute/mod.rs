//! The attributes that an element gets in place of its styles.

mod convert;
mod element;

use std::collections::BTreeMap;
use std::rc::Rc;

use color::DynamicColor;
use usvg::roxmltree::{Document, Node};

use super::cascade::{Cascade, Entry, Origin};
use super::needed::Filters;
use super::report::Report;
use super::syntax::{self, Value};
use super::value::color::{Surroundings, srgb};
use super::value::filter::Step;
use super::value::length::Units;
use super::variables::{Custom, Variables, has_variable};
use super::{property, shorthand};
use crate::error::BakeError;
use convert::Converter;
use element::Winner;

/// What an element gets.
#[derive(Debug, Default)]
pub(super) struct Styled {
    /// Attributes to write, or to leave out.
    pub(super) attributes: BTreeMap<Rc<str>, Option<String>>,
    /// Values of properties that make the matrix.
    pub(super) transforms: BTreeMap<Rc<str>, Rc<[Value]>>,
    /// The shape that clips.
    pub(super) clip: Option<Rc<[Value]>>,
    /// Elements that are written before it.
    pub(super) before: String,
    /// Whether it is written as a path.
    pub(super) is_path: bool,
    /// The filter, where it needs elements of its own.
    pub(super) filter: Option<Vec<Step>>,
    pub(super) inherited: Inherited,
}

/// What children take from their parent without an attribute saying so.
#[derive(Clone, Debug)]
pub(super) struct Inherited {
    pub(super) custom: Rc<Custom>,
    pub(super) font_size_px: f64,
    pub(super) current: DynamicColor,
    pub(super) is_dark: bool,
    /// Width and height of the nearest viewport in user units.
    pub(super) viewport: [f64; 2],
}

impl Default for Inherited {
    fn default() -> Self {
        Self {
            custom: Rc::default(),
            font_size_px: 16.0,
            current: srgb([0.0, 0.0, 0.0, 1.0]),
            is_dark: false,
            viewport: [100.0; 2],
        }
    }
}

/// Custom properties, and the declarations of each property.
pub(super) type Declared = (Rc<Custom>, BTreeMap<Rc<str>, Vec<Entry>>);

/// Computes all elements of a document; the list has a place for each node.
pub(super) struct Computer<'a> {
    pub(super) cascade: Cascade<'a>,
    pub(super) report: &'a Report,
    pub(super) canvas_px: [f64; 2],
    /// First values of custom properties.
    pub(super) first: Rc<Custom>,
    pub(super) variables: Variables,
    pub(super) root_font_size_px: f64,
    pub(super) filters: &'a Filters,
}

impl Computer<'_> {
    pub(super) fn document(
        &mut self,
        document: &Document<'_>,
    ) -> Result<Vec<Option<Styled>>, BakeError> {
        let count = document
            .descendants()
            .map(|node| node.id().get_usize() + 1)
            .max();
        let mut all: Vec<Option<Styled>> = Vec::new();
        all.resize_with(count.unwrap_or(0), || None);
        for node in document
            .descendants()
            .filter(|node| super::elements::is_svg(*node))
        {
            let parent = node.parent_element();
            let parent = parent.and_then(|p| all.get(p.id().get_usize())?.as_ref());
            let styled = self.element(node, parent)?;
            if let Some(place) = all.get_mut(node.id().get_usize()) {
                *place = Some(styled);
            }
        }
        Ok(all)
    }

    fn element(
        &mut self,
        node: Node<'_, '_>,
        parent: Option<&Styled>,
    ) -> Result<Styled, BakeError> {
        let outer = match parent {
            Some(parent) => parent.inherited.clone(),
            None => Inherited {
                custom: Rc::clone(&self.first),
                viewport: self.canvas_px,
                ..Inherited::default()
            },
        };
        let entries = self.cascade.entries(node)?;
        let (custom, longhands) =
            self.longhands(entries, &outer, &|name| property::kind(name).is_some())?;
        let mut styled = Styled {
            inherited: Inherited {
                custom,
                ..outer.clone()
            },
            ..Styled::default()
        };
        if parent.is_some() && node.tag_name().name() == "svg" {
            styled.inherited.viewport =
                super::elements::viewport_of(node).unwrap_or(outer.viewport);
        }
        let empty = Vec::new();
        let of = |name: &str| longhands.get(name).unwrap_or(&empty).as_slice();
        self.font_size(node, parent, of("font-size"), &outer, &mut styled);
        if let Some(scheme) = of("color-scheme").last() {
            let names: Vec<_> = scheme.value.iter().filter_map(Value::keyword).collect();
            let has = |name: &str| names.iter().any(|found| found == name);
            styled.inherited.is_dark = has("dark") && !has("light");
        }
        self.color(node, parent, of("color"), &outer, &mut styled);
        for (name, entries) in &longhands {
            if !matches!(&**name, "font-size" | "color" | "color-scheme") {
                self.property(node, parent, (name, entries), &outer, &mut styled);
            }
        }
        self.lengths(node, &outer, &mut styled)?;
        Ok(styled)
    }

    /// As [`Self::longhands`], of an element of HTML, whose attributes are no properties.
    pub(super) fn html(
        &mut self,
        node: Node<'_, '_>,
        outer: &Inherited,
    ) -> Result<Declared, BakeError> {
        let mut entries = self.cascade.entries(node)?;
        entries.retain(|entry| entry.weight.origin != Origin::Attribute);
        self.longhands(entries, outer, &|_| true)
    }

    /// Custom properties, and the declarations of each property that is `wanted`, the strongest last.
    fn longhands(
        &mut self,
        entries: Vec<Entry>,
        outer: &Inherited,
        wanted: &dyn Fn(&str) -> bool,
    ) -> Result<Declared, BakeError> {
        let (own, others): (Vec<_>, Vec<_>) = entries
            .into_iter()
            .partition(|entry| entry.name.starts_with("--"));
        let own = own
            .into_iter()
            .map(|entry| (entry.name, entry.value))
            .collect();
        let custom = self.variables.resolve(own, &outer.custom)?;
        let mut longhands: BTreeMap<Rc<str>, Vec<Entry>> = BTreeMap::new();
        for entry in others {
            let value = match has_variable(&entry.value) {
                // CSS Variables: invalid at computed-value time.
                true => match self.variables.substitute(&entry.value, &custom)? {
                    Some(value) => syntax::trim(&value).into(),
                    None => Rc::from([Value::Ident("unset".into())]),
                },
                false => Rc::clone(&entry.value),
            };
            let original = Rc::clone(&entry.value);
            for (name, value) in shorthand::expand(&entry.name, &value) {
                if wanted(&name) {
                    let entry = Entry {
                        name: Rc::clone(&name),
                        value,
                        weight: entry.weight,
                        had_variables: has_variable(&original),
                    };
                    longhands.entry(name).or_default().push(entry);
                }
            }
        }
        Ok((custom, longhands))
    }

    pub(super) fn converter<'u>(&self, styled: &Styled, outer: &Inherited) -> Converter<'u> {
        let inherited = &styled.inherited;
        Converter {
            around: Surroundings {
                units: Units {
                    font_size_px: inherited.font_size_px,
                    root_font_size_px: self.root_font_size_px,
                    canvas_px: self.canvas_px,
                    names: &[],
                },
                current: inherited.current,
                is_dark: inherited.is_dark,
            },
            outer_font_size_px: outer.font_size_px,
            viewport: outer.viewport,
        }
    }

    fn font_size(
        &mut self,
        node: Node<'_, '_>,
        parent: Option<&Styled>,
        entries: &[Entry],
        outer: &Inherited,
        styled: &mut Styled,
    ) {
        let converter = self.converter(styled, outer);
        match self.winner(node, parent, ("font-size", entries), &converter) {
            Some(Winner::Text(text)) => {
                styled.inherited.font_size_px = text.parse().unwrap_or(outer.font_size_px);
                styled.attributes.insert("font-size".into(), Some(text));
            }
            Some(Winner::Kept) => {
                let attribute = entries.first().and_then(|entry| entry.value.first());
                let size = attribute.and_then(|value| converter.font_size_px(value));
                styled.inherited.font_size_px = size.unwrap_or(outer.font_size_px);
            }
            Some(Winner::Removed) => {
                styled.attributes.insert("font-size".into(), None);
            }
            None => {}
        }
        if parent.is_none() {
            self.root_font_size_px = styled.inherited.font_size_px;
        }
    }

    fn color(
        &self,
        node: Node<'_, '_>,
        parent: Option<&Styled>,
        entries: &[Entry],
        outer: &Inherited,
        styled: &mut Styled,
    ) {
        let converter = self.converter(styled, outer);
        let known = |value: &Value| converter.around.resolved(value);
        match self.winner(node, parent, ("color", entries), &converter) {
            // `color: currentColor` is the parent's.
            Some(Winner::Removed) => {
                styled.attributes.insert("color".into(), None);
            }
            Some(Winner::Text(text)) if text == "currentColor" => {
                styled.attributes.insert("color".into(), None);
            }
            Some(Winner::Text(text)) => {
                let values = syntax::parse(&text).unwrap_or_default();
                let color = values.first().and_then(known);
                styled.inherited.current = color.unwrap_or(outer.current);
                styled.attributes.insert("color".into(), Some(text));
            }
            Some(Winner::Kept) => {
                let attribute = entries.first().and_then(|entry| entry.value.first());
                let color = attribute.and_then(known);
                styled.inherited.current = color.unwrap_or(outer.current);
            }
            None => {}
        }
    }
}
