//! Selectors (Selectors 4) as far as a document that does not change can match them.

use std::rc::Rc;

use crate::style::syntax::{Value, split, trim, words};

/// Most compounds of a selector; matching takes stack for each. A longer selector is none.
const MAX_COMPOUNDS: usize = 256;

/// A list of selectors, of which one must match.
pub(in crate::style) type List = Rc<[Selector]>;

/// How an element relates to that of the compound to its left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::style) enum Combinator {
    Descendant,
    Child,
    Next,
    Later,
}

/// Compounds from left to right. The combinator stands before its compound; that of the first one
/// matters in relative selectors alone.
#[derive(Clone, Debug)]
pub(in crate::style) struct Selector {
    pub(in crate::style) compounds: Vec<(Combinator, Vec<Simple>)>,
    /// Ids; classes, attributes and pseudo-classes; types.
    pub(in crate::style) specificity: [u32; 3],
}

#[derive(Clone, Debug)]
pub(in crate::style) enum Simple {
    /// A local name, and its namespace where one is asked for.
    Type(Option<Rc<str>>, Option<Rc<str>>),
    Id(Rc<str>),
    Class(Rc<str>),
    Attribute(Attribute),
    Not(List),
    Is(List),
    Has(List),
    /// `an + b` counted from the start or the end, among all or among those of a type.
    Nth(Nth),
    Root,
    Empty,
    Link,
    Lang(Vec<String>),
    /// A state that a picture is never in, as `:hover`.
    Never,
}

#[derive(Clone, Debug)]
pub(in crate::style) struct Attribute {
    pub(in crate::style) name: Rc<str>,
    /// `=`, `~`, `|`, `^`, `$`, `*`, or a space where the attribute need only be there.
    pub(in crate::style) operator: char,
    pub(in crate::style) value: Rc<str>,
    pub(in crate::style) ignores_case: bool,
}

#[derive(Clone, Debug)]
pub(in crate::style) struct Nth {
    pub(in crate::style) step: i64,
    pub(in crate::style) offset: i64,
    pub(in crate::style) from_end: bool,
    pub(in crate::style) of_type: bool,
    pub(in crate::style) of: Option<List>,
}

/// What selectors refer to beyond their own text.
#[derive(Clone, Debug, Default)]
pub(in crate::style) struct Scope {
    /// What `&` stands for.
    pub(in crate::style) parent: Option<List>,
    /// Prefix and namespace; the default one has an empty prefix.
    pub(in crate::style) namespaces: Rc<Vec<(Rc<str>, Rc<str>)>>,
}

/// Parses a list of selectors; `None` where one of them is no selector.
pub(in crate::style) fn parse_list(values: &[Value], scope: &Scope) -> Option<List> {
    let parts = split(values, ',');
    let list: Option<Vec<_>> = parts.iter().map(|part| parse(part, scope, false)).collect();
    Some(list?.into())
}

/// As [`parse_list`], without those that are no selectors.
fn forgiving_list(values: &[Value], scope: &Scope) -> List {
    let parts = split(values, ',');
    parts
        .iter()
        .filter_map(|part| parse(part, scope, false))
        .collect()
}

/// Parses the selectors of a rule within a rule: those without `&` are for descendants.
pub(in crate::style) fn parse_nested(values: &[Value], scope: &Scope) -> Option<List> {
    let parts = split(values, ',');
    let list: Option<Vec<_>> = parts.iter().map(|part| nested(part, scope)).collect();
    Some(list?.into())
}

fn nested(values: &[Value], scope: &Scope) -> Option<Selector> {
    if names_parent(values) {
        return parse(values, scope, false);
    }
    let mut selector = parse(values, scope, true)?;
    let parent = scope.parent.clone()?;
    add(&mut selector.specificity, greatest(&parent));
    let compound = (Combinator::Descendant, vec![Simple::Is(parent)]);
    selector.compounds.insert(0, compound);
    Some(selector)
}

fn names_parent(values: &[Value]) -> bool {
    values.iter().any(|value| match value {
        Value::Function(_, inner) => names_parent(inner),
        other => other.is_delim('&'),
    })
}

/// Parses one selector; `relative` ones may begin with a combinator.
fn parse(values: &[Value], scope: &Scope, relative: bool) -> Option<Selector> {
    let mut rest = trim(values);
    let mut selector = Selector {
        compounds: Vec::new(),
        specificity: [0; 3],
    };
    let mut before = Combinator::Descendant;
    if let (true, Some((combinator, after))) = (relative, explicit(rest)) {
        (before, rest) = (combinator, trim(after));
    }
    while !rest.is_empty() && selector.compounds.len() < MAX_COMPOUNDS {
        let (compound, after) = compound(rest, scope, &mut selector.specificity)?;
        selector.compounds.push((before, compound));
        let trimmed = trim(after);
        if trimmed.is_empty() {
            return Some(selector);
        }
        (before, rest) = match explicit(trimmed) {
            Some((combinator, after)) => (combinator, trim(after)),
            None if trimmed.len() < after.len() => (Combinator::Descendant, trimmed),
            None => return None,
        };
    }
    None
}

fn explicit(values: &[Value]) -> Option<(Combinator, &[Value])> {
    let (first, rest) = values.split_first()?;
    let combinator = match first {
        Value::Delim('>') => Combinator::Child,
        Value::Delim('+') => Combinator::Next,
        Value::Delim('~') => Combinator::Later,
        _ => return None,
    };
    Some((combinator, rest))
}

type Compound<'a> = (Vec<Simple>, &'a [Value]);

fn compound<'a>(
    values: &'a [Value],
    scope: &Scope,
    specificity: &mut [u32; 3],
) -> Option<Compound<'a>> {
    let mut simples = Vec::new();
    let mut rest = values;
    loop {
        rest = match rest {
            [Value::Delim('.'), Value::Ident(name), after @ ..] => {
                simples.push(Simple::Class(Rc::clone(name)));
                specificity[1] += 1;
                after
            }
            [Value::Hash(name), after @ ..] => {
                simples.push(Simple::Id(Rc::clone(name)));
                specificity[0] += 1;
                after
            }
            [Value::Block('[', inner), after @ ..] => {
                simples.push(Simple::Attribute(attribute(inner)?));
                specificity[1] += 1;
                after
            }
            // Pseudo-elements are boxes of HTML; no element of SVG has them.
            [Value::Delim(':'), Value::Delim(':'), _, after @ ..] => {
                simples.push(Simple::Never);
                after
            }
            [Value::Delim(':'), pseudo, after @ ..] => {
                simples.push(pseudo_class(pseudo, scope, specificity)?);
                after
            }
            [Value::Delim('&'), after @ ..] => {
                // At the top of a sheet it is the root.
                simples.push(match &scope.parent {
                    Some(parent) => {
                        add(specificity, greatest(parent));
                        Simple::Is(Rc::clone(parent))
                    }
                    None => Simple::Root,
                });
                after
            }
            [Value::Ident(_) | Value::Delim('*' | '|'), ..] if simples.is_empty() => {
                let (simple, after) = type_selector(rest, scope)?;
                specificity[2] += u32::from(matches!(&simple, Simple::Type(Some(_), _)));
                simples.push(simple);
                after
            }
            _ => break,
        };
    }
    (!simples.is_empty()).then_some((simples, rest))
}

fn type_selector<'a>(values: &'a [Value], scope: &Scope) -> Option<(Simple, &'a [Value])> {
    let local = |value: &Value| match value {
        Value::Ident(name) => Some(Some(Rc::clone(name))),
        Value::Delim('*') => Some(None),
        _ => None,
    };
    let of_prefix = |prefix: &str| {
        let found = scope
            .namespaces
            .iter()
            .rev()
            .find(|(name, _)| &**name == prefix);
        found.map(|(_, namespace)| Rc::clone(namespace))
    };
    match values {
        [Value::Delim('*'), Value::Delim('|'), name, after @ ..] => {
            Some((Simple::Type(local(name)?, None), after))
        }
        [Value::Ident(prefix), Value::Delim('|'), name, after @ ..] => {
            Some((Simple::Type(local(name)?, Some(of_prefix(prefix)?)), after))
        }
        [Value::Delim('|'), name, after @ ..] => {
            Some((Simple::Type(local(name)?, Some("".into())), after))
        }
        [name, after @ ..] => Some((Simple::Type(local(name)?, of_prefix("")), after)),
        [] => None,
    }
}

fn attribute(values: &[Value]) -> Option<Attribute> {
    let mut words: &[&Value] = &words(values);
    // A prefix is not looked up: `xlink|href` and `href` are the same to usvg too.
    if let [
        Value::Ident(_) | Value::Delim('*'),
        Value::Delim('|'),
        rest @ ..,
    ] = words
        && matches!(rest, [Value::Ident(_), ..])
    {
        words = rest;
    }
    let Some((Value::Ident(name), rest)) = words.split_first() else {
        return None;
    };
    let (operator, rest) = match rest {
        [] => (' ', rest),
        [Value::Delim('='), rest @ ..] => ('=', rest),
        [
            Value::Delim(c @ ('~' | '|' | '^' | '$' | '*')),
            Value::Delim('='),
            rest @ ..,
        ] => (*c, rest),
        _ => return None,
    };
    let (value, flag) = match rest {
        [] if operator == ' ' => (Rc::from(""), None),
        [Value::Ident(text) | Value::String(text)] => (Rc::clone(text), None),
        [Value::Ident(text) | Value::String(text), flag] => (Rc::clone(text), Some(*flag)),
        _ => return None,
    };
    let ignores_case = match flag.map(Value::keyword) {
        None => false,
        Some(Some(flag)) if flag == "i" => true,
        Some(Some(flag)) if flag == "s" => false,
        _ => return None,
    };
    Some(Attribute {
        name: Rc::clone(name),
        operator,
        value,
        ignores_case,
    })
}

fn pseudo_class(value: &Value, scope: &Scope, specificity: &mut [u32; 3]) -> Option<Simple> {
    if let Some(name) = value.keyword() {
        // These four may be written as classes and are elements.
        let element = ["before", "after", "first-line", "first-letter"];
        if element.contains(&name.as_str()) {
            return Some(Simple::Never);
        }
        specificity[1] += 1;
        return plain_pseudo_class(&name);
    }
    let Value::Function(name, inner) = value else {
        return None;
    };
    let list = match &**name {
        "is" | "matches" | "-webkit-any" => Simple::Is(forgiving_list(inner, scope)),
        "where" => return Some(Simple::Is(forgiving_list(inner, scope))),
        "not" => Simple::Not(parse_list(inner, scope)?),
        "has" => {
            let parts = split(inner, ',');
            let list: Option<Vec<_>> = parts.iter().map(|p| parse(p, scope, true)).collect();
            Simple::Has(list?.into())
        }
        "lang" => {
            specificity[1] += 1;
            let names = split(inner, ',').into_iter().map(|part| match part {
                [Value::Ident(name) | Value::String(name)] => Some(name.to_ascii_lowercase()),
                _ => None,
            });
            return Some(Simple::Lang(names.collect::<Option<_>>()?));
        }
        "nth-child" | "nth-last-child" | "nth-of-type" | "nth-last-of-type" => {
            specificity[1] += 1;
            let nth = nth(name, inner, scope)?;
            if let Some(of) = &nth.of {
                add(specificity, greatest(of));
            }
            return Some(Simple::Nth(nth));
        }
        "state" | "dir" | "host" | "host-context" => {
            specificity[1] += 1;
            return Some(Simple::Never);
        }
        _ => return None,
    };
    if let Simple::Is(list) | Simple::Not(list) | Simple::Has(list) = &list {
        add(specificity, greatest(list));
    }
    Some(list)
}

fn plain_pseudo_class(name: &str) -> Option<Simple> {
    let nth = |offset, from_end, of_type| {
        Simple::Nth(Nth {
            step: 0,
            offset,
            from_end,
            of_type,
            of: None,
        })
    };
    let only = |of_type| {
        let selector = |from_end| Selector {
            compounds: vec![(Combinator::Descendant, vec![nth(1, from_end, of_type)])],
            specificity: [0; 3],
        };
        // Both at once: not one that is not the first or not the last.
        let not = |from_end| Selector {
            compounds: vec![(
                Combinator::Descendant,
                vec![Simple::Not([selector(from_end)].into())],
            )],
            specificity: [0; 3],
        };
        Simple::Not([not(false), not(true)].into())
    };
    Some(match name {
        "root" | "scope" => Simple::Root,
        "empty" => Simple::Empty,
        "first-child" => nth(1, false, false),
        "last-child" => nth(1, true, false),
        "first-of-type" => nth(1, false, true),
        "last-of-type" => nth(1, true, true),
        "only-child" => only(false),
        "only-of-type" => only(true),
        "link" | "any-link" => Simple::Link,
        "defined" => Simple::Type(None, None),
        "hover" | "active" | "focus" | "focus-within" | "focus-visible" | "visited" | "target"
        | "target-within" | "enabled" | "disabled" | "checked" | "fullscreen" | "playing"
        | "paused" | "current" | "past" | "future" | "host" | "modal" | "popover-open" => {
            Simple::Never
        }
        _ => return None,
    })
}

fn nth(name: &str, values: &[Value], scope: &Scope) -> Option<Nth> {
    let of_at = values
        .iter()
        .position(|v| v.keyword().as_deref() == Some("of"));
    let (formula, of) = match of_at {
        Some(at) if name.ends_with("child") => {
            (&values[..at], Some(parse_list(&values[at + 1..], scope)?))
        }
        _ => (values, None),
    };
    let (step, offset) = formula_of(formula)?;
    Some(Nth {
        step,
        offset,
        from_end: name.contains("last"),
        of_type: name.ends_with("type"),
        of,
    })
}

/// `an + b`, `odd` or `even`.
fn formula_of(values: &[Value]) -> Option<(i64, i64)> {
    let text: String = crate::style::syntax::text(values).to_ascii_lowercase();
    let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    match text.as_str() {
        "odd" => return Some((2, 1)),
        "even" => return Some((2, 0)),
        _ => {}
    }
    let Some((step, offset)) = text.split_once('n') else {
        return Some((0, text.parse().ok()?));
    };
    let step = match step {
        "" | "+" => 1,
        "-" => -1,
        other => other.parse().ok()?,
    };
    // The sign of an offset is lost where it was its number's: `2n+1` is read as 2n and 1.
    let offset = if offset.is_empty() {
        0
    } else {
        offset.parse().ok()?
    };
    Some((step, offset))
}

fn greatest(list: &[Selector]) -> [u32; 3] {
    list.iter()
        .map(|selector| selector.specificity)
        .max()
        .unwrap_or_default()
}

fn add(specificity: &mut [u32; 3], more: [u32; 3]) {
    for (sum, part) in specificity.iter_mut().zip(more) {
        *sum = sum.saturating_add(part);
    }
}
