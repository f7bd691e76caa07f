//! Values of properties to the text that usvg reads.

use crate::style::property::{Axis, Kind};
use crate::style::syntax::{self, Value, words};
use crate::style::value::color::{Color, Surroundings, dialect};
use crate::style::value::filter::{Shadow, Step};
use crate::style::value::length::{Quantity, named_font_size_px};
use crate::style::value::number_text;

/// What the value of one property is read with.
#[derive(Clone, Copy)]
pub(in crate::style) struct Converter<'a> {
    pub(in crate::style) around: Surroundings<'a>,
    /// The parent's font size.
    pub(in crate::style) outer_font_size_px: f64,
    /// The nearest viewport.
    pub(in crate::style) viewport: [f64; 2],
}

impl Converter<'_> {
    /// The text for usvg; `None` where CSS takes the value for none of this kind.
    pub(in crate::style) fn text(&self, kind: Kind, values: &[Value]) -> Option<String> {
        let list = words(values);
        match (kind, list.as_slice()) {
            (Kind::Color | Kind::Background, [value]) => self.color(value),
            (Kind::Paint, words) => self.paint(words),
            (Kind::Share, [value]) => Some(number_text(self.share(value)?.clamp(0.0, 1.0))),
            (Kind::Number, [value]) => Some(number_text(self.around.units.number(value)?)),
            (Kind::Length(axis), [value]) => match value.keyword() {
                Some(word) => Some(word),
                None => self.length(value, axis),
            },
            (Kind::Lengths, words) => self.lengths(words),
            (Kind::Keywords, words) => Some(self.keywords(words)),
            (Kind::Reference, [value]) => match value {
                Value::Url(url) => Some(reference(url)),
                // Shapes that clip are made elsewhere.
                Value::Ident(_) if value.keyword().as_deref() == Some("none") => {
                    Some("none".to_owned())
                }
                _ => None,
            },
            (Kind::FontSize, [value]) => Some(number_text(self.font_size_px(value)?)),
            (Kind::Verbatim, _) => Some(syntax::text(values)),
            (Kind::Geometry(_), [value]) if value.keyword().is_some() => {
                (value.keyword()? == "auto").then(String::new)
            }
            (Kind::Geometry(axis), [value]) => self.length(value, axis),
            (Kind::PathData, [value]) => match value {
                Value::Function(_, inner) => match inner.as_ref() {
                    [Value::String(data)] => Some(data.to_string()),
                    [.., Value::Space, Value::String(data)] => Some(data.to_string()),
                    _ => None,
                },
                _ if value.keyword().as_deref() == Some("none") => Some(String::new()),
                _ => None,
            },
            _ => None,
        }
    }

    fn color(&self, value: &Value) -> Option<String> {
        Some(match self.around.color(value)? {
            Color::Current => "currentColor".to_owned(),
            Color::Known(color) => dialect(color),
        })
    }

    fn paint(&self, words: &[&Value]) -> Option<String> {
        match words {
            [Value::Url(url)] => Some(reference(url)),
            [Value::Url(url), fallback] => {
                Some(format!("{} {}", reference(url), self.paint(&[*fallback])?))
            }
            [value] => match value.keyword().as_deref() {
                Some(word @ ("none" | "context-fill" | "context-stroke")) => Some(word.to_owned()),
                _ => self.color(value),
            },
            _ => None,
        }
    }

    fn share(&self, value: &Value) -> Option<f64> {
        match self.around.units.quantity(value)? {
            Quantity::Number(number) => Some(number),
            Quantity::Length(0.0, percent) => Some(percent / 100.0),
            _ => None,
        }
    }

    /// A length for usvg, which knows percentages but not sums of both.
    pub(in crate::style) fn length(&self, value: &Value, axis: Axis) -> Option<String> {
        Some(match self.around.units.quantity(value)? {
            Quantity::Number(px) | Quantity::Length(px, 0.0) => number_text(px),
            Quantity::Length(0.0, percent) => format!("{}%", number_text(percent)),
            Quantity::Length(px, percent) => number_text(px + percent * self.whole(axis) / 100.0),
            Quantity::Degrees(_) => return None,
        })
    }

    fn whole(&self, axis: Axis) -> f64 {
        let [width, height] = self.viewport;
        match axis {
            Axis::X => width,
            Axis::Y => height,
            Axis::Both => width.hypot(height) / std::f64::consts::SQRT_2,
            Axis::Font => self.around.units.font_size_px,
        }
    }

    fn lengths(&self, words: &[&Value]) -> Option<String> {
        if let [value] = words
            && value.keyword().as_deref() == Some("none")
        {
            return Some("none".to_owned());
        }
        let values = words.iter().filter(|value| !value.is_delim(','));
        let texts: Option<Vec<_>> = values.map(|v| self.length(v, Axis::Both)).collect();
        texts.map(|texts| texts.join(" "))
    }

    fn keywords(&self, words: &[&Value]) -> String {
        let texts = words.iter().map(|value| match (value.keyword(), value) {
            // usvg knows these two in this spelling alone.
            (Some(word), _) => match word.as_str() {
                "srgb" => "sRGB".to_owned(),
                "linearrgb" => "linearRGB".to_owned(),
                "geometricprecision" => "geometricPrecision".to_owned(),
                "optimizespeed" => "optimizeSpeed".to_owned(),
                "optimizequality" => "optimizeQuality".to_owned(),
                "optimizelegibility" => "optimizeLegibility".to_owned(),
                "crispedges" => "crispEdges".to_owned(),
                _ => word,
            },
            (None, Value::Function(..)) => match self.around.units.number(value) {
                Some(number) => number_text(number),
                None => self.argument(value),
            },
            (None, value) => self.argument(value),
        });
        texts.collect::<Vec<_>>().join(" ")
    }

    /// The steps of a list of filters; none for `none`.
    pub(super) fn filter(&self, list: &[&Value]) -> Option<Vec<Step>> {
        if let [word] = list
            && word.keyword().as_deref() == Some("none")
        {
            return Some(Vec::new());
        }
        let step = |word: &&Value| match word {
            Value::Url(url) => Some(Step::Text(reference(url))),
            Value::Function(name, inner) => match &**name {
                "blur" => self.blur(inner),
                "drop-shadow" => self.shadow(inner),
                _ => self.color_filter(name, inner),
            },
            _ => None,
        };
        list.iter().map(step).collect()
    }

    fn blur(&self, inner: &[Value]) -> Option<Step> {
        let deviation = match words(inner).as_slice() {
            [] => 0.0,
            [value] => self.filter_length(value)?,
            _ => return None,
        };
        (deviation >= 0.0).then_some(Step::Blur(deviation))
    }

    fn shadow(&self, inner: &[Value]) -> Option<Step> {
        let (mut lengths, mut color) = (Vec::new(), None);
        let words = words(inner);
        for (index, value) in words.iter().enumerate() {
            match self.filter_length(value) {
                Some(length) => lengths.push(length),
                // It stands before or after the lengths.
                None if color.is_none() && (index == 0 || index + 1 == words.len()) => {
                    color = Some(self.around.resolved(value)?);
                }
                None => return None,
            }
        }
        let (dx, dy, deviation) = match lengths.as_slice() {
            [dx, dy] => (*dx, *dy, 0.0),
            [dx, dy, deviation] if *deviation >= 0.0 => (*dx, *dy, *deviation),
            _ => return None,
        };
        // The element of the filter is elsewhere, and has another colour of text.
        let color = dialect(color.unwrap_or(self.around.current));
        Some(Step::Shadow(Shadow {
            offset: [dx, dy],
            deviation,
            color,
        }))
    }

    /// A length, which has a unit unless it is 0, and no percentage.
    fn filter_length(&self, value: &Value) -> Option<f64> {
        match self.around.units.quantity(value)? {
            Quantity::Number(0.0) => Some(0.0),
            Quantity::Length(px, 0.0) if !matches!(value, Value::Percent(_)) => Some(px),
            _ => None,
        }
    }

    fn color_filter(&self, name: &str, inner: &[Value]) -> Option<Step> {
        let is_angle = name == "hue-rotate";
        let is_known = matches!(
            name,
            "brightness" | "contrast" | "grayscale" | "invert" | "opacity" | "saturate" | "sepia"
        );
        let argument = match (words(inner).as_slice(), is_angle) {
            ([], _) if is_angle || is_known => String::new(),
            ([value], true) => format!("{}deg", number_text(self.around.units.degrees(value)?)),
            ([value], false) if is_known => {
                let share = self.share(value).filter(|share| *share >= 0.0)?;
                number_text(share)
            }
            _ => return None,
        };
        Some(Step::Text(format!("{name}({argument})")))
    }

    /// A value within others.
    fn argument(&self, value: &Value) -> String {
        match self.around.units.quantity(value) {
            Some(Quantity::Number(number)) => number_text(number),
            Some(Quantity::Length(px, 0.0)) => format!("{}px", number_text(px)),
            Some(Quantity::Length(0.0, percent)) => format!("{}%", number_text(percent)),
            Some(Quantity::Degrees(degrees)) => format!("{}deg", number_text(degrees)),
            _ => syntax::text(std::slice::from_ref(value)),
        }
    }

    /// The computed size of a font.
    pub(in crate::style) fn font_size_px(&self, value: &Value) -> Option<f64> {
        let size = match value.keyword() {
            Some(name) => named_font_size_px(&name, self.outer_font_size_px)?,
            None => {
                let mut units = self.around.units;
                units.font_size_px = self.outer_font_size_px;
                units.quantity(value)?.length_px(self.outer_font_size_px)?
            }
        };
        (size >= 0.0).then_some(size)
    }
}

fn reference(url: &str) -> String {
    // Blanks and quotes would end it, and no id has them.
    let url: String = url
        .chars()
        .filter(|c| !c.is_whitespace() && !"'\"()".contains(*c))
        .collect();
    format!("url({url})")
}
