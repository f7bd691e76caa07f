//! Widths of words, measured by usvg with the fonts that will draw them.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

use usvg::FontSelectionFn;
use usvg::fontdb::Database;

use super::look::Look;
use crate::style::output::{attribute, escape};

/// What measures words of labels in HTML.
pub(crate) struct Faces<'a> {
    pub(crate) database: &'a Arc<Database>,
    pub(crate) select: fn() -> FontSelectionFn<'static>,
}

/// Size at which is measured. Widths grow with the size.
const SIZE_PX: f64 = 100.0;

/// A face as it is asked for: families, weight, and whether it slants.
type Face = (Rc<str>, Rc<str>, bool);

/// Advance, ascent and descent of a text, in shares of the font's size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) width: f64,
    pub(super) ascent: f64,
    pub(super) descent: f64,
}

/// What is taken until a text is measured, and where no font is: those of a common serif face.
const TYPICAL: Extent = Extent {
    width: 0.5,
    ascent: 0.9,
    descent: 0.22,
};

/// Measures in two rounds: texts that are asked for in the first are known in the second.
pub(super) struct Fonts {
    database: Arc<Database>,
    select: fn() -> FontSelectionFn<'static>,
    known: BTreeMap<(Face, Rc<str>), Extent>,
    wanted: RefCell<BTreeMap<(Face, Rc<str>), ()>>,
}

impl Fonts {
    pub(super) fn new(fonts: &Faces<'_>) -> Self {
        Self {
            database: Arc::clone(fonts.database),
            select: fonts.select,
            known: BTreeMap::new(),
            wanted: RefCell::default(),
        }
    }

    /// The extent of `text` in px.
    pub(super) fn extent(&self, look: &Look, text: &str) -> Extent {
        let face = (
            Rc::clone(&look.families),
            Rc::clone(&look.weight),
            look.is_italic,
        );
        let key = (face, Rc::from(text));
        let size = look.font_size_px;
        let shares = self.known.get(&key).copied().unwrap_or_else(|| {
            self.wanted.borrow_mut().insert(key, ());
            let letters = u16::try_from(text.chars().count()).unwrap_or(u16::MAX);
            Extent {
                width: TYPICAL.width * f64::from(letters),
                ..TYPICAL
            }
        });
        Extent {
            width: shares.width * size,
            ascent: shares.ascent * size,
            descent: shares.descent * size,
        }
    }

    /// Measures all that was asked for.
    pub(super) fn measure(&mut self) {
        let wanted = self.wanted.take();
        let mut svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\">".to_owned();
        for (index, ((families, weight, is_italic), text)) in wanted.keys().enumerate() {
            svg += &format!("<text id=\"t{index}\" xml:space=\"preserve\" font-size=\"{SIZE_PX}\"");
            attribute("font-family", families, &mut svg);
            attribute("font-weight", weight, &mut svg);
            let style = if *is_italic { "italic" } else { "normal" };
            attribute("font-style", style, &mut svg);
            svg.push('>');
            escape(text, &mut svg);
            svg += "</text>";
        }
        svg += "</svg>";
        let mut options = usvg::Options {
            fontdb: Arc::clone(&self.database),
            ..usvg::Options::default()
        };
        options.font_resolver.select_font = (self.select)();
        let Ok(tree) = usvg::Tree::from_str(&svg, &options) else {
            return;
        };
        for (index, key) in wanted.into_keys().enumerate() {
            if let Some(usvg::Node::Text(text)) = tree.node_by_id(&format!("t{index}")) {
                let bounds = text.bounding_box();
                let extent = Extent {
                    width: f64::from(bounds.width()) / SIZE_PX,
                    ascent: -f64::from(bounds.top()) / SIZE_PX,
                    descent: f64::from(bounds.bottom()) / SIZE_PX,
                };
                self.known.insert(key, extent);
            }
        }
    }
}
