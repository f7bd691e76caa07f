//! What the stage reads and does not draw, for the warnings of the bake.

use std::cell::RefCell;
use std::collections::BTreeMap;

use usvg::roxmltree::{Document, Node};
use vtex_format::WarningCode;

use crate::warning::Warnings;

/// Collects what is not drawn: one warning for each feature and message, however many elements
/// have it.
pub(super) struct Report {
    /// Where each line of the document starts, in bytes.
    lines: Vec<usize>,
    told: RefCell<Told>,
}

#[derive(Default)]
struct Told {
    list: Vec<Missing>,
    places: BTreeMap<(String, String), usize>,
}

struct Missing {
    feature: String,
    message: String,
    /// The first element's id, or nothing.
    element: String,
    line: usize,
    count: usize,
}

impl Report {
    pub(super) fn new(document: &Document<'_>) -> Self {
        let text = document.input_text();
        let breaks = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        Self {
            lines: breaks.map(|(at, _)| at).collect(),
            told: RefCell::default(),
        }
    }

    /// Says that something of `node` is not drawn.
    pub(super) fn missing(&self, node: Node<'_, '_>, feature: &str, message: &str) {
        let start = node.range().start;
        let line = 1 + self.lines.partition_point(|&end| end < start);
        let mut told = self.told.borrow_mut();
        let Told { list, places } = &mut *told;
        let place = *places
            .entry((feature.to_owned(), message.to_owned()))
            .or_insert(list.len());
        match list.get_mut(place) {
            Some(missing) => missing.count += 1,
            None => list.push(Missing {
                feature: feature.to_owned(),
                message: message.to_owned(),
                element: node.attribute("id").unwrap_or("").to_owned(),
                line,
                count: 1,
            }),
        }
    }

    /// Adds what was said to the warnings of the bake.
    pub(super) fn finish(self, warnings: &Warnings) {
        for missing in self.told.into_inner().list {
            let Missing {
                message,
                line,
                count,
                ..
            } = missing;
            let more = match count {
                1 => String::new(),
                2 => " and 1 element more".to_owned(),
                _ => format!(" and {} elements more", count - 1),
            };
            warnings.push(
                WarningCode::Reduced,
                &missing.feature,
                &missing.element,
                format!("{message} (line {line}{more})"),
            );
        }
    }
}
