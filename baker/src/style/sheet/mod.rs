//! Style sheets to rules with a place in the cascade.

pub(super) mod condition;
pub(super) mod matching;
pub(super) mod selector;

use std::rc::Rc;

use vtex_format::WarningCode;

use super::syntax::{self, Value, split, trim, trim_start, words};
use crate::error::BakeError;
use crate::warning::Warnings;
use condition::Medium;
use selector::{List, Scope};

/// Most rules of a document's sheets, those in others counted. The largest sheets of drawing
/// programs have some thousands.
const MAX_RULES: usize = 100_000;

/// Most layers, and most prefixes of namespaces. Written sheets have fewer than ten; each new one is
/// compared with all before.
const MAX_NAMES: usize = 1000;

/// `name: value`, with `!important` taken off.
#[derive(Clone, Debug)]
pub(super) struct Declaration {
    /// In lower case, but for custom properties.
    pub(super) name: Rc<str>,
    pub(super) value: Rc<[Value]>,
    pub(super) is_important: bool,
    /// Whether the name was written with capitals, which usvg does not know.
    pub(super) has_capitals: bool,
}

/// A block of declarations and the elements that they are for.
#[derive(Debug)]
pub(super) struct Rule {
    pub(super) selectors: List,
    pub(super) declarations: Rc<[Declaration]>,
    /// Index in [`Sheets::layer_ranks`].
    pub(super) layer: usize,
}

/// Name, first value, and whether it is inherited.
pub(super) type Registered = (Rc<str>, Option<Rc<[Value]>>, bool);

/// All rules of a document that are for its picture.
#[derive(Debug)]
pub(super) struct Sheets {
    pub(super) rules: Vec<Rule>,
    /// For each layer its rank among all: a greater one wins.
    pub(super) layer_ranks: Vec<usize>,
    /// `@property`: names, first values, and whether they are inherited.
    pub(super) registered: Vec<Registered>,
    /// Whether an at-rule, a nested rule or a mark was met that usvg does not read as CSS does.
    pub(super) is_beyond_usvg: bool,
}

impl Sheets {
    /// Parses the texts of a document's sheets in their order.
    ///
    /// # Errors
    /// [`BakeError::Limit`] for sheets that nest too deep or have too many rules.
    pub(super) fn parse(
        texts: &[String],
        medium: Medium,
        warnings: &Warnings,
    ) -> Result<Self, BakeError> {
        let mut reader = Reader {
            // Layer 0 is that of rules outside of all layers.
            layers: vec![Vec::new()],
            sheets: Self {
                rules: Vec::new(),
                layer_ranks: Vec::new(),
                registered: Vec::new(),
                is_beyond_usvg: false,
            },
            names: Vec::new(),
            medium,
            warnings,
        };
        for text in texts {
            let values = syntax::parse(text)?;
            let mut scope = Scope::default();
            reader.rules(&values, &mut scope, 0)?;
        }
        reader.sheets.layer_ranks = ranks(&reader.layers);
        Ok(reader.sheets)
    }
}

/// Ranks of layers, given as paths of indices: what a layer holds itself comes after its sublayers.
fn ranks(layers: &[Vec<usize>]) -> Vec<usize> {
    let key = |layer: usize| {
        let mut path = layers.get(layer).cloned().unwrap_or_default();
        path.push(usize::MAX);
        path
    };
    let mut order: Vec<usize> = (0..layers.len()).collect();
    order.sort_by_key(|&layer| key(layer));
    let mut ranks = vec![0; layers.len()];
    for (rank, layer) in order.into_iter().enumerate() {
        if let Some(place) = ranks.get_mut(layer) {
            *place = rank;
        }
    }
    ranks
}

struct Reader<'a> {
    sheets: Sheets,
    /// Path of each layer: its index among its siblings on each level.
    layers: Vec<Vec<usize>>,
    /// The layer above, name, and the layer.
    names: Vec<(usize, String, usize)>,
    medium: Medium,
    warnings: &'a Warnings,
}

impl Reader<'_> {
    /// Reads a list of rules.
    fn rules(
        &mut self,
        mut rest: &[Value],
        scope: &mut Scope,
        layer: usize,
    ) -> Result<(), BakeError> {
        while let Some((first, after)) = rest.split_first() {
            match first {
                Value::Space => rest = after,
                Value::Comment => {
                    self.sheets.is_beyond_usvg = true;
                    rest = after;
                }
                Value::AtKeyword(name) => {
                    let (prelude, block, after) = cut_at_rule(after);
                    self.at_rule(name, prelude, block, scope, layer)?;
                    rest = after;
                }
                _ => {
                    let is_block = |value: &Value| matches!(value, Value::Block('{', _));
                    let Some(at) = rest.iter().position(is_block) else {
                        return Ok(());
                    };
                    if let (prelude, [Value::Block(_, block), after @ ..]) = rest.split_at(at) {
                        let selectors = match scope.parent {
                            Some(_) => selector::parse_nested(prelude, scope),
                            None => selector::parse_list(prelude, scope),
                        };
                        match selectors {
                            Some(selectors) => self.block(block, selectors, scope, layer)?,
                            None => self.sheets.is_beyond_usvg = true,
                        }
                        rest = after;
                    }
                }
            }
        }
        Ok(())
    }

    /// Reads the content of a rule: declarations and rules within it.
    fn block(
        &mut self,
        values: &[Value],
        selectors: List,
        scope: &Scope,
        layer: usize,
    ) -> Result<(), BakeError> {
        let mut inner = Scope {
            parent: Some(Rc::clone(&selectors)),
            namespaces: Rc::clone(&scope.namespaces),
        };
        let mut declarations = Vec::new();
        let mut rest = values;
        while let Some((first, after)) = rest.split_first() {
            if matches!(first, Value::Space) || first.is_delim(';') {
                rest = after;
            } else if let Value::AtKeyword(name) = first {
                self.sheets.is_beyond_usvg = true;
                self.flush(&mut declarations, &selectors, layer)?;
                let (prelude, block, after) = cut_at_rule(after);
                self.at_rule(name, prelude, block, &mut inner, layer)?;
                rest = after;
            } else if let Some((declaration, after)) = declaration(rest) {
                declarations.extend(declaration);
                rest = after;
            } else {
                self.sheets.is_beyond_usvg = true;
                self.flush(&mut declarations, &selectors, layer)?;
                let ends = |v: &Value| matches!(v, Value::Block('{', _)) || v.is_delim(';');
                let end = rest.iter().position(ends).map_or(rest.len(), |at| at + 1);
                let (rule, after) = rest.split_at(end);
                if matches!(rule.last(), Some(Value::Block('{', _))) {
                    self.rules(rule, &mut inner, layer)?;
                }
                rest = after;
            }
        }
        self.flush(&mut declarations, &selectors, layer)
    }

    fn check_names(&self, scope: &Scope) -> Result<(), BakeError> {
        match self.layers.len().max(scope.namespaces.len()) > MAX_NAMES {
            true => Err(BakeError::Limit(format!(
                "the style sheets have more than {MAX_NAMES} layers or namespaces"
            ))),
            false => Ok(()),
        }
    }

    fn flush(
        &mut self,
        declarations: &mut Vec<Declaration>,
        selectors: &List,
        layer: usize,
    ) -> Result<(), BakeError> {
        if declarations.is_empty() {
            return Ok(());
        }
        if self.sheets.rules.len() >= MAX_RULES {
            let message = format!("the style sheets have more than {MAX_RULES} rules");
            return Err(BakeError::Limit(message));
        }
        self.sheets.rules.push(Rule {
            selectors: Rc::clone(selectors),
            declarations: std::mem::take(declarations).into(),
            layer,
        });
        Ok(())
    }

    fn at_rule(
        &mut self,
        name: &str,
        prelude: &[Value],
        block: Option<&[Value]>,
        scope: &mut Scope,
        layer: usize,
    ) -> Result<(), BakeError> {
        let prelude = trim(prelude);
        self.check_names(scope)?;
        self.sheets.is_beyond_usvg |= !matches!(name, "font-face" | "charset" | "page");
        match (name, block) {
            ("media", Some(block)) if self.medium.shows(prelude) => self.inner(block, scope, layer),
            ("supports", Some(block)) if condition::is_supported(prelude) => {
                self.inner(block, scope, layer)
            }
            ("layer", Some(block)) => {
                let layer = self.layer(layer, prelude);
                self.inner(block, scope, layer)
            }
            ("layer", None) => {
                for name in split(prelude, ',') {
                    self.layer(layer, name);
                }
                Ok(())
            }
            ("namespace", None) => {
                match words(prelude).as_slice() {
                    [Value::Url(uri) | Value::String(uri)] => {
                        Rc::make_mut(&mut scope.namespaces).push(("".into(), Rc::clone(uri)));
                    }
                    [Value::Ident(prefix), Value::Url(uri) | Value::String(uri)] => {
                        Rc::make_mut(&mut scope.namespaces)
                            .push((Rc::clone(prefix), Rc::clone(uri)));
                    }
                    _ => {}
                }
                Ok(())
            }
            ("property", Some(block)) => {
                self.register(prelude, block);
                Ok(())
            }
            ("import", _) => {
                self.left_out("@import", "style sheets in other files are not read");
                Ok(())
            }
            ("container" | "scope" | "starting-style", Some(_)) => {
                self.left_out(&format!("@{name}"), "its rules are not applied");
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// The content of a conditional rule; within another rule it may hold declarations.
    fn inner(&mut self, block: &[Value], scope: &mut Scope, layer: usize) -> Result<(), BakeError> {
        match scope.parent.clone() {
            Some(parent) => self.block(block, parent, scope, layer),
            None => self.rules(block, scope, layer),
        }
    }

    fn register(&mut self, prelude: &[Value], block: &[Value]) {
        let [Value::Ident(name)] = prelude else {
            return;
        };
        let declarations = declarations(block);
        let find = |wanted: &str| declarations.iter().find(|d| &*d.name == wanted);
        let first = find("initial-value").map(|d| Rc::clone(&d.value));
        let inherits = find("inherits").is_none_or(|d| syntax::text(&d.value) != "false");
        self.sheets
            .registered
            .push((Rc::clone(name), first, inherits));
    }

    /// The layer that `name` (with dots) is below `above`; one without a name is new each time.
    fn layer(&mut self, above: usize, name: &[Value]) -> usize {
        let parts = name.iter().filter_map(|value| match value {
            Value::Ident(part) => Some(part.to_string()),
            _ => None,
        });
        let mut parts: Vec<String> = parts.collect();
        if parts.is_empty() {
            parts.push(format!("({})", self.layers.len()));
        }
        parts.into_iter().fold(above, |above, part| {
            let known = self
                .names
                .iter()
                .find(|(a, name, _)| *a == above && *name == part);
            if let Some((_, _, layer)) = known {
                return *layer;
            }
            let siblings = self.names.iter().filter(|(a, _, _)| *a == above).count();
            let mut path = self.layers.get(above).cloned().unwrap_or_default();
            path.push(siblings);
            self.layers.push(path);
            let layer = self.layers.len() - 1;
            self.names.push((above, part, layer));
            layer
        })
    }

    fn left_out(&self, feature: &str, message: &str) {
        self.warnings
            .push(WarningCode::Reduced, feature, "", message);
    }
}

/// Prelude and block of an at-rule, and what follows it.
fn cut_at_rule(values: &[Value]) -> (&[Value], Option<&[Value]>, &[Value]) {
    let ends = |value: &Value| matches!(value, Value::Block('{', _)) || value.is_delim(';');
    let Some(at) = values.iter().position(ends) else {
        return (values, None, &[]);
    };
    match values.split_at(at) {
        (prelude, [Value::Block(_, block), after @ ..]) => (prelude, Some(block), after),
        (prelude, [_, after @ ..]) => (prelude, None, after),
        (prelude, []) => (prelude, None, &[]),
    }
}

/// The declarations of a `style` attribute.
pub(super) fn declarations(values: &[Value]) -> Vec<Declaration> {
    let mut found = Vec::new();
    let mut rest = trim(values);
    while !rest.is_empty() {
        let is_end = |value: &Value| value.is_delim(';');
        match declaration(trim_start(rest)) {
            Some((declaration, after)) => {
                found.extend(declaration);
                rest = after;
            }
            None => {
                let end = rest.iter().position(is_end).map_or(rest.len(), |at| at + 1);
                rest = &rest[end..];
            }
        }
    }
    found
}

/// Reads `name: value;`. `None` where the text is no declaration; a declaration without a value
/// that could count gives nothing and is passed over.
fn declaration(values: &[Value]) -> Option<(Option<Declaration>, &[Value])> {
    let (Value::Ident(written), after) = values.split_first()? else {
        return None;
    };
    let after = match after {
        [Value::Space, rest @ ..] => rest,
        rest => rest,
    };
    let [Value::Delim(':'), after @ ..] = after else {
        return None;
    };
    let is_custom = written.starts_with("--");
    // A block makes it a rule, and what follows the block is the next one.
    let is_end =
        |value: &Value| value.is_delim(';') || !is_custom && matches!(value, Value::Block('{', _));
    let end = after.iter().position(is_end);
    if end.is_some_and(|end| matches!(after.get(end), Some(Value::Block(..)))) {
        return None;
    }
    let (value, rest) = match end {
        Some(end) => (&after[..end], &after[end + 1..]),
        None => (after, &after[after.len()..]),
    };
    let mut value = trim(value);
    let mut is_important = false;
    if let [before @ .., last] = value
        && last.keyword().as_deref() == Some("important")
        && let [before @ .., Value::Delim('!')] = trim(before)
    {
        (value, is_important) = (trim(before), true);
    }
    if value.is_empty() && !is_custom {
        return Some((None, rest));
    }
    let name = match is_custom {
        true => Rc::clone(written),
        false => written.to_ascii_lowercase().into(),
    };
    let has_capitals = !is_custom && written.bytes().any(|byte| byte.is_ascii_uppercase());
    let value = value.into();
    Some((
        Some(Declaration {
            name,
            value,
            is_important,
            has_capitals,
        }),
        rest,
    ))
}
