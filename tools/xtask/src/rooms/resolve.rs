//! From a path in code to the file that holds the definition.

use super::source::GLOB;
use super::tree::{Module, Tree};

/// What a path leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    /// An item, defined in this file of the tree.
    File(usize),
    /// A module.
    Module(usize),
    /// Another crate, a variable, a primitive type.
    Outside,
}

/// Re-exports followed before a path is given up; a chain that long is a circle of its own.
const MAX_STEPS: usize = 32;

/// Follows `path` as code in module `from` writes it.
pub(super) fn resolve(tree: &Tree, from: usize, path: &[String]) -> Target {
    Resolver { tree, steps: 0 }.from(from, path)
}

struct Resolver<'a> {
    tree: &'a Tree,
    steps: usize,
}

impl Resolver<'_> {
    /// A path as it is written in a module: its first part may be anything in scope.
    fn from(&mut self, module: usize, path: &[String]) -> Target {
        let Some((first, rest)) = path.split_first() else {
            return Target::Module(module);
        };
        let tree = self.tree;
        match first.as_str() {
            "crate" | "$crate" => self.below(tree.modules[module].root, rest),
            "self" | "super" => self.below(module, path),
            _ => match self.in_scope(module, path) {
                Target::Outside => match &tree.library {
                    Some((name, root)) if name == first && *root != tree.modules[module].root => {
                        self.below(*root, rest)
                    }
                    _ => Target::Outside,
                },
                found => found,
            },
        }
    }

    /// A path that starts in `module` for certain.
    fn below(&mut self, module: usize, path: &[String]) -> Target {
        let Some((first, rest)) = path.split_first() else {
            return Target::Module(module);
        };
        let tree = self.tree;
        match first.as_str() {
            "self" => self.below(module, rest),
            "super" => match tree.modules[module].parent {
                Some(parent) => self.below(parent, rest),
                None => Target::Outside,
            },
            _ => match self.in_scope(module, path) {
                // A macro made it.
                Target::Outside => Target::File(tree.modules[module].file),
                found => found,
            },
        }
    }

    /// Looks up the first part of `path` among what is named in `module`, then the rest in there.
    fn in_scope(&mut self, module: usize, path: &[String]) -> Target {
        self.steps += 1;
        if self.steps > MAX_STEPS {
            return Target::Outside;
        }
        let (first, rest) = (&path[0], &path[1..]);
        let Module {
            children,
            scope,
            file,
            ..
        } = &self.tree.modules[module];
        let child = children.get(first).copied();
        // A function may have a module's name, but only the module has something behind `::`.
        if let (Some(child), false) = (child, rest.is_empty()) {
            return self.below(child, rest);
        }
        if scope.items.contains(first) {
            return Target::File(*file);
        }
        for one in scope.uses.iter().filter(|one| one.name == *first) {
            let found = self.from(module, &[&one.path[..], rest].concat());
            if found != Target::Outside {
                return found;
            }
        }
        if let Some(child) = child {
            return Target::Module(child);
        }
        for one in scope.uses.iter().filter(|one| one.name == GLOB) {
            // An enum's variants are not looked into: its glob is an arrow already.
            if let Target::Module(named) = self.from(module, &one.path)
                && named != module
            {
                let found = self.in_scope(named, path);
                if found != Target::Outside {
                    return found;
                }
            }
        }
        Target::Outside
    }
}
