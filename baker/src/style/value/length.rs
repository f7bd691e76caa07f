//! Numbers, lengths and angles, alone and in `calc()` (CSS Values 4).

use crate::style::syntax::{Value, split, trim, words};

/// What relative units are relative to.
#[derive(Clone, Copy, Debug)]
pub(in crate::style) struct Units<'a> {
    pub(in crate::style) font_size_px: f64,
    pub(in crate::style) root_font_size_px: f64,
    /// The canvas, for `vw` and `vh`.
    pub(in crate::style) canvas_px: [f64; 2],
    /// Names that stand for numbers: components of a relative colour.
    pub(in crate::style) names: &'a [(&'a str, f64)],
}

/// A value that has been computed as far as it can be without the size of what percentages mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::style) enum Quantity {
    Number(f64),
    /// Pixels and percent, to be added.
    Length(f64, f64),
    Degrees(f64),
}

/// Makes a quantity of one kind.
type Make = fn(f64) -> Quantity;

impl Quantity {
    /// The length where percentages are of `whole`. A number is one of user units.
    pub(in crate::style) fn length_px(self, whole: f64) -> Option<f64> {
        match self {
            Self::Number(px) => Some(px),
            Self::Length(px, percent) => Some(px + percent * whole / 100.0),
            Self::Degrees(_) => None,
        }
    }

    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Number(number) => Self::Number(f(number)),
            Self::Length(px, percent) => Self::Length(f(px), f(percent)),
            Self::Degrees(degrees) => Self::Degrees(f(degrees)),
        }
    }

    fn add(self, other: Self) -> Option<Self> {
        Some(match (self, other) {
            (Self::Number(a), Self::Number(b)) => Self::Number(a + b),
            (Self::Length(a, c), Self::Length(b, d)) => Self::Length(a + b, c + d),
            (Self::Degrees(a), Self::Degrees(b)) => Self::Degrees(a + b),
            _ => return None,
        })
    }

    /// The one number that this is, and how to make such a value of another.
    fn plain(self) -> Option<(f64, Make)> {
        match self {
            Self::Number(number) => Some((number, Self::Number)),
            Self::Length(px, 0.0) => Some((px, |px| Self::Length(px, 0.0))),
            Self::Length(0.0, percent) => Some((percent, |percent| Self::Length(0.0, percent))),
            Self::Length(..) => None,
            Self::Degrees(degrees) => Some((degrees, Self::Degrees)),
        }
    }
}

/// Pixels of an absolute unit.
pub(in crate::style) fn px_of(unit: &str) -> Option<f64> {
    Some(match unit {
        "px" => 1.0,
        "in" => 96.0,
        "cm" => 96.0 / 2.54,
        "mm" => 9.6 / 2.54,
        "q" => 2.4 / 2.54,
        "pt" => 96.0 / 72.0,
        "pc" => 16.0,
        _ => return None,
    })
}

impl Units<'_> {
    /// Reads one value; `None` where it is no quantity.
    pub(in crate::style) fn quantity(&self, value: &Value) -> Option<Quantity> {
        match value {
            Value::Number(number) => Some(Quantity::Number(*number)),
            Value::Percent(percent) => Some(Quantity::Length(0.0, *percent)),
            Value::Dimension(number, unit) => self.dimension(*number, unit),
            Value::Function(name, inner) => self.function(name, inner).filter(is_finite),
            Value::Block('(', inner) => self.sum(inner),
            Value::Ident(name) => self.constant(&name.to_ascii_lowercase()),
            _ => None,
        }
    }

    /// Reads a value that is a plain number.
    pub(in crate::style) fn number(&self, value: &Value) -> Option<f64> {
        match self.quantity(value)? {
            Quantity::Number(number) => Some(number),
            _ => None,
        }
    }

    /// Degrees of an angle; zero may stand without a unit.
    pub(in crate::style) fn degrees(&self, value: &Value) -> Option<f64> {
        match self.quantity(value)? {
            Quantity::Degrees(degrees) => Some(degrees),
            Quantity::Number(0.0) => Some(0.0),
            _ => None,
        }
    }

    fn constant(&self, name: &str) -> Option<Quantity> {
        let known = self.names.iter().find(|(known, _)| *known == name);
        let number = match (known, name) {
            (Some((_, number)), _) => *number,
            (_, "pi") => std::f64::consts::PI,
            (_, "e") => std::f64::consts::E,
            (_, "infinity") => f64::MAX,
            (_, "-infinity") => f64::MIN,
            _ => return None,
        };
        Some(Quantity::Number(number))
    }

    fn dimension(&self, number: f64, unit: &str) -> Option<Quantity> {
        let [width, height] = self.canvas_px;
        let px = match unit {
            "deg" => return Some(Quantity::Degrees(number)),
            "rad" => return Some(Quantity::Degrees(number.to_degrees())),
            "grad" => return Some(Quantity::Degrees(number * 0.9)),
            "turn" => return Some(Quantity::Degrees(number * 360.0)),
            "em" => self.font_size_px,
            // Without the font: what CSS names for such cases, and what usvg takes.
            "ex" | "ch" => self.font_size_px / 2.0,
            "cap" => self.font_size_px * 0.7,
            "ic" => self.font_size_px,
            "lh" => self.font_size_px * 1.2,
            "rem" => self.root_font_size_px,
            "rex" | "rch" => self.root_font_size_px / 2.0,
            "rlh" => self.root_font_size_px * 1.2,
            "vw" | "svw" | "lvw" | "dvw" | "vi" | "cqw" | "cqi" => width / 100.0,
            "vh" | "svh" | "lvh" | "dvh" | "vb" | "cqh" | "cqb" => height / 100.0,
            "vmin" | "svmin" | "lvmin" | "dvmin" | "cqmin" => width.min(height) / 100.0,
            "vmax" | "svmax" | "lvmax" | "dvmax" | "cqmax" => width.max(height) / 100.0,
            _ => px_of(unit)?,
        };
        Some(Quantity::Length(number * px, 0.0))
    }

    /// `a + b - c`.
    fn sum(&self, values: &[Value]) -> Option<Quantity> {
        let words = words(values);
        let is_sign = |word: &&Value| matches!(word, Value::Delim('+' | '-'));
        let mut total: Option<Quantity> = None;
        let mut rest: &[&Value] = &words;
        let mut factor = 1.0;
        loop {
            let end = rest.iter().position(is_sign).unwrap_or(rest.len());
            let term = self.product(&rest[..end])?.map(|number| number * factor);
            total = match total {
                Some(total) => Some(total.add(term)?),
                None => Some(term),
            };
            let Some(sign) = rest.get(end) else {
                return total;
            };
            factor = if sign.is_delim('-') { -1.0 } else { 1.0 };
            rest = &rest[end + 1..];
        }
    }

    /// `a * b / c`.
    fn product(&self, words: &[&Value]) -> Option<Quantity> {
        let (first, rest) = words.split_first()?;
        let mut total = self.quantity(first)?;
        for pair in rest.chunks(2) {
            let [operator, value] = pair else {
                return None;
            };
            let factor = self.quantity(value)?;
            total = match (operator, total, factor) {
                (Value::Delim('*'), value, Quantity::Number(factor))
                | (Value::Delim('*'), Quantity::Number(factor), value) => {
                    value.map(|number| number * factor)
                }
                (Value::Delim('/'), value, Quantity::Number(factor)) => {
                    value.map(|number| number / factor)
                }
                // CSS Values 4 divides lengths by lengths.
                (Value::Delim('/'), a, b) => Quantity::Number(a.plain()?.0 / b.plain()?.0),
                _ => return None,
            };
        }
        Some(total)
    }

    fn function(&self, name: &str, inner: &[Value]) -> Option<Quantity> {
        if matches!(name, "calc" | "-webkit-calc") {
            return self.sum(inner);
        }
        let parts = split(inner, ',');
        let mut parts = parts.as_slice();
        let mut strategy = None;
        if let ("round", [[Value::Ident(word)], rest @ ..]) = (name, parts) {
            (strategy, parts) = (Some(word.to_ascii_lowercase()), rest);
        }
        if name == "clamp" {
            return self.clamp(parts);
        }
        let quantities: Option<Vec<_>> = parts.iter().map(|part| self.sum(trim(part))).collect();
        let quantities = quantities?;
        let first = *quantities.first()?;
        // Percentages of one value and pixels of the other cannot be compared yet.
        let make = first.plain()?.1;
        let numbers: Option<Vec<f64>> = quantities
            .iter()
            .map(|quantity| {
                let same = make(0.0).add(*quantity).is_some();
                let both = matches!((make(1.0), quantity), (Quantity::Length(1.0, _), Quantity::Length(_, p)) if *p != 0.0)
                    || matches!((make(1.0), quantity), (Quantity::Length(0.0, _), Quantity::Length(px, _)) if *px != 0.0);
                quantity.plain().filter(|_| same && !both).map(|(number, _)| number)
            })
            .collect();
        let numbers = numbers?;
        let number = match (name, numbers.as_slice()) {
            ("min", all) => all.iter().copied().fold(f64::INFINITY, f64::min),
            ("max", all) => all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ("abs", [a]) => a.abs(),
            ("mod", [a, b]) => a - b * (a / b).floor(),
            ("rem", [a, b]) => a % b,
            ("round", [a]) => round(*a, 1.0, strategy.as_deref())?,
            ("round", [a, b]) => round(*a, *b, strategy.as_deref())?,
            ("hypot", all) => all.iter().copied().fold(0.0, f64::hypot),
            ("sign", [a]) => {
                return Some(Quantity::Number(if *a == 0.0 { 0.0 } else { a.signum() }));
            }
            ("atan2", [a, b]) => return Some(Quantity::Degrees(a.atan2(*b).to_degrees())),
            (name, [a, rest @ ..]) => return scientific(name, first, *a, rest),
            _ => return None,
        };
        Some(make(number))
    }

    fn clamp(&self, parts: &[&[Value]]) -> Option<Quantity> {
        let [low, value, high] = parts else {
            return None;
        };
        let is_none =
            |part: &[Value]| matches!(part, [v] if v.keyword().as_deref() == Some("none"));
        let bound = |part: &[Value], none: f64| match is_none(part) {
            true => Some((none, None)),
            false => self
                .sum(part)?
                .plain()
                .map(|(n, make)| (n, Some(make(1.0)))),
        };
        let (value, make) = self.sum(value)?.plain()?;
        let (low, low_kind) = bound(low, f64::NEG_INFINITY)?;
        let (high, high_kind) = bound(high, f64::INFINITY)?;
        let same = |kind: Option<Quantity>| kind.is_none_or(|kind| kind == make(1.0));
        (same(low_kind) && same(high_kind)).then(|| make(value.min(high).max(low)))
    }
}

fn is_finite(quantity: &Quantity) -> bool {
    match quantity {
        Quantity::Number(a) | Quantity::Degrees(a) => a.is_finite(),
        Quantity::Length(a, b) => a.is_finite() && b.is_finite(),
    }
}

fn round(number: f64, step: f64, strategy: Option<&str>) -> Option<f64> {
    let steps = number / step;
    let steps = match strategy {
        None | Some("nearest") => (steps + 0.5).floor(),
        Some("up") => steps.ceil(),
        Some("down") => steps.floor(),
        Some("to-zero") => steps.trunc(),
        Some(_) => return None,
    };
    Some(steps * step)
}

fn scientific(name: &str, first: Quantity, a: f64, rest: &[f64]) -> Option<Quantity> {
    let radians = match first {
        Quantity::Degrees(degrees) => degrees.to_radians(),
        Quantity::Number(number) => number,
        Quantity::Length(..) => return None,
    };
    Some(match (name, rest) {
        ("sin", []) => Quantity::Number(radians.sin()),
        ("cos", []) => Quantity::Number(radians.cos()),
        ("tan", []) => Quantity::Number(radians.tan()),
        _ if !matches!(first, Quantity::Number(_)) => return None,
        ("asin", []) => Quantity::Degrees(a.asin().to_degrees()),
        ("acos", []) => Quantity::Degrees(a.acos().to_degrees()),
        ("atan", []) => Quantity::Degrees(a.atan().to_degrees()),
        ("sqrt", []) => Quantity::Number(a.sqrt()),
        ("exp", []) => Quantity::Number(a.exp()),
        ("log", []) => Quantity::Number(a.ln()),
        ("log", [base]) => Quantity::Number(a.ln() / base.ln()),
        ("pow", [b]) => Quantity::Number(a.powf(*b)),
        _ => return None,
    })
}

/// A font size by its name, where that of the parent is `outer_px` (CSS Fonts 4, for a medium size of 16).
pub(in crate::style) fn named_font_size_px(name: &str, outer_px: f64) -> Option<f64> {
    Some(match name {
        "xx-small" => 9.0,
        "x-small" => 10.0,
        "small" => 13.0,
        "medium" => 16.0,
        "large" => 18.0,
        "x-large" => 24.0,
        "xx-large" => 32.0,
        "xxx-large" => 48.0,
        "smaller" => outer_px / 1.2,
        "larger" => outer_px * 1.2,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::syntax::parse;

    #[test]
    fn calculations_have_the_values_of_css() {
        let units = Units {
            font_size_px: 20.0,
            root_font_size_px: 16.0,
            canvas_px: [200.0, 100.0],
            names: &[],
        };
        let cases = [
            ("calc(4px + 6px)", Some(Quantity::Length(10.0, 0.0))),
            ("calc(50% - 2em)", Some(Quantity::Length(-40.0, 50.0))),
            ("calc(.5)", Some(Quantity::Number(0.5))),
            (
                "calc(2 * (1rem + 1vw) / 4)",
                Some(Quantity::Length(9.0, 0.0)),
            ),
            ("min(3px, 1vh, 10px)", Some(Quantity::Length(1.0, 0.0))),
            ("clamp(1px, 5px, 3px)", Some(Quantity::Length(3.0, 0.0))),
            ("calc(1turn / 4)", Some(Quantity::Degrees(90.0))),
            ("round(up, 2.1, 1)", Some(Quantity::Number(3.0))),
            ("calc(1px + 1)", None),
            ("calc(1px * 1px)", None),
            ("calc(1 / 0)", None),
            ("calc(1px -1px)", None),
            ("min(1px, 1%)", None),
            ("calc()", None),
        ];
        for (css, wanted) in cases {
            let values = parse(css).unwrap();
            assert_eq!(units.quantity(&values[0]), wanted, "{css}");
        }
    }
}
