//! Whether an element matches a selector.

use std::cell::Cell;
use std::collections::BTreeMap;

use usvg::roxmltree::{Document, Node};

use super::selector::{Attribute, Combinator, Nth, Selector, Simple};
use crate::error::BakeError;

/// Most compounds that are held against elements. A map with 100,000 elements and 500 rules takes
/// about a million, because rules are sorted by their last compound; a bomb of `:has(:has(..))` or
/// `* * * *` takes more than any machine does.
const MAX_STEPS: u64 = 30_000_000;

/// Bytes of an attribute that are read in the time of a step.
const BYTES_A_STEP: usize = 64;

/// Attributes of an element that are looked through in the time of a step.
const ATTRIBUTES_A_STEP: usize = 16;

/// Elements of a document, ready to be held against selectors.
pub(in crate::style) struct Matcher {
    places: Vec<Place>,
    steps: Cell<u64>,
}

/// Where an element stands among its siblings, from 1.
#[derive(Clone, Copy, Default)]
struct Place {
    index: u32,
    from_end: u32,
    of_type: u32,
    of_type_from_end: u32,
}

impl Matcher {
    pub(in crate::style) fn new(document: &Document<'_>) -> Self {
        let count = document
            .descendants()
            .map(|node| node.id().get_usize())
            .max();
        let mut places = vec![Place::default(); count.unwrap_or(0) + 1];
        for parent in document.descendants().filter(Node::has_children) {
            let mut types: BTreeMap<_, u32> = BTreeMap::new();
            let mut index = 0;
            for child in parent.children().filter(Node::is_element) {
                index += 1;
                let of_type = types.entry(type_of(child)).or_default();
                *of_type += 1;
                if let Some(place) = places.get_mut(child.id().get_usize()) {
                    (place.index, place.of_type) = (index, *of_type);
                }
            }
            for child in parent.children().filter(Node::is_element) {
                let of_type = types.get(&type_of(child)).copied().unwrap_or(0);
                if let Some(place) = places.get_mut(child.id().get_usize()) {
                    place.from_end = index + 1 - place.index;
                    place.of_type_from_end = of_type + 1 - place.of_type;
                }
            }
        }
        Self {
            places,
            steps: Cell::new(0),
        }
    }

    /// # Errors
    /// [`BakeError::Limit`] once the selectors have taken more than [`MAX_STEPS`].
    pub(in crate::style) fn check(&self) -> Result<(), BakeError> {
        match self.steps.get() > MAX_STEPS {
            true => Err(BakeError::Limit(
                "the selectors of the style sheets ask for too much work".to_owned(),
            )),
            false => Ok(()),
        }
    }

    /// Counts work that comes of matches.
    pub(in crate::style) fn spend(&self, steps: usize) {
        let steps = u64::try_from(steps).unwrap_or(u64::MAX);
        self.steps.set(self.steps.get().saturating_add(steps));
    }

    /// Whether `node` matches. Past the limit of work the answer is no, see [`Self::check`].
    pub(in crate::style) fn matches(&self, node: Node<'_, '_>, selector: &Selector) -> bool {
        self.leftwards(node, &selector.compounds, None)
    }

    fn any(&self, node: Node<'_, '_>, list: &[Selector]) -> bool {
        list.iter().any(|selector| self.matches(node, selector))
    }

    /// `anchor` is what the leftmost combinator of a relative selector leads to.
    fn leftwards(
        &self,
        node: Node<'_, '_>,
        compounds: &[(Combinator, Vec<Simple>)],
        anchor: Option<Node<'_, '_>>,
    ) -> bool {
        let Some(((combinator, compound), left)) = compounds.split_last() else {
            return anchor.is_none_or(|anchor| anchor == node);
        };
        self.spend(1 + node.attributes().len() / ATTRIBUTES_A_STEP);
        if self.steps.get() > MAX_STEPS || !compound.iter().all(|s| self.simple(node, s)) {
            return false;
        }
        if left.is_empty() && anchor.is_none() {
            return true;
        }
        match combinator {
            Combinator::Child => node
                .parent_element()
                .is_some_and(|n| self.leftwards(n, left, anchor)),
            Combinator::Next => node
                .prev_sibling_element()
                .is_some_and(|n| self.leftwards(n, left, anchor)),
            Combinator::Descendant => {
                let mut ancestors = node.ancestors().skip(1).filter(Node::is_element);
                ancestors.any(|n| self.leftwards(n, left, anchor))
            }
            Combinator::Later => {
                let mut before = node.prev_siblings().skip(1).filter(Node::is_element);
                before.any(|n| self.leftwards(n, left, anchor))
            }
        }
    }

    fn simple(&self, node: Node<'_, '_>, simple: &Simple) -> bool {
        match simple {
            Simple::Type(name, namespace) => {
                let tag = node.tag_name();
                name.as_ref().is_none_or(|name| **name == *tag.name())
                    && namespace
                        .as_ref()
                        .is_none_or(|n| **n == *tag.namespace().unwrap_or(""))
            }
            Simple::Id(id) => node.attribute("id") == Some(&**id),
            Simple::Class(class) => {
                let classes = node.attribute("class").unwrap_or("");
                self.spend(classes.len() / BYTES_A_STEP);
                classes
                    .split_ascii_whitespace()
                    .any(|name| *name == **class)
            }
            Simple::Attribute(attribute) => {
                let found = node.attributes().find(|a| a.name() == &*attribute.name);
                found.is_some_and(|found| {
                    self.spend(found.value().len() / BYTES_A_STEP);
                    holds(found.value(), attribute)
                })
            }
            Simple::Not(list) => !self.any(node, list) && self.steps.get() <= MAX_STEPS,
            Simple::Is(list) => self.any(node, list),
            Simple::Has(list) => list.iter().any(|selector| self.has(node, selector)),
            Simple::Nth(nth) => self.nth(node, nth),
            Simple::Root => node.parent_element().is_none(),
            Simple::Empty => !node
                .children()
                .any(|c| c.is_element() || c.text().is_some_and(|t| !t.is_empty())),
            Simple::Link => node.tag_name().name() == "a" && node.attribute("href").is_some(),
            Simple::Lang(names) => {
                self.spend(node.ancestors().count());
                names.iter().any(|name| speaks(node, name))
            }
            Simple::Never => false,
        }
    }

    fn has(&self, anchor: Node<'_, '_>, selector: &Selector) -> bool {
        let first = selector
            .compounds
            .first()
            .map(|(combinator, _)| *combinator);
        let is_beside = matches!(first, Some(Combinator::Next | Combinator::Later));
        let within = |node: Node<'_, '_>| {
            let mut candidates = node.descendants().filter(Node::is_element);
            candidates.any(|n| n != anchor && self.within(n, selector, anchor))
        };
        match is_beside {
            false => within(anchor),
            true => anchor.next_siblings().skip(1).any(within),
        }
    }

    fn within(&self, node: Node<'_, '_>, selector: &Selector, anchor: Node<'_, '_>) -> bool {
        self.steps.get() <= MAX_STEPS && self.leftwards(node, &selector.compounds, Some(anchor))
    }

    fn nth(&self, node: Node<'_, '_>, nth: &Nth) -> bool {
        let place = self
            .places
            .get(node.id().get_usize())
            .copied()
            .unwrap_or_default();
        let index = match &nth.of {
            Some(list) => {
                let counted = |n: &Node<'_, '_>| n.is_element() && self.any(*n, list);
                if !counted(&node) {
                    return false;
                }
                let count = match nth.from_end {
                    true => node.next_siblings().filter(counted).count(),
                    false => node.prev_siblings().filter(counted).count(),
                };
                i64::try_from(count).unwrap_or(i64::MAX)
            }
            None => i64::from(match (nth.of_type, nth.from_end) {
                (false, false) => place.index,
                (false, true) => place.from_end,
                (true, false) => place.of_type,
                (true, true) => place.of_type_from_end,
            }),
        };
        let beyond = index.saturating_sub(nth.offset);
        match nth.step {
            0 => beyond == 0,
            step => beyond.checked_rem(step) == Some(0) && beyond.signum() * step.signum() >= 0,
        }
    }
}

fn type_of<'a>(node: Node<'a, '_>) -> (Option<&'a str>, &'a str) {
    (node.tag_name().namespace(), node.tag_name().name())
}

fn holds(found: &str, wanted: &Attribute) -> bool {
    let lower = |text: &str| match wanted.ignores_case {
        true => text.to_ascii_lowercase(),
        false => text.to_owned(),
    };
    let (found, value) = (lower(found), lower(&wanted.value));
    let value = value.as_str();
    match wanted.operator {
        '=' => found == value,
        '~' => found.split_ascii_whitespace().any(|word| word == value),
        '|' => found
            .strip_prefix(value)
            .is_some_and(|r| r.is_empty() || r.starts_with('-')),
        '^' => !value.is_empty() && found.starts_with(value),
        '$' => !value.is_empty() && found.ends_with(value),
        '*' => !value.is_empty() && found.contains(value),
        _ => true,
    }
}

fn speaks(node: Node<'_, '_>, name: &str) -> bool {
    let language = node
        .ancestors()
        .find_map(|n| n.attributes().find(|a| a.name() == "lang"));
    let language = language
        .map(|a| a.value().to_ascii_lowercase())
        .unwrap_or_default();
    match language.strip_prefix(name) {
        Some(rest) => rest.is_empty() || rest.starts_with('-'),
        None => false,
    }
}
