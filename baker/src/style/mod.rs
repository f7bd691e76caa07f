//! A style stage ahead of usvg: CSS in, attributes that usvg reads out (decision 0028).
//!
//! [`needed`] decides whether a document has styles that usvg does not read as browsers do; one
//! without them is not touched. [`sheet`] parses style sheets to rules, [`cascade`] finds the
//! declarations for an element, [`compute`] puts custom properties in and makes attributes of them,
//! with what [`value`] knows of colours, lengths and transforms. [`boxes`] does what depends on the
//! box of an element, [`output`] writes the text, and [`report`] says what is not drawn.

mod boxes;
mod cascade;
mod compute;
mod elements;
mod html;
mod needed;
mod output;
mod property;
mod report;
mod sheet;
mod shorthand;
mod syntax;
#[cfg(test)]
mod tests;
mod value;
mod variables;

pub(crate) use html::Faces;

use std::collections::BTreeMap;
use std::rc::Rc;

use usvg::roxmltree::{Document, Node, NodeType};

use elements::{canvas_of, is_svg};

use crate::error::BakeError;
use crate::warning::Warnings;
use sheet::Sheets;
use sheet::condition::Medium;
use sheet::matching::Matcher;

/// Deepest nesting of elements; usvg refuses more too, with its own words.
const MAX_DEPTH: usize = 1024;

/// The text of `document` with attributes in place of its styles, or `None` where usvg reads the
/// styles as they are.
///
/// # Errors
/// [`BakeError::Limit`] for styles that ask for too much work.
pub(crate) fn resolve(
    document: &Document<'_>,
    fonts: &Faces<'_>,
    warnings: &Warnings,
) -> Result<Option<String>, BakeError> {
    let root = document.root_element();
    if !is_svg(root) || is_deep(document) {
        return Ok(None);
    }
    let canvas_px = canvas_of(root);
    let medium = Medium { canvas_px };
    // What the sheets say is said only where they are used.
    let told = Warnings::default();
    let sheets = Sheets::parse(&texts(document, medium), medium, &told)?;
    let report = report::Report::new(document);
    report.what_moves(document);
    let filters = needed::Filters::new(document);
    if !has_media(document) && !needed::is_needed(document, &sheets, &filters)? {
        report.finish(warnings);
        return Ok(None);
    }
    told.into_list()
        .into_iter()
        .for_each(|warning| warnings.add(warning));
    let matcher = Matcher::new(document);
    let mut variables = variables::Variables::default();
    let first = sheets.registered.iter().filter_map(|(name, first, _)| {
        first
            .as_ref()
            .map(|first| (Rc::clone(name), Rc::clone(first)))
    });
    let first: BTreeMap<_, _> = first.collect();
    let first = variables.resolve(first, &Rc::default())?;
    let mut computer = compute::Computer {
        cascade: cascade::Cascade::new(&sheets, &matcher),
        report: &report,
        canvas_px,
        first,
        variables,
        root_font_size_px: 16.0,
        filters: &filters,
    };
    let mut styled = computer.document(document)?;
    let labels = html::labels(document, &mut computer, &styled, fonts)?;
    let mut boxes = boxes::Boxes {
        styled: &mut styled,
        root_font_size_px: computer.root_font_size_px,
        canvas_px,
        definitions: Vec::new(),
        visits: 0,
    };
    for (node, feature, message) in boxes.finish(document) {
        report.missing(node, feature, message);
    }
    let definitions = std::mem::take(&mut boxes.definitions);
    report.finish(warnings);
    Ok(Some(output::write(
        document,
        &styled,
        &definitions,
        &labels,
    )))
}

fn is_deep(document: &Document<'_>) -> bool {
    let mut depths: Vec<usize> = Vec::new();
    for node in document.descendants() {
        let above = node
            .parent()
            .and_then(|parent| depths.get(parent.id().get_usize()));
        let depth = above.copied().unwrap_or(0) + 1;
        if depth > MAX_DEPTH {
            return true;
        }
        depths.resize(node.id().get_usize(), 0);
        depths.push(depth);
    }
    false
}

fn style_elements<'a, 'd>(document: &'a Document<'d>) -> impl Iterator<Item = Node<'a, 'd>> {
    document.descendants().filter(|node| {
        let is_style = node.is_element() && node.tag_name().name() == "style";
        let kind = node
            .attribute("type")
            .unwrap_or("")
            .trim()
            .to_ascii_lowercase();
        is_style && matches!(kind.as_str(), "" | "text/css")
    })
}

/// Whether a style sheet says for which media it is, or has its text in parts, which usvg ignores.
fn has_media(document: &Document<'_>) -> bool {
    style_elements(document).any(|node| {
        let texts = node
            .children()
            .filter(|child| child.node_type() == NodeType::Text);
        node.attribute("media").is_some() || texts.count() > 1
    })
}

/// Texts of the style sheets that are for the picture.
fn texts(document: &Document<'_>, medium: Medium) -> Vec<String> {
    let shown = style_elements(document).filter(|node| {
        let media = node.attribute("media").map(syntax::parse);
        media.is_none_or(|media| media.is_ok_and(|media| medium.shows(&media)))
    });
    let text = |node: Node<'_, '_>| {
        let texts = node
            .children()
            .filter(|child| child.node_type() == NodeType::Text);
        texts.filter_map(|child| child.text()).collect::<String>()
    };
    shown.map(text).collect()
}
