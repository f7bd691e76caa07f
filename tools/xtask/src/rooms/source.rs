//! One source file, read: what it defines, what it brings into scope, what its code names.

use std::collections::BTreeSet;

use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItem, Item, ItemUse, Meta, PatIdent, Path, UseTree, Visibility};

/// What a module holds, without what only tests see.
#[derive(Debug, Default)]
pub(super) struct Scope {
    /// Names of the items defined here, modules aside.
    pub(super) items: BTreeSet<String>,
    pub(super) uses: Vec<Use>,
    pub(super) mentions: Vec<Mention>,
    pub(super) children: Vec<Child>,
}

/// One name that a `use` brings into scope.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Use {
    /// Its name here; [`GLOB`] for all that the path holds, `_` for a trait without a name.
    pub(super) name: String,
    pub(super) path: Vec<String>,
    pub(super) line: usize,
    /// A re-export: others can see it.
    pub(super) is_public: bool,
}

/// A path in code.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Mention {
    pub(super) path: Vec<String>,
    pub(super) line: usize,
}

/// `mod name;` or `mod name { .. }`.
#[derive(Debug)]
pub(super) struct Child {
    pub(super) name: String,
    pub(super) line: usize,
    /// From `#[path = ".."]`.
    pub(super) path: Option<String>,
    /// `None`: it has a file of its own.
    pub(super) body: Option<Scope>,
}

/// Name of a [`Use`] that brings in everything.
pub(super) const GLOB: &str = "*";

/// Reads the text of a file.
pub(super) fn parse(text: &str) -> syn::Result<Scope> {
    Ok(scope(&syn::parse_file(text)?.items))
}

fn scope(items: &[Item]) -> Scope {
    let mut reader = Reader::default();
    for item in items.iter().filter(|item| !is_for_tests(attributes(item))) {
        if let Item::Mod(module) = item {
            reader.scope.children.push(Child {
                name: name(&module.ident),
                line: line(module.ident.span()),
                path: module.attrs.iter().find_map(path_attribute),
                body: module.content.as_ref().map(|(_, items)| scope(items)),
            });
        } else {
            reader.scope.items.extend(defined(item).map(name));
            reader.visit_item(item);
        }
    }
    let Reader { mut scope, locals } = reader;
    // A single name that is also a variable's is taken for the variable.
    scope
        .mentions
        .retain(|mention| mention.path.len() > 1 || !locals.contains(&mention.path[0]));
    scope
}

/// Walks the code of a module's items.
#[derive(Default)]
struct Reader {
    scope: Scope,
    /// Names of variables and parameters anywhere in the module.
    locals: BTreeSet<String>,
}

impl Visit<'_> for Reader {
    fn visit_item(&mut self, item: &Item) {
        if !is_for_tests(attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &ImplItem) {
        let is_for_tests = match item {
            ImplItem::Const(item) => is_for_tests(&item.attrs),
            ImplItem::Fn(item) => is_for_tests(&item.attrs),
            _ => false,
        };
        if !is_for_tests {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &ItemUse) {
        // `::name` is another crate for certain.
        if item.leading_colon.is_none() {
            let is_public = !matches!(item.vis, Visibility::Inherited);
            add_uses(&item.tree, &mut Vec::new(), is_public, &mut self.scope.uses);
        }
    }

    fn visit_path(&mut self, path: &Path) {
        if let (None, Some(first)) = (&path.leading_colon, path.segments.first()) {
            self.scope.mentions.push(Mention {
                path: path.segments.iter().map(|part| name(&part.ident)).collect(),
                line: line(first.ident.span()),
            });
        }
        visit::visit_path(self, path);
    }

    /// The inside of a macro call, which may be anything: what looks like a path counts as one.
    fn visit_token_stream(&mut self, tokens: &TokenStream) {
        add_paths(tokens, &mut self.scope.mentions);
    }

    fn visit_pat_ident(&mut self, pattern: &PatIdent) {
        self.locals.insert(name(&pattern.ident));
        visit::visit_pat_ident(self, pattern);
    }

    // Neither holds code.
    fn visit_attribute(&mut self, _: &Attribute) {}
    fn visit_visibility(&mut self, _: &Visibility) {}
}

fn add_uses(tree: &UseTree, path: &mut Vec<String>, is_public: bool, uses: &mut Vec<Use>) {
    let mut add = |known_as: String, last: Option<&Ident>, span: Span| {
        let mut path = path.clone();
        // `a::{self}` is `a`.
        path.extend(
            last.map(name)
                .filter(|last| last != "self" || path.is_empty()),
        );
        let name = match known_as.as_str() {
            "self" => path.last().cloned().unwrap_or(known_as),
            _ => known_as,
        };
        uses.push(Use {
            name,
            path,
            line: line(span),
            is_public,
        });
    };
    match tree {
        UseTree::Name(tree) => add(name(&tree.ident), Some(&tree.ident), tree.ident.span()),
        UseTree::Rename(tree) => add(name(&tree.rename), Some(&tree.ident), tree.ident.span()),
        UseTree::Glob(tree) => add(GLOB.to_owned(), None, tree.star_token.span),
        UseTree::Path(tree) => {
            path.push(name(&tree.ident));
            add_uses(&tree.tree, path, is_public, uses);
            path.pop();
        }
        UseTree::Group(group) => {
            for tree in &group.items {
                add_uses(tree, path, is_public, uses);
            }
        }
    }
}

/// Finds `a::b::c` in loose tokens. What follows a dot is a field or a method, what comes before a
/// single colon a field's name.
fn add_paths(tokens: &TokenStream, mentions: &mut Vec<Mention>) {
    let tokens: Vec<TokenTree> = tokens.clone().into_iter().collect();
    let is = |at: usize, mark: char| {
        let token = tokens.get(at);
        matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == mark)
    };
    let mut at = 0;
    while at < tokens.len() {
        match &tokens[at] {
            TokenTree::Group(group) => add_paths(&group.stream(), mentions),
            TokenTree::Ident(first) => {
                let before = at.checked_sub(1);
                let starts = before.is_none_or(|before| !is(before, '.') && !is(before, ':'));
                let mut path = vec![name(first)];
                while is(at + 1, ':') && is(at + 2, ':') {
                    let Some(TokenTree::Ident(next)) = tokens.get(at + 3) else {
                        break;
                    };
                    path.push(name(next));
                    at += 3;
                }
                let is_field = path.len() == 1 && is(at + 1, ':') && !is(at + 2, ':');
                if starts && !is_field {
                    let line = line(first.span());
                    mentions.push(Mention { path, line });
                }
            }
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
        at += 1;
    }
}

fn name(ident: &Ident) -> String {
    let text = ident.to_string();
    text.strip_prefix("r#").map_or(text.clone(), str::to_owned)
}

fn line(span: Span) -> usize {
    span.start().line
}

/// The name that an item defines.
fn defined(item: &Item) -> Option<&Ident> {
    match item {
        Item::Const(item) => Some(&item.ident),
        Item::Enum(item) => Some(&item.ident),
        Item::Fn(item) => Some(&item.sig.ident),
        Item::Macro(item) => item.ident.as_ref(),
        Item::Static(item) => Some(&item.ident),
        Item::Struct(item) => Some(&item.ident),
        Item::Trait(item) => Some(&item.ident),
        Item::Type(item) => Some(&item.ident),
        Item::Union(item) => Some(&item.ident),
        _ => None,
    }
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// `#[test]`, `#[cfg(test)]` or `#[cfg(all(test, ..))]`.
fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let path = attribute.path();
        let Meta::List(list) = &attribute.meta else {
            return path.is_ident("test");
        };
        let wants_test = match list
            .tokens
            .clone()
            .into_iter()
            .collect::<Vec<_>>()
            .as_slice()
        {
            [TokenTree::Ident(only)] => only == "test",
            [TokenTree::Ident(all), TokenTree::Group(group)] if all == "all" => {
                let mut parts = group.stream().into_iter();
                parts.any(|part| matches!(part, TokenTree::Ident(part) if part == "test"))
            }
            _ => false,
        };
        path.is_ident("cfg") && wants_test
    })
}

fn path_attribute(attribute: &Attribute) -> Option<String> {
    let Meta::NameValue(pair) = &attribute.meta else {
        return None;
    };
    let syn::Expr::Lit(value) = &pair.value else {
        return None;
    };
    match &value.lit {
        syn::Lit::Str(text) if pair.path.is_ident("path") => Some(text.value()),
        _ => None,
    }
}
