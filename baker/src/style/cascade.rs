//! Which declarations are for an element, from the weakest to the strongest (CSS Cascade 5).

use std::collections::BTreeMap;
use std::rc::Rc;

use usvg::roxmltree::Node;

use super::needed::MAX_ATTRIBUTE_BYTES;
use super::property;
use super::sheet::matching::Matcher;
use super::sheet::selector::{Selector, Simple};
use super::sheet::{self, Declaration, Sheets};
use super::syntax::{self, Value};
use crate::error::BakeError;

/// Most declarations for one element, of which each may stand for some dozens. Written
/// documents have some hundreds.
const MAX_DECLARATIONS: usize = 1 << 14;

/// A declaration for one element.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) name: Rc<str>,
    pub(super) value: Rc<[Value]>,
    pub(super) weight: Weight,
    /// Whether variables were put in.
    pub(super) had_variables: bool,
}

/// What decides between declarations, the first field first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Weight {
    pub(super) origin: Origin,
    /// Whether it is in a `style` attribute.
    is_attached: bool,
    layer: usize,
    specificity: [u32; 3],
    /// Rule and declaration in it.
    order: [usize; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Origin {
    /// An attribute such as `fill`.
    Attribute,
    Normal,
    Important,
}

impl Weight {
    /// Whether `revert-layer` in a declaration of this weight passes over one of `other`.
    pub(super) fn is_of_layer(self, other: Self) -> bool {
        (self.origin, self.is_attached, self.layer)
            == (other.origin, other.is_attached, other.layer)
    }
}

/// The rules of a document, sorted by what their last compound asks for.
pub(super) struct Cascade<'a> {
    sheets: &'a Sheets,
    matcher: &'a Matcher,
    ids: BTreeMap<Rc<str>, Vec<Place>>,
    classes: BTreeMap<Rc<str>, Vec<Place>>,
    types: BTreeMap<Rc<str>, Vec<Place>>,
    others: Vec<Place>,
}

/// A rule and a selector of it.
type Place = [usize; 2];

impl<'a> Cascade<'a> {
    pub(super) fn new(sheets: &'a Sheets, matcher: &'a Matcher) -> Self {
        let mut cascade = Self {
            sheets,
            matcher,
            ids: BTreeMap::new(),
            classes: BTreeMap::new(),
            types: BTreeMap::new(),
            others: Vec::new(),
        };
        for (rule, content) in sheets.rules.iter().enumerate() {
            for (index, selector) in content.selectors.iter().enumerate() {
                cascade.file(selector, [rule, index]);
            }
        }
        cascade
    }

    fn file(&mut self, selector: &Selector, place: Place) {
        let last = selector
            .compounds
            .last()
            .map(|(_, compound)| compound.as_slice());
        let last = last.unwrap_or_default();
        let id = last.iter().find_map(|simple| match simple {
            Simple::Id(id) => Some(id),
            _ => None,
        });
        let class = last.iter().find_map(|simple| match simple {
            Simple::Class(class) => Some(class),
            _ => None,
        });
        let name = last.iter().find_map(|simple| match simple {
            Simple::Type(Some(name), _) => Some(name),
            _ => None,
        });
        let list = match (id, class, name) {
            (Some(id), _, _) => self.ids.entry(Rc::clone(id)).or_default(),
            (None, Some(class), _) => self.classes.entry(Rc::clone(class)).or_default(),
            (None, None, Some(name)) => self.types.entry(Rc::clone(name)).or_default(),
            (None, None, None) => &mut self.others,
        };
        list.push(place);
    }

    /// The declarations for `node`, the strongest last.
    ///
    /// # Errors
    /// [`BakeError::Limit`] when they are too many or nest too deep.
    pub(super) fn entries(&self, node: Node<'_, '_>) -> Result<Vec<Entry>, BakeError> {
        let mut entries = Vec::new();
        self.attributes(node, &mut entries)?;
        for (rule, specificity) in self.matching(node) {
            let Some(content) = self.sheets.rules.get(rule) else {
                continue;
            };
            self.matcher.spend(content.declarations.len());
            let rank = self
                .sheets
                .layer_ranks
                .get(content.layer)
                .copied()
                .unwrap_or(0);
            let order = |index| [rule, index];
            let declarations = content.declarations.iter().enumerate();
            entries.extend(declarations.map(|(index, declaration)| {
                entry(declaration, Some((rank, specificity)), order(index))
            }));
        }
        self.matcher.check()?;
        if let Some(style) = node.attribute("style") {
            let declarations = sheet::declarations(&syntax::parse(style)?);
            let declarations = declarations.iter().enumerate();
            entries.extend(declarations.map(|(index, d)| entry(d, None, [0, index])));
        }
        if entries.len() > MAX_DECLARATIONS {
            return Err(BakeError::Limit(format!(
                "an element has more than {MAX_DECLARATIONS} declarations"
            )));
        }
        entries.sort_by_key(|entry| entry.weight);
        Ok(entries)
    }

    fn attributes(&self, node: Node<'_, '_>, out: &mut Vec<Entry>) -> Result<(), BakeError> {
        for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
            let name = attribute.name();
            let is_short = attribute.value().len() <= MAX_ATTRIBUTE_BYTES;
            // Transforms and path data of attributes are not written as in CSS.
            let is_other = matches!(name, "d" | "transform");
            if is_other || !is_short || !property::is_attribute(name, node.tag_name().name()) {
                continue;
            }
            out.push(Entry {
                name: name.into(),
                value: syntax::trim(&syntax::parse(attribute.value())?).into(),
                weight: Weight {
                    origin: Origin::Attribute,
                    is_attached: false,
                    layer: 0,
                    specificity: [0; 3],
                    order: [0; 2],
                },
                had_variables: false,
            });
        }
        Ok(())
    }

    /// Rules that match, each with the greatest specificity of its selectors that do.
    fn matching(&self, node: Node<'_, '_>) -> BTreeMap<usize, [u32; 3]> {
        let mut found: BTreeMap<usize, [u32; 3]> = BTreeMap::new();
        let mut look = |places: Option<&Vec<Place>>| {
            for &[rule, index] in places.into_iter().flatten() {
                let content = self.sheets.rules.get(rule);
                let selector = content.and_then(|content| content.selectors.get(index));
                if let Some(selector) = selector.filter(|s| self.matcher.matches(node, s)) {
                    let greatest = found.entry(rule).or_default();
                    *greatest = selector.specificity.max(*greatest);
                }
            }
        };
        if let Some(id) = node.attribute("id") {
            look(self.ids.get(id));
        }
        for class in node
            .attribute("class")
            .unwrap_or("")
            .split_ascii_whitespace()
        {
            look(self.classes.get(class));
        }
        look(self.types.get(node.tag_name().name()));
        look(Some(&self.others));
        found
    }
}

fn entry(
    declaration: &Declaration,
    of_rule: Option<(usize, [u32; 3])>,
    order: [usize; 2],
) -> Entry {
    let (rank, specificity) = of_rule.unwrap_or_default();
    let origin = match declaration.is_important {
        true => Origin::Important,
        false => Origin::Normal,
    };
    Entry {
        name: Rc::clone(&declaration.name),
        value: Rc::clone(&declaration.value),
        weight: Weight {
            origin,
            is_attached: of_rule.is_none(),
            // Importance turns the order of layers around.
            layer: if declaration.is_important {
                usize::MAX - rank
            } else {
                rank
            },
            specificity,
            order,
        },
        had_variables: false,
    }
}
