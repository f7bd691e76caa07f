//! A line of text that is being filled with words.

use std::rc::Rc;

use super::look::Look;

#[derive(Debug)]
pub(super) struct Run {
    pub(super) look: Rc<Look>,
    pub(super) text: String,
    pub(super) width: f64,
}

/// A line that is being filled.
#[derive(Debug, Default)]
pub(super) struct Open {
    pub(super) runs: Vec<Run>,
    pub(super) width: f64,
    /// The look of a space that the next word would follow.
    space: Option<Rc<Look>>,
    /// Width of a space that is at the end and kept.
    pub(super) hang: f64,
    /// Whether it is a line even without words.
    pub(super) is_forced: bool,
}

impl Open {
    pub(super) fn space(&mut self, look: &Rc<Look>) {
        if !self.runs.is_empty() && self.space.is_none() {
            self.space = Some(Rc::clone(look));
        }
    }

    /// Whether a word of this width begins a line.
    pub(super) fn breaks(&self, word: f64, space: f64, width: f64) -> bool {
        // Widths of a browser that are written into a file leave nothing over.
        self.space.is_some() && self.width + space + word > width * (1.0 + 1e-3) + 0.1
    }

    pub(super) fn word(&mut self, look: &Rc<Look>, text: &str, width: f64, space: f64) {
        let is_same = |run: &Run, look: &Rc<Look>| Rc::ptr_eq(&run.look, look);
        let mut add = |look: &Rc<Look>, text: &str, width: f64| {
            self.width += width;
            match self.runs.last_mut().filter(|run| is_same(run, look)) {
                Some(run) => {
                    run.text.push_str(text);
                    run.width += width;
                }
                None => self.runs.push(Run {
                    look: Rc::clone(look),
                    text: text.to_owned(),
                    width,
                }),
            }
        };
        if let Some(look) = self.space.take() {
            add(&look, " ", space);
        }
        add(look, text, width);
    }
}
