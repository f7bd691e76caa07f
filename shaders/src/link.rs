//! The linker: puts WGSL modules together into one text.
//!
//! A module names what it needs in its first lines, `//!use vtex/coverage`. Imports are emitted
//! depth first in the order in which they are named, each module once, so the same root and
//! context always give the same text. A name may be a *slot* that the context fills with one of
//! several modules ([`LinkContext::fill`]): that is how code of an absent feature stays out.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use crate::sources::SOURCES;

/// Starts an import line.
const USE: &str = "//!use ";

/// Why modules could not be put together.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LinkError {
    /// No module and no filled slot has this name.
    #[error("no WGSL module `{name}`, wanted by `{importer}`")]
    Unknown {
        /// The missing name.
        name: String,
        /// The module that imports it.
        importer: String,
    },
    /// A module imports itself, directly or through others.
    #[error("WGSL modules import each other in a cycle: {}", .0.join(" -> "))]
    Cycle(Vec<String>),
}

/// What the linker knows besides the files of `wgsl/`: filled slots and generated modules.
#[derive(Clone, Debug, Default)]
pub struct LinkContext {
    slots: BTreeMap<String, String>,
    texts: BTreeMap<String, String>,
}

impl LinkContext {
    /// Lets imports of `slot` mean `module`.
    #[must_use]
    pub fn fill(mut self, slot: &str, module: &str) -> Self {
        self.slots.insert(slot.to_owned(), module.to_owned());
        self
    }

    /// Adds a generated module; it goes before a file of the same name.
    #[must_use]
    pub fn define(mut self, module: &str, text: String) -> Self {
        self.texts.insert(module.to_owned(), text);
        self
    }

    fn resolve<'a>(&'a self, name: &'a str, importer: &str) -> Result<Module<'a>, LinkError> {
        let name = self.slots.get(name).map_or(name, String::as_str);
        let generated = self.texts.get(name).map(String::as_str);
        let stored = || SOURCES.iter().find(|(stored, _)| *stored == name);
        match generated.or_else(|| stored().map(|(_, text)| *text)) {
            Some(text) => Ok(Module { name, text }),
            None => Err(LinkError::Unknown {
                name: name.to_owned(),
                importer: importer.to_owned(),
            }),
        }
    }
}

#[derive(Clone, Copy)]
struct Module<'a> {
    name: &'a str,
    text: &'a str,
}

/// Links `root` (a module name or slot) with all it imports, imports first.
///
/// # Errors
/// [`LinkError`] for a name that is nowhere defined and for modules that import each other.
pub fn link(root: &str, context: &LinkContext) -> Result<String, LinkError> {
    let mut linker = Linker {
        context,
        done: BTreeSet::new(),
        open: Vec::new(),
        out: String::new(),
    };
    linker.emit(context.resolve(root, "the caller")?)?;
    Ok(linker.out)
}

struct Linker<'a> {
    context: &'a LinkContext,
    done: BTreeSet<&'a str>,
    open: Vec<&'a str>,
    out: String,
}

impl<'a> Linker<'a> {
    fn emit(&mut self, module: Module<'a>) -> Result<(), LinkError> {
        if self.done.contains(module.name) {
            return Ok(());
        }
        // `open` is the path from the root to here: a name that is on it imports itself.
        if let Some(start) = self.open.iter().position(|name| *name == module.name) {
            let cycle = self.open[start..].iter().chain([&module.name]);
            return Err(LinkError::Cycle(cycle.map(|&name| name.into()).collect()));
        }
        self.open.push(module.name);
        let mut body = module.text;
        while let Some((line, rest)) = import_line(body) {
            self.emit(self.context.resolve(line, module.name)?)?;
            body = rest;
        }
        self.open.pop();
        self.done.insert(module.name);
        self.write(module.name, body);
        Ok(())
    }

    fn write(&mut self, name: &str, body: &str) {
        let gap = if self.out.is_empty() { "" } else { "\n" };
        // A checkout with CR LF must link the same text: loaders compare its hash with that of the
        // text in a file.
        let body: Cow<'_, str> = match body.contains('\r') {
            true => body.replace('\r', "").into(),
            false => body.into(),
        };
        // Writing to a string cannot fail.
        let _ = write!(self.out, "{gap}// {name}\n{body}");
    }
}

/// The name imported by the first line and what follows the line.
fn import_line(text: &str) -> Option<(&str, &str)> {
    let (line, rest) = text.strip_prefix(USE)?.split_once('\n')?;
    Some((line.trim(), rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn modules(texts: &[(&str, &str)]) -> LinkContext {
        texts.iter().fold(LinkContext::default(), |c, (n, t)| {
            c.define(n, (*t).to_owned())
        })
    }

    #[test]
    fn imports_come_first_and_once() {
        let context = modules(&[
            ("a", "//!use b\n//!use c\nA\n"),
            ("b", "//!use c\nB\n"),
            ("c", "C\n"),
        ]);
        let text = link("a", &context).unwrap();
        assert_eq!(text, "// c\nC\n\n// b\nB\n\n// a\nA\n");
        assert_eq!(text, link("a", &context).unwrap());
    }

    #[test]
    fn a_slot_is_the_module_that_fills_it() {
        let context = modules(&[("a", "//!use s\nA\n"), ("one", "1\n"), ("two", "2\n")]);
        let text = link("a", &context.clone().fill("s", "two")).unwrap();
        assert_eq!(text, "// two\n2\n\n// a\nA\n");
        let unknown = LinkError::Unknown {
            name: "s".into(),
            importer: "a".into(),
        };
        assert_eq!(link("a", &context), Err(unknown));
    }

    #[test]
    fn cycles_are_refused() {
        let context = modules(&[
            ("a", "//!use b\n"),
            ("b", "//!use c\n"),
            ("c", "//!use b\n"),
        ]);
        let cycle = ["b", "c", "b"].map(String::from).to_vec();
        assert_eq!(link("a", &context), Err(LinkError::Cycle(cycle)));
    }
}
