//! CSS text to component values: tokens, with functions and blocks as trees (CSS Syntax 3).

use std::rc::Rc;

use crate::error::BakeError;

/// Levels of blocks and functions in each other. Written sheets stay below 20; parsing and
/// evaluation are recursive, so the level is bounded before they start.
pub(super) const MAX_NESTING: usize = 64;

/// A component value.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Ident(Rc<str>),
    AtKeyword(Rc<str>),
    /// `#name`, without the sign.
    Hash(Rc<str>),
    String(Rc<str>),
    Url(Rc<str>),
    Number(f64),
    Percent(f64),
    /// A number with a unit in lower case.
    Dimension(f64, Rc<str>),
    Delim(char),
    Space,
    /// `<!--` or `-->`.
    Comment,
    /// A name in lower case and what its parentheses hold.
    Function(Rc<str>, Rc<[Self]>),
    /// The opening bracket and what the block holds.
    Block(char, Rc<[Self]>),
}

impl Value {
    /// The name of an identifier in lower case.
    pub(super) fn keyword(&self) -> Option<String> {
        match self {
            Self::Ident(name) => Some(name.to_ascii_lowercase()),
            _ => None,
        }
    }

    pub(super) fn is_delim(&self, wanted: char) -> bool {
        matches!(self, Self::Delim(found) if *found == wanted)
    }
}

/// Parses `css`. Text that CSS forbids becomes delimiters, which no later stage accepts.
///
/// # Errors
/// [`BakeError::Limit`] for blocks nested deeper than [`MAX_NESTING`].
pub(super) fn parse(css: &str) -> Result<Vec<Value>, BakeError> {
    let mut reader = Reader { rest: css };
    reader.values(None, 0)
}

/// `values` without spaces at the start.
pub(super) fn trim_start(mut values: &[Value]) -> &[Value] {
    while let [Value::Space, rest @ ..] = values {
        values = rest;
    }
    values
}

/// `values` without spaces at both ends.
pub(super) fn trim(mut values: &[Value]) -> &[Value] {
    while let [Value::Space, rest @ ..] | [rest @ .., Value::Space] = values {
        values = rest;
    }
    values
}

/// The parts of `values` between `separator`s, each trimmed.
pub(super) fn split(values: &[Value], separator: char) -> Vec<&[Value]> {
    let parts = values.split(|value| value.is_delim(separator));
    parts.map(trim).collect()
}

/// The parts of `values` between spaces.
pub(super) fn words(values: &[Value]) -> Vec<&Value> {
    values
        .iter()
        .filter(|v| !matches!(v, Value::Space))
        .collect()
}

/// `values` as CSS text.
pub(super) fn text(values: &[Value]) -> String {
    let mut out = String::new();
    write(values, &mut out);
    out
}

fn write(values: &[Value], out: &mut String) {
    for value in values {
        match value {
            Value::Ident(name) => out.push_str(name),
            Value::AtKeyword(name) => *out += &format!("@{name}"),
            Value::Hash(name) => *out += &format!("#{name}"),
            Value::String(text) => {
                let quote = if text.contains('\'') { '"' } else { '\'' };
                out.push(quote);
                out.extend(text.chars().filter(|&c| c != quote));
                out.push(quote);
            }
            Value::Url(text) => *out += &format!("url({text})"),
            Value::Number(number) => *out += &number.to_string(),
            Value::Percent(number) => *out += &format!("{number}%"),
            Value::Dimension(number, unit) => *out += &format!("{number}{unit}"),
            Value::Delim(c) => out.push(*c),
            Value::Space | Value::Comment => out.push(' '),
            Value::Function(name, inner) => {
                *out += &format!("{name}(");
                write(inner, out);
                out.push(')');
            }
            Value::Block(open, inner) => {
                out.push(*open);
                write(inner, out);
                out.push(closing(*open));
            }
        }
    }
}

fn closing(open: char) -> char {
    match open {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}

fn is_name_start(c: char) -> bool {
    c.is_ascii_alphabetic() || c == '_' || !c.is_ascii()
}

fn is_name(c: char) -> bool {
    is_name_start(c) || c.is_ascii_digit() || c == '-'
}

struct Reader<'a> {
    rest: &'a str,
}

impl Reader<'_> {
    fn values(&mut self, end: Option<char>, depth: usize) -> Result<Vec<Value>, BakeError> {
        if depth > MAX_NESTING {
            let message = format!("blocks of a style sheet nest deeper than {MAX_NESTING}");
            return Err(BakeError::Limit(message));
        }
        let mut values = Vec::new();
        while let Some(c) = self.peek(0) {
            if Some(c) == end {
                self.skip(1);
                break;
            }
            if let Some(value) = self.value(c, depth)? {
                let repeated = value == Value::Space && values.last() == Some(&Value::Space);
                if !repeated {
                    values.push(value);
                }
            }
        }
        Ok(values)
    }

    fn value(&mut self, c: char, depth: usize) -> Result<Option<Value>, BakeError> {
        if self.rest.starts_with("/*") {
            let end = self.rest.get(2..).and_then(|rest| rest.find("*/"));
            self.skip_bytes(end.map_or(self.rest.len(), |at| at + 4));
            return Ok(None);
        }
        for mark in ["<!--", "-->"] {
            if self.rest.starts_with(mark) {
                self.skip_bytes(mark.len());
                return Ok(Some(Value::Comment));
            }
        }
        Ok(Some(match c {
            _ if c.is_ascii_whitespace() => {
                self.rest = self
                    .rest
                    .trim_start_matches(|c: char| c.is_ascii_whitespace());
                Value::Space
            }
            '"' | '\'' => {
                self.skip(1);
                Value::String(self.string(c).into())
            }
            '(' | '[' | '{' => {
                self.skip(1);
                Value::Block(c, self.values(Some(closing(c)), depth + 1)?.into())
            }
            _ if self.starts_number() => self.numeric(),
            '#' if self.peek(1).is_some_and(|c| is_name(c) || c == '\\') => {
                self.skip(1);
                Value::Hash(self.name().into())
            }
            '@' if self.starts_ident(1) => {
                self.skip(1);
                Value::AtKeyword(self.name().to_ascii_lowercase().into())
            }
            _ if self.starts_ident(0) => self.ident(depth)?,
            _ => {
                self.skip(1);
                Value::Delim(c)
            }
        }))
    }

    fn ident(&mut self, depth: usize) -> Result<Value, BakeError> {
        let name = self.name();
        if self.peek(0) != Some('(') {
            return Ok(Value::Ident(name.into()));
        }
        self.skip(1);
        let name = name.to_ascii_lowercase();
        if name == "url" {
            let inner = self.rest.trim_start();
            if !inner.starts_with(['"', '\'']) {
                self.rest = inner;
                return Ok(Value::Url(self.bare_url().into()));
            }
            let inner = self.values(Some(')'), depth + 1)?;
            return Ok(match trim(&inner) {
                [Value::String(text)] => Value::Url(Rc::clone(text)),
                _ => Value::Function(name.into(), inner.into()),
            });
        }
        Ok(Value::Function(
            name.into(),
            self.values(Some(')'), depth + 1)?.into(),
        ))
    }

    fn bare_url(&mut self) -> String {
        let mut url = String::new();
        while let Some(c) = self.peek(0) {
            self.skip(1);
            match c {
                ')' => break,
                '\\' => url.push(self.escape()),
                _ => url.push(c),
            }
        }
        url.trim_end().to_owned()
    }

    fn numeric(&mut self) -> Value {
        let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        let text = self.rest;
        let mut end = usize::from(text.starts_with(['+', '-']));
        end += digits(&text[end..]);
        if text[end..].starts_with('.') && digits(&text[end + 1..]) > 0 {
            end += 1 + digits(&text[end + 1..]);
        }
        if text[end..].starts_with(['e', 'E']) {
            let sign = usize::from(text[end + 1..].starts_with(['+', '-']));
            let more = digits(&text[end + 1 + sign..]);
            if more > 0 {
                end += 1 + sign + more;
            }
        }
        let number = text[..end].parse::<f64>().unwrap_or(0.0);
        // CSS bounds numbers; infinities would spread.
        let number = number.clamp(-1e30, 1e30);
        self.skip_bytes(end);
        if self.peek(0) == Some('%') {
            self.skip(1);
            Value::Percent(number)
        } else if self.starts_ident(0) {
            Value::Dimension(number, self.name().to_ascii_lowercase().into())
        } else {
            Value::Number(number)
        }
    }

    fn string(&mut self, quote: char) -> String {
        let mut string = String::new();
        while let Some(c) = self.peek(0) {
            self.skip(1);
            match c {
                _ if c == quote => break,
                '\\' if self.peek(0) == Some('\n') => self.skip(1),
                '\\' => string.push(self.escape()),
                _ => string.push(c),
            }
        }
        string
    }

    fn name(&mut self) -> String {
        let mut name = String::new();
        while let Some(c) = self.peek(0) {
            match c {
                _ if is_name(c) => {
                    name.push(c);
                    self.skip(1);
                }
                '\\' if self.peek(1).is_some_and(|c| c != '\n') => {
                    self.skip(1);
                    name.push(self.escape());
                }
                _ => break,
            }
        }
        name
    }

    /// What follows a backslash.
    fn escape(&mut self) -> char {
        let hex: String = self
            .rest
            .chars()
            .take(6)
            .take_while(char::is_ascii_hexdigit)
            .collect();
        if hex.is_empty() {
            let c = self.peek(0).unwrap_or('\u{fffd}');
            self.skip(1);
            return c;
        }
        self.skip_bytes(hex.len());
        if self.peek(0).is_some_and(|c| c.is_ascii_whitespace()) {
            self.skip(1);
        }
        let code = u32::from_str_radix(&hex, 16).unwrap_or(0);
        char::from_u32(code)
            .filter(|&c| c != '\0')
            .unwrap_or('\u{fffd}')
    }

    fn starts_number(&self) -> bool {
        let text = self.rest.strip_prefix(['+', '-']).unwrap_or(self.rest);
        let text = text.strip_prefix('.').unwrap_or(text);
        text.starts_with(|c: char| c.is_ascii_digit())
    }

    fn starts_ident(&self, skip: usize) -> bool {
        let starts = |c: char| is_name_start(c) || c == '\\';
        match self.peek(skip) {
            Some('-') => self.peek(skip + 1).is_some_and(|c| starts(c) || c == '-'),
            Some('\\') => self.peek(skip + 1).is_some_and(|c| c != '\n'),
            Some(c) => is_name_start(c),
            None => false,
        }
    }

    fn peek(&self, skip: usize) -> Option<char> {
        self.rest.chars().nth(skip)
    }

    fn skip(&mut self, count: usize) {
        let mut chars = self.rest.chars();
        chars.by_ref().take(count).for_each(drop);
        self.rest = chars.as_str();
    }

    fn skip_bytes(&mut self, count: usize) {
        self.rest = self.rest.get(count..).unwrap_or_default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_comes_back_as_it_was_read() {
        let same = [
            "a:b(1px +2.5e3% #fff,'x')",
            "--a-b 12 [x='y'] {c:d;}",
            "calc(1 - 2*(3 + 4px))",
        ];
        for css in same {
            let read = text(&parse(css).unwrap());
            assert_eq!(read.replace("2500%", "+2.5e3%"), css);
        }
        assert_eq!(text(&parse("/* a */x/**/y").unwrap()), "xy");
        assert_eq!(
            parse("url( a b.svg )").unwrap(),
            [Value::Url("a b.svg".into())]
        );
        assert_eq!(parse("\\66 ill").unwrap(), [Value::Ident("fill".into())]);
    }

    #[test]
    fn broken_text_ends_and_deep_text_is_refused() {
        for css in [
            "(", "a{b:c(", "'x", "/*", "\\", "url(", "#", "@", ")]}", "-", "1e",
        ] {
            assert!(parse(css).is_ok(), "{css}");
        }
        assert!(parse(&"(".repeat(MAX_NESTING + 2)).is_err());
    }
}
