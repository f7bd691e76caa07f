//! What CSS and the browser's own sheet say about one element of HTML, as far as labels need it.

use std::collections::BTreeMap;
use std::rc::Rc;

use color::DynamicColor;
use usvg::roxmltree::Node;

use crate::style::cascade::Entry;
use crate::style::compute::Inherited;
use crate::style::syntax::{self, Value, words};
use crate::style::value::color::{Surroundings, dialect};
use crate::style::value::length::{Quantity, Units, named_font_size_px};

/// What children inherit.
#[derive(Clone, Debug)]
pub(super) struct Look {
    pub(super) color: String,
    pub(super) font_size_px: f64,
    pub(super) families: Rc<str>,
    pub(super) weight: Rc<str>,
    pub(super) is_italic: bool,
    pub(super) decoration: &'static str,
    /// -1, 0 and 1: left, centre, right.
    pub(super) align: i8,
    /// A factor of the font's size or px; `None` is what the font asks for.
    line_height: Option<Quantity>,
    pub(super) wraps: bool,
    pub(super) keeps_breaks: bool,
    /// Whether a space at the end of a line has a width.
    pub(super) keeps_spaces: bool,
    /// How far the text is raised, in px.
    pub(super) raise_px: f64,
    /// Behind inline text.
    pub(super) background: Option<String>,
}

impl Look {
    pub(super) fn line_height_px(&self) -> Option<f64> {
        match self.line_height? {
            Quantity::Number(factor) => Some(factor * self.font_size_px),
            quantity => quantity.length_px(self.font_size_px),
        }
    }
}

/// How an element takes part in the layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Display {
    None,
    Inline,
    Block,
    /// As wide as its content; placed by the alignment of what it is in.
    InlineBlock,
    /// As wide as its content, at the left.
    Table,
    Flex,
}

/// What is not inherited.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub(super) display: Display,
    /// Top, right, bottom, left.
    pub(super) margin: [f64; 4],
    pub(super) padding: [f64; 4],
    pub(super) width: Option<Quantity>,
    pub(super) max_width: Option<Quantity>,
    pub(super) height: Option<Quantity>,
    /// Of a flex box: a share from start to end, and `None` for stretched.
    pub(super) justify: f64,
    pub(super) align_items: Option<f64>,
    pub(super) is_column: bool,
    pub(super) includes_padding: bool,
    /// Whether margins of its content stay inside.
    pub(super) is_root: bool,
    pub(super) background: Option<String>,
}

/// What is not drawn of an element: its tag or its property.
pub(super) type Beyond = Vec<String>;

/// The look of `foreignObject`'s content before any element of HTML.
pub(super) fn first(inherited: &Inherited, families: &str, weight: &str, is_italic: bool) -> Look {
    Look {
        color: dialect(inherited.current),
        font_size_px: inherited.font_size_px,
        families: families.into(),
        weight: weight.into(),
        is_italic,
        decoration: "",
        align: -1,
        line_height: None,
        wraps: true,
        keeps_breaks: false,
        keeps_spaces: false,
        raise_px: 0.0,
        background: None,
    }
}

pub(super) type Declared = BTreeMap<Rc<str>, Vec<Entry>>;

/// Declared values by the names of properties.
struct Values<'a>(&'a Declared);

impl Values<'_> {
    fn value(&self, name: &str) -> Option<Rc<[Value]>> {
        let entry = self.0.get(name)?.last()?;
        (!entry.value.is_empty()).then(|| Rc::clone(&entry.value))
    }

    fn keyword(&self, name: &str) -> Option<String> {
        words(&self.value(name)?).first()?.keyword()
    }

    fn text(&self, name: &str) -> Option<String> {
        let value = self.value(name)?;
        Some(syntax::text(syntax::trim(&value)))
    }

    fn quantity(&self, name: &str, units: Units<'_>) -> Option<Quantity> {
        units.quantity(words(&self.value(name)?).first()?)
    }

    fn color(&self, name: &str, around: &Surroundings<'_>) -> Option<DynamicColor> {
        around.resolved(words(&self.value(name)?).first()?)
    }

    /// Where a flex box has its content: 0 at the start, 1 at the end.
    fn share(&self, name: &str) -> Option<f64> {
        let value = self.value(name)?;
        let words = words(&value);
        let safety = |word: &&Value| matches!(word.keyword().as_deref(), Some("safe" | "unsafe"));
        let word = words.iter().find(|word| !safety(word))?;
        match word.keyword()?.as_str() {
            "center" | "space-around" | "space-evenly" => Some(0.5),
            "end" | "flex-end" | "right" => Some(1.0),
            "start" | "flex-start" | "left" | "baseline" => Some(0.0),
            _ => None,
        }
    }

    /// Properties that are not drawn.
    fn beyond(&self, beyond: &mut Beyond) {
        for (name, harmless) in [
            ("position", ["static", "relative"]),
            ("float", ["none", "none"]),
            ("text-transform", ["none", "none"]),
            ("border", ["none", "none"]),
            ("transform", ["none", "none"]),
        ] {
            let is_drawn = |text: &String| harmless.contains(&&**text) || text.starts_with('0');
            if let Some(text) = self.text(name).filter(|text| !is_drawn(text)) {
                beyond.push(format!("{name}: {text}"));
            }
        }
    }

    fn display(&self, default: Display, beyond: &mut Beyond) -> Display {
        match self.keyword("display").as_deref() {
            Some("none") => Display::None,
            Some("inline" | "contents") => Display::Inline,
            Some("block" | "list-item" | "flow-root") => Display::Block,
            Some("inline-block") => Display::InlineBlock,
            Some("table" | "table-cell" | "inline-table") => Display::Table,
            Some("flex" | "inline-flex") => Display::Flex,
            Some("grid" | "inline-grid") => {
                beyond.push("display: grid".to_owned());
                Display::Block
            }
            _ => default,
        }
    }
}

/// The look and frame of `node`. `inherited` is that of its parent and becomes its own.
pub(super) fn of(
    node: Node<'_, '_>,
    declared: &Declared,
    outer: &Look,
    inherited: &mut Inherited,
    (root_font_size_px, canvas_px): (f64, [f64; 2]),
) -> (Look, Frame, Beyond) {
    let values = Values(declared);
    let mut look = outer.clone();
    let tag = node.tag_name().name().to_ascii_lowercase();
    look.background = outer.background.clone().filter(|_| is_inline(&tag));
    let mut beyond = Vec::new();
    let (display, margin_em) = of_tag(&tag, &mut look, &mut beyond);
    let mut units = Units {
        font_size_px: outer.font_size_px,
        root_font_size_px,
        canvas_px,
        names: &[],
    };
    let size = values.value("font-size");
    if let Some(size) = size.and_then(|size| font_size(&size, units, outer)) {
        look.font_size_px = size;
    }
    inherited.font_size_px = look.font_size_px;
    units.font_size_px = look.font_size_px;
    let around = Surroundings {
        units,
        current: inherited.current,
        is_dark: inherited.is_dark,
    };
    if let Some(found) = values.color("color", &around) {
        inherited.current = found;
        look.color = dialect(found);
    }
    letters(&values, &mut look);
    lines(declared, units, &mut look);
    values.beyond(&mut beyond);
    let display = values.display(display, &mut beyond);
    let around = Surroundings {
        current: inherited.current,
        ..around
    };
    let background = values.color("background-color", &around);
    let background = background.filter(|color| color.components[3] > 0.0);
    let background = background.map(dialect);
    if display == Display::Inline && background.is_some() {
        look.background.clone_from(&background);
    }
    let em = margin_em * look.font_size_px;
    let body = if tag == "body" { 8.0 } else { 0.0 };
    let margin = [em + body, body, em + body, body];
    let frame = Frame {
        display,
        margin: sides(&values, "margin", units, margin),
        padding: sides(&values, "padding", units, [0.0; 4]),
        width: values.quantity("width", units),
        max_width: values.quantity("max-width", units),
        height: values.quantity("height", units),
        justify: values.share("justify-content").unwrap_or(0.0),
        align_items: values.share("align-items"),
        is_column: values
            .keyword("flex-direction")
            .is_some_and(|way| way.starts_with("column")),
        includes_padding: values.keyword("box-sizing").as_deref() == Some("border-box"),
        is_root: !matches!(display, Display::Inline | Display::Block),
        background: background.filter(|_| display != Display::Inline),
    };
    (look, frame, beyond)
}

/// Reads what letters look like, their size and colour aside.
fn letters(values: &Values<'_>, look: &mut Look) {
    if let Some(families) = values.text("font-family") {
        look.families = families.into();
    }
    if let Some(weight) = values.text("font-weight") {
        look.weight = weight.into();
    }
    if let Some(style) = values.keyword("font-style") {
        look.is_italic = matches!(style.as_str(), "italic" | "oblique");
    }
    match values.keyword("text-decoration").as_deref() {
        Some("underline") => look.decoration = "underline",
        Some("line-through") => look.decoration = "line-through",
        Some("overline") => look.decoration = "overline",
        Some("none") => look.decoration = "",
        _ => {}
    }
}

/// How lines are made, which elements of SVG hand down too.
pub(super) fn lines(declared: &Declared, units: Units<'_>, look: &mut Look) {
    let values = Values(declared);
    match values.keyword("text-align").as_deref() {
        Some("center" | "-webkit-center") => look.align = 0,
        Some("left" | "start" | "justify") => look.align = -1,
        Some("right" | "end") => look.align = 1,
        _ => {}
    }
    if values.value("line-height").is_some() {
        look.line_height = values.quantity("line-height", units);
    }
    if let Some(space) = values.keyword("white-space") {
        look.wraps = !matches!(space.as_str(), "nowrap" | "pre");
        look.keeps_breaks = matches!(
            space.as_str(),
            "pre" | "pre-wrap" | "pre-line" | "break-spaces"
        );
        look.keeps_spaces = space == "break-spaces";
    }
}

/// What the browser's own sheet says: display, and the margins above and below in em.
fn of_tag(tag: &str, look: &mut Look, beyond: &mut Beyond) -> (Display, f64) {
    let bold = |look: &mut Look, factor: f64| {
        look.weight = "bold".into();
        look.font_size_px *= factor;
    };
    match tag {
        "b" | "strong" => bold(look, 1.0),
        "i" | "em" | "cite" | "var" | "dfn" => look.is_italic = true,
        "u" | "ins" => look.decoration = "underline",
        "s" | "strike" | "del" => look.decoration = "line-through",
        "small" => look.font_size_px /= 1.2,
        "big" => look.font_size_px *= 1.2,
        "sub" | "sup" => {
            look.raise_px += look.font_size_px * if tag == "sup" { 1.0 / 3.0 } else { -0.2 };
            look.font_size_px /= 1.2;
        }
        "code" | "kbd" | "samp" | "tt" | "pre" => {
            look.families = "monospace".into();
            look.font_size_px *= 13.0 / 16.0;
            (look.wraps, look.keeps_breaks) = match tag {
                "pre" => (false, true),
                _ => (look.wraps, look.keeps_breaks),
            };
        }
        "mark" => look.background = Some("#ffff00".to_owned()),
        "center" => look.align = 0,
        "h1" => bold(look, 2.0),
        "h2" => bold(look, 1.5),
        "h3" => bold(look, 1.17),
        "h4" => bold(look, 1.0),
        "h5" => bold(look, 0.83),
        "h6" => bold(look, 0.67),
        "ul" | "ol" | "table" | "hr" | "img" | "svg" | "math" | "canvas" | "video" | "iframe"
        | "input" | "button" | "select" | "textarea" | "object" => beyond.push(format!("<{tag}>")),
        _ => {}
    }
    match tag {
        "p" | "pre" | "ul" | "ol" | "blockquote" | "figure" | "h4" => {
            (Display::Block, if tag == "h4" { 1.33 } else { 1.0 })
        }
        "h1" => (Display::Block, 0.67),
        "h2" => (Display::Block, 0.83),
        "h3" => (Display::Block, 1.0),
        "h5" => (Display::Block, 1.67),
        "h6" => (Display::Block, 2.33),
        "head" | "style" | "script" | "title" | "meta" | "link" | "template" | "img" | "svg"
        | "math" | "canvas" | "video" | "iframe" | "input" | "select" | "textarea" | "object"
        | "hr" => (Display::None, 0.0),
        tag if is_inline(tag) => (Display::Inline, 0.0),
        _ => (Display::Block, 0.0),
    }
}

fn is_inline(tag: &str) -> bool {
    matches!(
        tag,
        "span"
            | "b"
            | "strong"
            | "i"
            | "em"
            | "cite"
            | "var"
            | "dfn"
            | "u"
            | "ins"
            | "s"
            | "strike"
            | "del"
            | "small"
            | "big"
            | "sub"
            | "sup"
            | "code"
            | "kbd"
            | "samp"
            | "tt"
            | "mark"
            | "a"
            | "font"
            | "label"
            | "q"
            | "abbr"
            | "time"
            | "bdi"
            | "bdo"
            | "br"
            | "wbr"
    )
}

fn font_size(values: &[Value], units: Units<'_>, outer: &Look) -> Option<f64> {
    let words = words(values);
    let value = words.first()?;
    let size = match value.keyword() {
        Some(name) => named_font_size_px(&name, outer.font_size_px)?,
        None => match units.quantity(value)? {
            Quantity::Number(px) if px != 0.0 => return None,
            quantity => quantity.length_px(outer.font_size_px)?,
        },
    };
    (size >= 0.0).then_some(size)
}

/// `margin: a b c d` and `margin-top` and so on. Percentages and `auto` count as 0.
fn sides(values: &Values<'_>, name: &str, units: Units<'_>, default: [f64; 4]) -> [f64; 4] {
    let px = |value: &Value| {
        let quantity = units.quantity(value);
        quantity
            .and_then(|quantity| quantity.length_px(0.0))
            .unwrap_or(0.0)
    };
    let mut sides = default;
    if let Some(all) = values.value(name) {
        let all: Vec<f64> = words(&all).into_iter().map(px).collect();
        sides = match all.as_slice() {
            [a] => [*a; 4],
            [a, b] => [*a, *b, *a, *b],
            [a, b, c] => [*a, *b, *c, *b],
            [a, b, c, d] => [*a, *b, *c, *d],
            _ => sides,
        };
    }
    for (side, end) in sides.iter_mut().zip(["top", "right", "bottom", "left"]) {
        if let Some(one) = values.value(&format!("{name}-{end}")) {
            *side = words(&one).first().map_or(0.0, |value| px(value));
        }
    }
    sides
}
