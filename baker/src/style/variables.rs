//! Custom properties, and `var()` in values.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::syntax::{MAX_NESTING, Value, trim};
use crate::error::BakeError;

/// Most component values of one value once its variables are put in. Written values have some
/// dozens; a bomb of variables that hold others twice has billions.
const MAX_VALUES: usize = 1 << 16;
/// Most component values that all variables of a document put in.
const MAX_WORK: usize = 1 << 24;
/// Variables that refer to each other in a row. Real sheets stay below 10; each takes stack.
const MAX_CHAIN: usize = 256;

/// The custom properties of an element; those that it inherits are those of `above`.
#[derive(Debug, Default)]
pub(super) struct Custom {
    own: BTreeMap<Rc<str>, Option<Rc<[Value]>>>,
    above: Option<Rc<Self>>,
    /// How many scopes lie above.
    depth: usize,
}

impl Custom {
    fn get(&self, name: &str) -> Option<&Rc<[Value]>> {
        let mut scope = Some(self);
        while let Some(here) = scope {
            if let Some(value) = here.own.get(name) {
                return value.as_ref();
            }
            scope = here.above.as_deref();
        }
        None
    }
}

/// Counts what substitution costs.
#[derive(Debug, Default)]
pub(super) struct Variables {
    work: usize,
}

impl Variables {
    /// The custom properties of an element: the declared ones, winners of the cascade, on those
    /// that it inherits.
    pub(super) fn resolve(
        &mut self,
        declared: BTreeMap<Rc<str>, Rc<[Value]>>,
        above: &Rc<Custom>,
    ) -> Result<Rc<Custom>, BakeError> {
        if declared.is_empty() {
            return Ok(Rc::clone(above));
        }
        let mut resolution = Resolution {
            declared: &declared,
            above,
            done: BTreeMap::new(),
            path: Vec::new(),
            cyclic: BTreeSet::new(),
            variables: self,
        };
        for name in declared.keys() {
            resolution.value_of(name)?;
        }
        let own = resolution.done;
        Ok(Rc::new(Custom {
            own,
            above: Some(Rc::clone(above)),
            depth: above.depth + 1,
        }))
    }

    /// `values` with its variables put in; `None` where one has no value.
    pub(super) fn substitute(
        &mut self,
        values: &[Value],
        custom: &Custom,
    ) -> Result<Option<Rc<[Value]>>, BakeError> {
        let mut lookup = |variables: &mut Self, name: &Rc<str>| {
            variables.work = variables.work.saturating_add(custom.depth);
            Ok(custom.get(name).cloned())
        };
        self.put_in(values, &mut lookup)
    }

    fn put_in(
        &mut self,
        values: &[Value],
        lookup: &mut Lookup<'_>,
    ) -> Result<Option<Rc<[Value]>>, BakeError> {
        let mut out = Vec::new();
        for value in values {
            let mut more = 1;
            match value {
                Value::Function(name, inner) if &**name == "var" => {
                    let (name, fallback) = cut(inner);
                    let found = match name {
                        Some(name) => lookup(self, name)?,
                        None => None,
                    };
                    let found = match (found, fallback) {
                        (Some(found), _) => Some(found),
                        (None, Some(fallback)) => self.put_in(fallback, lookup)?,
                        (None, None) => None,
                    };
                    let Some(found) = found else {
                        return Ok(None);
                    };
                    more = size(&found);
                    out.extend(found.iter().cloned());
                }
                Value::Function(name, inner) => {
                    let Some(inner) = self.put_in(inner, lookup)? else {
                        return Ok(None);
                    };
                    out.push(Value::Function(Rc::clone(name), inner));
                }
                Value::Block(open, inner) => {
                    let Some(inner) = self.put_in(inner, lookup)? else {
                        return Ok(None);
                    };
                    out.push(Value::Block(*open, inner));
                }
                other => out.push(other.clone()),
            }
            self.work = self.work.saturating_add(more);
            if self.work > MAX_WORK || out.len() > MAX_VALUES {
                return Err(too_much());
            }
        }
        if size(&out) > MAX_VALUES || depth(&out) > 2 * MAX_NESTING {
            return Err(too_much());
        }
        Ok(Some(out.into()))
    }
}

type Lookup<'a> =
    dyn FnMut(&mut Variables, &Rc<str>) -> Result<Option<Rc<[Value]>>, BakeError> + 'a;

struct Resolution<'a> {
    declared: &'a BTreeMap<Rc<str>, Rc<[Value]>>,
    above: &'a Custom,
    done: BTreeMap<Rc<str>, Option<Rc<[Value]>>>,
    /// Names whose values are being computed.
    path: Vec<Rc<str>>,
    cyclic: BTreeSet<Rc<str>>,
    variables: &'a mut Variables,
}

impl Resolution<'_> {
    fn value_of(&mut self, name: &Rc<str>) -> Result<Option<Rc<[Value]>>, BakeError> {
        if let Some(done) = self.done.get(name) {
            return Ok(done.clone());
        }
        let Some(values) = self.declared.get(name).cloned() else {
            self.variables.work = self.variables.work.saturating_add(self.above.depth);
            return Ok(self.above.get(name).cloned());
        };
        if let Some(at) = self.path.iter().position(|step| step == name) {
            self.cyclic.extend(self.path.iter().skip(at).cloned());
            return Ok(None);
        }
        if self.path.len() >= MAX_CHAIN {
            return Err(too_much());
        }
        let keyword = match &*values {
            [value] => value.keyword(),
            _ => None,
        };
        let value = match keyword.as_deref() {
            Some("inherit" | "unset" | "revert" | "revert-layer") => self.above.get(name).cloned(),
            Some("initial") => None,
            _ => {
                self.path.push(Rc::clone(name));
                let mut variables = std::mem::take(self.variables);
                let found = variables.put_in(&values, &mut |inner, name| {
                    std::mem::swap(self.variables, inner);
                    let value = self.value_of(name);
                    std::mem::swap(self.variables, inner);
                    value
                });
                *self.variables = variables;
                self.path.pop();
                found?.filter(|_| !self.cyclic.contains(name))
            }
        };
        self.done.insert(Rc::clone(name), value.clone());
        Ok(value)
    }
}

/// The name in `var()`, and what follows the comma.
fn cut(inner: &[Value]) -> (Option<&Rc<str>>, Option<&[Value]>) {
    let comma = inner.iter().position(|value| value.is_delim(','));
    let (name, fallback) = match comma {
        Some(at) => (&inner[..at], Some(trim(&inner[at + 1..]))),
        None => (inner, None),
    };
    match trim(name) {
        [Value::Ident(name)] if name.starts_with("--") => (Some(name), fallback),
        _ => (None, None),
    }
}

/// Whether `values` hold a variable.
pub(super) fn has_variable(values: &[Value]) -> bool {
    values.iter().any(|value| match value {
        Value::Function(name, inner) => &**name == "var" || has_variable(inner),
        Value::Block(_, inner) => has_variable(inner),
        _ => false,
    })
}

fn size(values: &[Value]) -> usize {
    let inner = |value: &Value| match value {
        Value::Function(_, inner) | Value::Block(_, inner) => 1 + size(inner),
        _ => 1,
    };
    values.iter().map(inner).sum()
}

fn depth(values: &[Value]) -> usize {
    let inner = |value: &Value| match value {
        Value::Function(_, inner) | Value::Block(_, inner) => 1 + depth(inner),
        _ => 0,
    };
    values.iter().map(inner).max().unwrap_or(0)
}

fn too_much() -> BakeError {
    BakeError::Limit("the variables of the style sheets expand to too much".to_owned())
}
