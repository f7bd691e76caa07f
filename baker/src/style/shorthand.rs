//! Shorthand properties to the properties that they stand for.

use std::rc::Rc;

use super::property;
use super::syntax::{Value, trim, words};

/// Properties that `all` stands for.
const ALL: [&str; 56] = [
    "color",
    "stop-color",
    "flood-color",
    "lighting-color",
    "fill",
    "stroke",
    "opacity",
    "fill-opacity",
    "stroke-opacity",
    "stop-opacity",
    "flood-opacity",
    "stroke-miterlimit",
    "stroke-width",
    "stroke-dashoffset",
    "letter-spacing",
    "word-spacing",
    "baseline-shift",
    "stroke-dasharray",
    "fill-rule",
    "clip-rule",
    "color-interpolation-filters",
    "display",
    "dominant-baseline",
    "alignment-baseline",
    "image-rendering",
    "isolation",
    "mask-type",
    "mix-blend-mode",
    "overflow",
    "paint-order",
    "shape-rendering",
    "stroke-linecap",
    "stroke-linejoin",
    "text-anchor",
    "text-decoration",
    "text-rendering",
    "visibility",
    "writing-mode",
    "font-style",
    "font-variant",
    "font-stretch",
    "font-weight",
    "marker-start",
    "marker-mid",
    "marker-end",
    "mask",
    "clip-path",
    "filter",
    "font-size",
    "font-family",
    "transform",
    "translate",
    "rotate",
    "scale",
    "transform-origin",
    "background-color",
];

/// Whether `name` is a shorthand, or another name of a property.
pub(super) fn is_one(name: &str) -> bool {
    matches!(
        name,
        "all"
            | "font"
            | "marker"
            | "background"
            | "mask-image"
            | "-webkit-mask"
            | "-webkit-mask-image"
            | "-webkit-transform"
            | "-webkit-transform-origin"
            | "-webkit-filter"
            | "-webkit-clip-path"
            | "text-decoration-line"
            | "-webkit-opacity"
            | "font-variant-caps"
            | "font-width"
    )
}

type Longhand = (Rc<str>, Rc<[Value]>);

/// The properties that a declaration sets; none where its value is none of the shorthand's.
pub(super) fn expand(name: &Rc<str>, value: &Rc<[Value]>) -> Vec<Longhand> {
    let with = |name: &str| vec![(Rc::from(name), Rc::clone(value))];
    match &**name {
        "all" if property::wide_keyword(value).is_some() => {
            ALL.iter().flat_map(|name| with(name)).collect()
        }
        "all" => Vec::new(),
        "marker" => ["marker-start", "marker-mid", "marker-end"]
            .iter()
            .flat_map(|name| with(name))
            .collect(),
        "font" => font(value),
        "background" => background(value),
        "mask" | "mask-image" | "-webkit-mask" | "-webkit-mask-image" => mask(value),
        "-webkit-transform"
        | "-webkit-transform-origin"
        | "-webkit-filter"
        | "-webkit-clip-path"
        | "-webkit-opacity" => with(name.trim_start_matches("-webkit-")),
        "text-decoration-line" => with("text-decoration"),
        "font-width" => with("font-stretch"),
        "font-variant-caps" if is_word(value, "small-caps") => with("font-variant"),
        _ => with(name),
    }
}

fn is_word(value: &[Value], wanted: &str) -> bool {
    matches!(value, [word] if word.keyword().as_deref() == Some(wanted))
}

fn mask(value: &Rc<[Value]>) -> Vec<Longhand> {
    // Position, size and mode of a mask layer are about images; an element of SVG has its own.
    let url = value.iter().find(|value| matches!(value, Value::Url(_)));
    let value = match url {
        Some(url) => Rc::from([url.clone()]),
        None => Rc::clone(value),
    };
    vec![("mask".into(), value)]
}

/// The colour of `background`; images are said to be missing.
fn background(value: &Rc<[Value]>) -> Vec<Longhand> {
    if property::wide_keyword(value).is_some() {
        return vec![("background-color".into(), Rc::clone(value))];
    }
    let is_image = |value: &&Value| match value {
        Value::Url(_) => true,
        Value::Function(name, _) => {
            name.ends_with("gradient") || matches!(&**name, "image-set" | "image" | "cross-fade")
        }
        _ => false,
    };
    // The colour is in the last layer.
    let last = value
        .rsplit(|value| value.is_delim(','))
        .next()
        .unwrap_or_default();
    let is_color = |value: &&Value| match value {
        Value::Hash(_) => true,
        Value::Function(..) => !is_image(value),
        Value::Ident(_) => {
            let name = value.keyword().unwrap_or_default();
            let about_images = [
                "none",
                "repeat",
                "no-repeat",
                "repeat-x",
                "repeat-y",
                "space",
                "round",
                "scroll",
                "fixed",
                "local",
                "left",
                "right",
                "top",
                "bottom",
                "center",
                "cover",
                "contain",
                "auto",
                "border-box",
                "padding-box",
                "content-box",
                "text",
            ];
            !about_images.contains(&name.as_str())
        }
        _ => false,
    };
    let color = last.iter().find(is_color).cloned();
    let color = color.unwrap_or_else(|| Value::Ident("transparent".into()));
    let mut found = vec![("background-color".into(), Rc::from([color]))];
    if let Some(image) = value.iter().find(is_image) {
        found.push(("background-image".into(), Rc::from([image.clone()])));
    }
    found
}

/// `style variant weight stretch size/height family`.
fn font(value: &Rc<[Value]>) -> Vec<Longhand> {
    const PARTS: [&str; 6] = [
        "font-style",
        "font-variant",
        "font-weight",
        "font-stretch",
        "font-size",
        "font-family",
    ];
    if property::wide_keyword(value).is_some() {
        return PARTS.map(|name| (name.into(), Rc::clone(value))).into();
    }
    let word = |word: &str| Rc::from([Value::Ident(word.into())]);
    let system = [
        "caption",
        "icon",
        "menu",
        "message-box",
        "small-caption",
        "status-bar",
    ];
    if system.iter().any(|name| is_word(value, name)) {
        let size = Value::Dimension(13.333, "px".into());
        return vec![
            ("font-size".into(), Rc::from([size])),
            ("font-family".into(), word("sans-serif")),
        ];
    }
    let mut set: [Rc<[Value]>; 4] = std::array::from_fn(|_| word("normal"));
    let mut rest = trim(value);
    let mut count = 0;
    while let Some((first, after)) = rest.split_first() {
        let place = match first {
            Value::Ident(_) => match first.keyword().unwrap_or_default().as_str() {
                "normal" => None,
                "italic" | "oblique" => Some(0),
                "small-caps" => Some(1),
                "bold" | "bolder" | "lighter" => Some(2),
                name if name.ends_with("condensed") || name.ends_with("expanded") => Some(3),
                _ => break,
            },
            Value::Number(weight) if (1.0..=1000.0).contains(weight) => Some(2),
            // The angle of `oblique`.
            Value::Dimension(_, unit) if &**unit == "deg" => None,
            _ => break,
        };
        if let Some(place) = place.and_then(|place| set.get_mut(place)) {
            *place = Rc::from([first.clone()]);
        }
        rest = trim(after);
        count += 1;
        if count > 5 {
            return Vec::new();
        }
    }
    let Some((size, after)) = rest.split_first() else {
        return Vec::new();
    };
    let (height, family) = match trim(after) {
        [Value::Delim('/'), rest @ ..] => match trim(rest) {
            [height, rest @ ..] => (height.clone(), trim(rest)),
            [] => return Vec::new(),
        },
        rest => (Value::Ident("normal".into()), rest),
    };
    if words(family).is_empty() {
        return Vec::new();
    }
    let mut found: Vec<Longhand> = PARTS
        .iter()
        .zip(set)
        .map(|(name, value)| (Rc::from(*name), value))
        .collect();
    found.push(("font-size".into(), Rc::from([size.clone()])));
    found.push(("font-family".into(), family.into()));
    // Of HTML alone; no element of SVG has lines.
    found.push(("line-height".into(), Rc::from([height])));
    found
}
