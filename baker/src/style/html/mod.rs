//! Labels in HTML as texts of SVG: what Mermaid, draw.io and D3 write into `foreignObject`, as far as
//! it is lines of text in boxes. [`look`] reads styles, [`flow`] places boxes,
//! [`line`] fills lines, [`fonts`] measures.

mod flow;
mod fonts;
mod line;
mod look;
#[cfg(test)]
mod tests;

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use usvg::roxmltree::{Document, Node, NodeType};

use super::compute::{Computer, Inherited, Styled};
use super::elements::{is_label, px};
use super::output::{attribute, escape};
use super::value::length::{Quantity, Units};
use super::value::number_text;
use crate::error::BakeError;
use flow::{Flow, Item, Laid, Line, Part};
pub(crate) use fonts::Faces;
use fonts::Fonts;
use look::{Display, Frame, Look};

/// Levels of elements in a label. Layout is recursive; labels of programs stay below 10.
const MAX_LEVELS: usize = 64;

/// The content of each label as elements of SVG, by the label's node.
///
/// # Errors
/// [`BakeError::Limit`] for styles that ask for too much work.
pub(super) fn labels(
    document: &Document<'_>,
    computer: &mut Computer<'_>,
    styled: &[Option<Styled>],
    database: &Faces<'_>,
) -> Result<BTreeMap<usize, String>, BakeError> {
    let mut all = Vec::new();
    let mut overflows = BTreeSet::new();
    let mut around = Around::default();
    for node in document.descendants().filter(|node| is_label(*node)) {
        if let Some(Some(own)) = styled.get(node.id().get_usize()) {
            let inherited = own.inherited.clone();
            let mut look = outer_look(node, styled, &inherited);
            around.lines(node, computer, styled, &mut look)?;
            let area = area(node, own);
            let frame = Frame {
                height: Some(Quantity::Length(area[3], 0.0)),
                ..frame(Display::Block)
            };
            let mut part = Part {
                look: Rc::new(look),
                frame,
                items: Vec::new(),
            };
            let look = Rc::clone(&part.look);
            let mut reader = Reader {
                computer,
                label: node,
            };
            reader.children(node, &look, &inherited, (0, false), &mut part.items)?;
            if overflow(node, own).is_some_and(|text| matches!(text, "visible" | "auto")) {
                overflows.insert(node.id().get_usize());
            }
            all.push((node, part, area));
        }
    }
    let mut fonts = Fonts::new(database);
    let work = Cell::new(0);
    let lay = |fonts: &Fonts, is_last: bool| {
        let mut found = BTreeMap::new();
        for (node, part, [x, y, width, height]) in &all {
            let flow = Flow { fonts, work: &work };
            let laid = flow.part(part, [*width, *height]);
            if flow.is_over() && is_last {
                let message = "labels in HTML take too much work";
                computer.report.missing(*node, "foreignObject", message);
            } else {
                let mut content = written(&laid, [*x, *y]);
                let is_clipped = !overflows.contains(&node.id().get_usize());
                if is_clipped && !laid.is_within([*width, *height]) {
                    content = clipped(&content, node.id().get_usize(), [*x, *y, *width, *height]);
                }
                found.insert(node.id().get_usize(), content);
            }
        }
        found
    };
    lay(&fonts, false);
    fonts.measure();
    Ok(lay(&fonts, true))
}

fn frame(display: Display) -> Frame {
    Frame {
        display,
        margin: [0.0; 4],
        padding: [0.0; 4],
        width: None,
        max_width: None,
        height: None,
        justify: 0.0,
        align_items: None,
        is_column: false,
        includes_padding: false,
        is_root: true,
        background: None,
    }
}

/// What elements of SVG say about lines of HTML in them.
#[derive(Default)]
struct Around(BTreeMap<usize, Rc<look::Declared>>);

impl Around {
    /// Puts what `label` inherits about lines into `look`.
    fn lines(
        &mut self,
        label: Node<'_, '_>,
        computer: &mut Computer<'_>,
        styled: &[Option<Styled>],
        look: &mut Look,
    ) -> Result<(), BakeError> {
        let mut outer: Vec<_> = label.ancestors().filter(Node::is_element).collect();
        outer.reverse();
        for node in outer {
            let index = node.id().get_usize();
            let Some(Some(own)) = styled.get(index) else {
                continue;
            };
            let declared = match self.0.get(&index) {
                Some(declared) => Rc::clone(declared),
                None => {
                    let (_, declared) = computer.html(node, &own.inherited)?;
                    Rc::clone(self.0.entry(index).or_insert(Rc::new(declared)))
                }
            };
            let units = Units {
                font_size_px: own.inherited.font_size_px,
                root_font_size_px: computer.root_font_size_px,
                canvas_px: computer.canvas_px,
                names: &[],
            };
            look::lines(&declared, units, look);
        }
        Ok(())
    }
}

/// Left, top, width and height.
fn area(node: Node<'_, '_>, styled: &Styled) -> [f64; 4] {
    let [width, height] = styled.inherited.viewport;
    [
        ("x", width),
        ("y", height),
        ("width", width),
        ("height", height),
    ]
    .map(|(name, whole)| {
        let text = match styled.attributes.get(name) {
            Some(text) => text.as_deref(),
            None => node.attribute(name),
        };
        let percent = text.and_then(|text| text.trim().strip_suffix('%'));
        let length = match percent {
            Some(percent) => percent.parse().ok().map(|share: f64| share * whole / 100.0),
            None => text.and_then(px),
        };
        length.filter(|px| px.is_finite()).unwrap_or(0.0)
    })
}

/// What the content takes from the elements of SVG around it.
fn outer_look(node: Node<'_, '_>, styled: &[Option<Styled>], inherited: &Inherited) -> Look {
    let find = |name: &str| {
        node.ancestors().find_map(|outer| {
            let own = styled.get(outer.id().get_usize()).and_then(Option::as_ref);
            match own.and_then(|own| own.attributes.get(name)) {
                Some(text) => text.clone(),
                None => outer.attribute(name).map(str::to_owned),
            }
        })
    };
    let families = find("font-family").unwrap_or_else(|| "serif".to_owned());
    let weight = find("font-weight").unwrap_or_else(|| "normal".to_owned());
    let is_italic = find("font-style").is_some_and(|style| style != "normal");
    look::first(inherited, &families, &weight, is_italic)
}

struct Reader<'c, 'a, 'd> {
    computer: &'c mut Computer<'a>,
    label: Node<'d, 'd>,
}

impl Reader<'_, '_, '_> {
    /// Adds the content of `node`.
    fn children(
        &mut self,
        node: Node<'_, '_>,
        look: &Rc<Look>,
        inherited: &Inherited,
        (level, in_flex): (usize, bool),
        items: &mut Vec<Item>,
    ) -> Result<(), BakeError> {
        if level > MAX_LEVELS {
            self.beyond("elements nested deep");
            return Ok(());
        }
        for child in node.children() {
            match child.node_type() {
                NodeType::Text => {
                    let text = child.text().unwrap_or("").to_owned();
                    items.push(Item::Text(Rc::clone(look), text));
                }
                NodeType::Element if child.tag_name().name().eq_ignore_ascii_case("br") => {
                    items.push(Item::Break);
                }
                NodeType::Element => {
                    self.element(child, look, inherited, (level, in_flex), items)?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn element(
        &mut self,
        node: Node<'_, '_>,
        outer: &Rc<Look>,
        inherited: &Inherited,
        (level, in_flex): (usize, bool),
        items: &mut Vec<Item>,
    ) -> Result<(), BakeError> {
        let (custom, declared) = self.computer.html(node, inherited)?;
        let mut inherited = Inherited {
            custom,
            ..inherited.clone()
        };
        let sizes = (self.computer.root_font_size_px, self.computer.canvas_px);
        let (look, frame, beyond) = look::of(node, &declared, outer, &mut inherited, sizes);
        for feature in &beyond {
            self.beyond(feature);
        }
        let look = Rc::new(look);
        let mut frame = frame;
        frame.is_root |= in_flex;
        if in_flex && frame.display == Display::Inline {
            frame.display = Display::Block;
            frame.background.clone_from(&look.background);
        }
        match frame.display {
            Display::None => Ok(()),
            Display::Inline => self.children(node, &look, &inherited, (level + 1, false), items),
            display => {
                let is_flex = display == Display::Flex;
                let mut part = Part {
                    look: Rc::clone(&look),
                    frame,
                    items: Vec::new(),
                };
                self.children(
                    node,
                    &look,
                    &inherited,
                    (level + 1, is_flex),
                    &mut part.items,
                )?;
                items.push(Item::Part(part));
                Ok(())
            }
        }
    }

    fn beyond(&self, feature: &str) {
        let message = format!("{feature} in HTML is not drawn");
        self.computer
            .report
            .missing(self.label, "foreignObject", &message);
    }
}

fn overflow<'a>(node: Node<'a, '_>, styled: &'a Styled) -> Option<&'a str> {
    match styled.attributes.get("overflow") {
        Some(text) => text.as_deref(),
        None => node.attribute("overflow"),
    }
}

/// `content` within the area of its label, as browsers cut it.
fn clipped(content: &str, index: usize, area: [f64; 4]) -> String {
    let [x, y, width, height] = area.map(number_text);
    let id = format!("vtex-style-label-{index}");
    format!(
        "<clipPath id=\"{id}\"><rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/></clipPath><g \
         clip-path=\"url(#{id})\">{content}</g>"
    )
}

/// The elements that show a layout at a place.
fn written(laid: &Laid, [left, top]: [f64; 2]) -> String {
    let n = number_text;
    let mut out = String::new();
    for ([x, y, width, height], color) in &laid.grounds {
        let [x, y] = [n(left + x), n(top + y)];
        let [width, height] = [n(*width), n(*height)];
        out += &format!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"{color}\" stroke=\"none\"/>"
        );
    }
    for line in &laid.lines {
        text(line, [left, top], &mut out);
    }
    out
}

fn text(line: &Line, [left, top]: [f64; 2], out: &mut String) {
    let anchor = match line.align {
        0 => "middle",
        1 => "end",
        _ => "start",
    };
    let [x, y] = [left + line.x, top + line.baseline].map(number_text);
    *out += &format!(
        "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" xml:space=\"preserve\" stroke=\"none\" fill-opacity=\"1\">"
    );
    for (look, run) in &line.runs {
        out.push_str("<tspan");
        attribute("fill", &look.color, out);
        attribute("font-size", &number_text(look.font_size_px), out);
        attribute("font-family", &look.families, out);
        attribute("font-weight", &look.weight, out);
        attribute(
            "font-style",
            if look.is_italic { "italic" } else { "normal" },
            out,
        );
        if !look.decoration.is_empty() {
            attribute("text-decoration", look.decoration, out);
        }
        if look.raise_px != 0.0 {
            attribute("baseline-shift", &number_text(look.raise_px), out);
        }
        out.push('>');
        escape(run, out);
        out.push_str("</tspan>");
    }
    out.push_str("</text>");
}
