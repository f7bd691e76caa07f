//! What the stage reads and does not draw, for the warnings of the bake.

use std::cell::RefCell;
use std::collections::BTreeMap;

use usvg::roxmltree::{Document, Node};
use vtex_format::WarningCode;

use super::elements::is_svg;
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

    /// Says which animations and scripts are left out.
    pub(super) fn what_moves(&self, document: &Document<'_>) {
        for node in document.descendants().filter(|node| is_svg(*node)) {
            match node.tag_name().name() {
                name @ ("animate" | "animateColor" | "animateMotion" | "animateTransform"
                | "set") => {
                    let message = format!("<{name}> is left out: the picture at rest is drawn");
                    self.missing(node, "animation", &message);
                }
                "script" => self.missing(node, "script", "scripts do not run"),
                _ => {}
            }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_moves_is_said_of_untouched_documents_too() {
        let text = "<svg xmlns='http://www.w3.org/2000/svg'><path id='p'><animate/></path>\n<g><set \
                    id='s'/><animate/></g><script>1</script></svg>";
        let document = Document::parse(text).unwrap();
        let warnings = Warnings::default();
        let found = crate::style::tests::resolve(&document, &warnings).unwrap();
        assert_eq!(found, None);
        let list = warnings.into_list();
        let said: Vec<_> = list.iter().map(|w| (&*w.feature, &*w.message)).collect();
        assert_eq!(
            said,
            [
                (
                    "animation",
                    "<animate> is left out: the picture at rest is drawn (line 1 and 1 element more)"
                ),
                (
                    "animation",
                    "<set> is left out: the picture at rest is drawn (line 2)"
                ),
                ("script", "scripts do not run (line 2)"),
            ]
        );
    }
}
