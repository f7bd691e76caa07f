//! The document with attributes in place of its styles, as text.

use std::collections::BTreeMap;

use usvg::roxmltree::{Document, Node, NodeType};

use super::compute::Styled;
use super::value::filter::primitives;

const SVG: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";
const XML: &str = "http://www.w3.org/XML/1998/namespace";

/// Properties that usvg does not take from attributes of their name.
const IN_STYLE: [&str; 4] = [
    "mix-blend-mode",
    "isolation",
    "font-kerning",
    "image-rendering",
];

/// Writes `document`. `definitions` are added at the end of the root; `labels` are what stands for
/// nodes of HTML labels.
pub(super) fn write(
    document: &Document<'_>,
    styled: &[Option<Styled>],
    definitions: &[String],
    labels: &BTreeMap<usize, String>,
) -> String {
    let mut out = String::new();
    let attribute_of = |node: Node<'_, '_>, name: &str| {
        let styled = styled.get(node.id().get_usize()).and_then(Option::as_ref);
        match styled.and_then(|styled| styled.attributes.get(name)) {
            Some(text) => text.clone(),
            None => node.attribute(name).map(str::to_owned),
        }
    };
    let mut next = document.root().first_child();
    // Without recursion: nesting is bounded elsewhere, and a stack is not needed.
    while let Some(node) = next {
        let is_style = super::elements::is_svg(node) && node.tag_name().name() == "style";
        let shadow = light_shadow(node, &attribute_of);
        let label = labels.get(&node.id().get_usize());
        let is_left_out = is_style || shadow.is_some() || label.is_some();
        out += &shadow.unwrap_or_default();
        if let Some(label) = label {
            self::label(
                node,
                styled.get(node.id().get_usize()).and_then(Option::as_ref),
                label,
                &mut out,
            );
        }
        if let Some(Some(styled)) = styled.get(node.id().get_usize()) {
            out += &styled.before;
        }
        if !is_left_out {
            open(
                node,
                styled.get(node.id().get_usize()).and_then(Option::as_ref),
                &mut out,
            );
        }
        if let Some(child) = node
            .first_child()
            .filter(|_| node.is_element() && !is_left_out)
        {
            next = Some(child);
            continue;
        }
        if !is_left_out {
            close(node, styled, definitions, &mut out);
        }
        let mut here = node;
        next = loop {
            if let Some(sibling) = here.next_sibling() {
                break Some(sibling);
            }
            match here.parent().filter(|parent| parent.is_element()) {
                Some(parent) => {
                    close(parent, styled, definitions, &mut out);
                    here = parent;
                }
                None => break None,
            }
        };
    }
    out
}

/// Primitives in place of a drop shadow that resvg would lighten.
fn light_shadow(
    node: Node<'_, '_>,
    attribute_of: &dyn Fn(Node<'_, '_>, &str) -> Option<String>,
) -> Option<String> {
    if !super::elements::is_svg(node) || node.tag_name().name() != "feDropShadow" {
        return None;
    }
    let mut space = node
        .ancestors()
        .filter_map(|outer| attribute_of(outer, "color-interpolation-filters"));
    if space.next().as_deref() != Some("sRGB") {
        return None;
    }
    let list = |names: &[&str]| {
        let mut out = String::new();
        for name in names {
            if let Some(value) = attribute_of(node, name) {
                attribute(name, &value, &mut out);
            }
        }
        out
    };
    let number = |name: &str, default: &str| {
        let text = attribute_of(node, name).unwrap_or_else(|| default.to_owned());
        let is_number = |c: char| c.is_ascii_digit() || " \t\r\n,.+-eE".contains(c);
        if text.chars().all(is_number) {
            text
        } else {
            default.to_owned()
        }
    };
    Some(primitives(
        &list(&["in"]),
        &list(&["flood-color", "flood-opacity", "color"]),
        &number("stdDeviation", "2"),
        &[number("dx", "2"), number("dy", "2")],
        &list(&["result", "x", "y", "width", "height"]),
    ))
}

fn open(node: Node<'_, '_>, styled: Option<&Styled>, out: &mut String) {
    match node.node_type() {
        NodeType::Element => {}
        NodeType::Text => return escape(node.text().unwrap_or(""), out),
        // It stays, because texts on both sides of it are two.
        NodeType::Comment => return out.push_str("<!---->"),
        NodeType::Root | NodeType::PI => return,
    }
    out.push('<');
    out.push_str(name_of(node, styled));
    let namespace = namespace_of(node);
    let outer = node.parent_element().map(namespace_of);
    if outer != Some(namespace) {
        attribute("xmlns", namespace, out);
    }
    if outer.is_none() {
        attribute("xmlns:xlink", XLINK, out);
    }
    attributes(node, styled, out);
    out.push('>');
}

/// Writes the attributes of `node`, with those that it gets.
fn attributes(node: Node<'_, '_>, styled: Option<&Styled>, out: &mut String) {
    let is_label = node.tag_name().name() == "foreignObject";
    let is_dropped = |name: &str| match name {
        // SVG 2 has it no more, and browsers pass over it.
        "requiredFeatures" => true,
        "x" | "y" | "width" | "height" | "requiredExtensions" => is_label,
        _ => false,
    };
    for found in node.attributes() {
        let prefix = match found.namespace() {
            None => "",
            Some(XLINK) => "xlink:",
            Some(XML) => "xml:",
            // usvg takes these as if they had no namespace.
            Some(SVG) => "",
            Some(_) => continue,
        };
        let name = found.name();
        let is_replaced = styled.is_some_and(|styled| {
            matches!(name, "style" | "class") || styled.attributes.contains_key(name)
        });
        if !((is_replaced || is_dropped(name)) && prefix.is_empty()) {
            attribute(&format!("{prefix}{name}"), found.value(), out);
        }
    }
    let mut style = String::new();
    for (name, value) in styled.iter().flat_map(|styled| &styled.attributes) {
        match value {
            Some(value) if IN_STYLE.contains(&&**name) => style += &format!("{name}:{value};"),
            Some(value) if !is_dropped(name) => attribute(name, value, out),
            Some(_) => {}
            None => {}
        }
    }
    if !style.is_empty() {
        attribute("style", &style, out);
    }
}

/// The namespace to write. Elements without one are SVG to usvg, but not where that is written.
fn namespace_of<'a>(node: Node<'a, '_>) -> &'a str {
    match super::elements::is_svg(node) {
        true => SVG,
        false => node.tag_name().namespace().unwrap_or(""),
    }
}

/// A group in place of a `foreignObject`.
fn label(node: Node<'_, '_>, styled: Option<&Styled>, content: &str, out: &mut String) {
    out.push_str("<g");
    attribute("xmlns", SVG, out);
    attributes(node, styled, out);
    out.push('>');
    out.push_str(content);
    out.push_str("</g>");
}

fn name_of<'a>(node: Node<'a, '_>, styled: Option<&Styled>) -> &'a str {
    match styled.is_some_and(|styled| styled.is_path) {
        true => "path",
        false => node.tag_name().name(),
    }
}

fn close(node: Node<'_, '_>, styled: &[Option<Styled>], definitions: &[String], out: &mut String) {
    if !node.is_element() {
        return;
    }
    if node.parent_element().is_none() {
        definitions
            .iter()
            .for_each(|definition| out.push_str(definition));
    }
    out.push_str("</");
    let styled = styled.get(node.id().get_usize()).and_then(Option::as_ref);
    out.push_str(name_of(node, styled));
    out.push('>');
}

pub(super) fn attribute(name: &str, value: &str, out: &mut String) {
    out.push(' ');
    out.push_str(name);
    out.push_str("=\"");
    escape(value, out);
    out.push('"');
}

pub(super) fn escape(text: &str, out: &mut String) {
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            // XML would make blanks of them in attributes.
            '\t' | '\n' | '\r' => *out += &format!("&#{};", u32::from(c)),
            _ => out.push(c),
        }
    }
}
