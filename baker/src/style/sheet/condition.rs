//! Conditions of `@media` and `@supports`.

use super::selector::{self, Scope};
use crate::style::property;
use crate::style::syntax::{Value, split, trim, words};

/// What `@media` asks about: a light screen as large as the canvas.
#[derive(Clone, Copy, Debug)]
pub(in crate::style) struct Medium {
    /// Width and height in px.
    pub(in crate::style) canvas_px: [f64; 2],
}

impl Medium {
    /// Whether one of a list of media queries holds. An empty list holds.
    pub(in crate::style) fn shows(&self, queries: &[Value]) -> bool {
        let queries = trim(queries);
        queries.is_empty() || split(queries, ',').iter().any(|query| self.query(query))
    }

    fn query(&self, query: &[Value]) -> bool {
        let mut words = words(query);
        let keyword = |words: &[&Value]| words.first().and_then(|word| word.keyword());
        let is_not = keyword(&words).as_deref() == Some("not")
            && words.get(1).is_some_and(|word| word.keyword().is_some());
        if is_not || keyword(&words).as_deref() == Some("only") {
            words.remove(0);
        }
        let Some(kind) = keyword(&words).filter(|word| word != "not") else {
            return logic(&words, &|value| self.feature(value)) == Some(true);
        };
        let rest = match words.get(1).and_then(|word| word.keyword()) {
            Some(word) if word == "and" => logic(&words[2..], &|value| self.feature(value)),
            None if words.len() == 1 => Some(true),
            _ => return false,
        };
        let holds = matches!(kind.as_str(), "all" | "screen");
        rest.is_some_and(|rest| (holds && rest) != is_not)
    }

    fn feature(&self, value: &Value) -> Option<bool> {
        let Value::Block('(', inner) = value else {
            return None;
        };
        let inner = trim(inner);
        if matches!(inner.first(), Some(Value::Block(..)))
            || inner.first()?.keyword().as_deref() == Some("not")
        {
            return logic(&words(inner), &|value| self.feature(value));
        }
        match words(inner).as_slice() {
            [name] => self.plain(&name.keyword()?, None),
            [name, Value::Delim(':'), wanted @ ..] => self.plain(&name.keyword()?, Some(wanted)),
            range => self.range(range),
        }
    }

    fn plain(&self, name: &str, wanted: Option<&[&Value]>) -> Option<bool> {
        let keyword = || wanted.and_then(|w| w.first()).and_then(|w| w.keyword());
        let is = |value: &str| match keyword() {
            Some(found) => found == value,
            None => !matches!(value, "none" | "no-preference"),
        };
        let [width, height] = self.canvas_px;
        Some(match name {
            "prefers-color-scheme" => is("light"),
            "prefers-reduced-motion"
            | "prefers-contrast"
            | "prefers-reduced-transparency"
            | "prefers-reduced-data" => is("no-preference"),
            "forced-colors" | "inverted-colors" | "scripting" => is("none"),
            "hover" | "any-hover" => is("hover"),
            "pointer" | "any-pointer" => is("fine"),
            "color-gamut" => is("srgb"),
            "dynamic-range" => is("standard"),
            "display-mode" => is("browser"),
            "update" => is("fast"),
            "orientation" => is(if width > height {
                "landscape"
            } else {
                "portrait"
            }),
            "color" | "min-color" => number(wanted).is_none_or(|bits| bits <= 8.0),
            "monochrome" | "grid" => number(wanted).is_some_and(|bits| bits == 0.0),
            _ => {
                let (name, order) = match name.split_once('-') {
                    Some(("min", name)) => (name, '>'),
                    Some(("max", name)) => (name, '<'),
                    _ => (name, '='),
                };
                let size = self.size(name)?;
                match wanted {
                    None => size > 0.0,
                    Some(_) => compare(size, order, true, number(wanted)?)?,
                }
            }
        })
    }

    fn size(&self, name: &str) -> Option<f64> {
        let [width, height] = self.canvas_px;
        Some(match name {
            "width" | "device-width" => width,
            "height" | "device-height" => height,
            "aspect-ratio" | "device-aspect-ratio" => width / height,
            "resolution" | "-webkit-device-pixel-ratio" | "device-pixel-ratio" => 1.0,
            _ => return None,
        })
    }

    /// `width >= 100px`, `100px < width <= 200px`.
    fn range(&self, words: &[&Value]) -> Option<bool> {
        let is_sign = |word: &&Value| matches!(word, Value::Delim('<' | '>' | '='));
        let value = |part: &[&Value]| match part.first()?.keyword() {
            Some(name) => self.size(&name),
            None => number(Some(part)),
        };
        let mut parts = words.split(is_sign).filter(|part| !part.is_empty());
        let signs: Vec<_> = words
            .split(|word| !is_sign(word))
            .filter(|s| !s.is_empty())
            .collect();
        let mut left = value(parts.next()?)?;
        let mut holds = true;
        for sign in signs {
            let right = value(parts.next()?)?;
            let Value::Delim(order) = sign.first()? else {
                return None;
            };
            holds &= compare(left, *order, sign.len() > 1 || *order == '=', right)?;
            left = right;
        }
        Some(holds)
    }
}

fn compare(left: f64, order: char, or_equal: bool, right: f64) -> Option<bool> {
    let is_equal = (left - right).abs() < 1e-9;
    Some(match order {
        '<' => left < right || (or_equal && is_equal),
        '>' => left > right || (or_equal && is_equal),
        '=' => is_equal,
        _ => return None,
    })
}

/// A number, a ratio, or a length in px.
fn number(words: Option<&[&Value]>) -> Option<f64> {
    Some(match words? {
        [Value::Number(number)] => *number,
        [
            Value::Number(upper),
            Value::Delim('/'),
            Value::Number(lower),
        ] => upper / lower,
        [Value::Dimension(number, unit)] => match &**unit {
            "dppx" | "x" => *number,
            "dpi" => number / 96.0,
            unit => number * crate::style::value::length::px_of(unit)?,
        },
        _ => return None,
    })
}

/// `not a`, `a and b and c`, `a or b`. `None` is what nobody knows.
fn logic(words: &[&Value], leaf: &dyn Fn(&Value) -> Option<bool>) -> Option<bool> {
    let (first, rest) = words.split_first()?;
    if first.keyword().as_deref() == Some("not") {
        return logic(rest, leaf).map(|holds| !holds);
    }
    let mut holds = leaf(first);
    for pair in rest.chunks(2) {
        let [word, value] = pair else {
            return None;
        };
        let other = leaf(value);
        holds = match word.keyword()?.as_str() {
            "and" if holds == Some(false) || other == Some(false) => Some(false),
            "or" if holds == Some(true) || other == Some(true) => Some(true),
            "and" | "or" => holds.and(other),
            _ => return None,
        };
    }
    holds
}

/// Whether a condition of `@supports` holds.
pub(in crate::style) fn is_supported(condition: &[Value]) -> bool {
    logic(&words(condition), &supports) == Some(true)
}

fn supports(value: &Value) -> Option<bool> {
    match value {
        Value::Block('(', inner) => {
            let inner = trim(inner);
            if let Some(declaration) = super::declarations(inner).first() {
                return Some(property::is_known(&declaration.name, &declaration.value));
            }
            logic(&words(inner), &supports)
        }
        Value::Function(name, inner) if &**name == "selector" => {
            Some(selector::parse_list(inner, &Scope::default()).is_some())
        }
        _ => Some(false),
    }
}
