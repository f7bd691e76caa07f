//! WGSL and its Rust twin: each names the other's files, and both have the same functions.
//!
//! A file of `cpu/` names in its head the modules that it is the twin of, as `` `vtex/edge_*.wgsl` ``,
//! or says that it has no twin. A function of a module is `vtex_`, then a part of the module's name,
//! then the name that its twin has: `vtex_rows_place` of `samples_rows.wgsl` is `place`. One that is
//! named for a part of the module alone has a twin of the same name, or `new`.
//! What deviates stands in [`table`].

mod table;

#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use table::{ONLY_RUST, ONLY_WGSL, OTHERWISE};

/// Where the twin's files are.
const TWIN: &str = "shaders/src/cpu/";
/// Where the modules of the evaluator are.
const MODULES: [&str; 2] = ["shaders/wgsl/vtex/", "shaders/wgsl/core/"];
/// The prefix of both.
const WGSL: &str = "shaders/wgsl/";

/// A file with its text.
pub(super) type Text = (String, String);

/// Names that deviate.
struct Table<'a> {
    /// File of the twin, its function, the function of WGSL.
    otherwise: &'a [(&'a str, &'a str, &'a str)],
    /// File of the twin, its functions, why WGSL has none.
    only_rust: &'a [(&'a str, &'a [&'a str], &'a str)],
    /// Function of WGSL, why the twin has none.
    only_wgsl: &'a [(&'a str, &'a str)],
}

/// What is wrong with the pairs among `files`.
pub(super) fn check(files: &[Text]) -> Vec<String> {
    let table = Table {
        otherwise: OTHERWISE,
        only_rust: ONLY_RUST,
        only_wgsl: ONLY_WGSL,
    };
    check_with(files, &table)
}

/// A module of WGSL.
struct Module<'a> {
    /// As `vtex/cell.wgsl`.
    name: &'a str,
    functions: Vec<&'a str>,
    /// Files of `cpu/` that it names.
    named: Vec<&'a str>,
}

/// A file of `cpu/`.
struct Twin<'a> {
    /// As `cell.rs`.
    name: &'a str,
    functions: BTreeSet<&'a str>,
    /// The modules that it names; `*` at the end of a name stands for any.
    named: Vec<&'a str>,
    has_none: bool,
}

impl Twin<'_> {
    fn names(&self, module: &str) -> bool {
        let mut named = self.named.iter();
        named.any(|pattern| matches(pattern, module))
    }
}

fn matches(pattern: &str, module: &str) -> bool {
    match pattern.split_once('*') {
        Some((start, end)) => module.starts_with(start) && module.ends_with(end),
        None => pattern == module,
    }
}

fn check_with(files: &[Text], table: &Table<'_>) -> Vec<String> {
    let modules: Vec<Module<'_>> = files.iter().filter_map(module).collect();
    let twins: Vec<Twin<'_>> = files.iter().filter_map(twin).collect();
    let mut problems = check_names(&modules, &twins);
    problems.extend(check_functions(&modules, &twins, table));
    problems.extend(check_table(&modules, &twins, table));
    problems
}

fn module((path, text): &Text) -> Option<Module<'_>> {
    if !MODULES.iter().any(|folder| path.starts_with(folder)) {
        return None;
    }
    let comments = text.lines().filter_map(|line| line.split_once("// "));
    let named = comments.filter_map(|(_, comment)| comment.split_once("Twin: cpu/"));
    Some(Module {
        name: path.strip_prefix(WGSL)?,
        functions: text
            .lines()
            .filter_map(|line| name_behind(line, "fn "))
            .collect(),
        named: named
            .filter_map(|(_, rest)| rest.split_once(".rs"))
            .map(|(stem, _)| stem)
            .collect(),
    })
}

fn twin((path, text): &Text) -> Option<Twin<'_>> {
    let name = path.strip_prefix(TWIN).filter(|name| *name != "mod.rs")?;
    let head = || text.lines().take_while(|line| line.starts_with("//!"));
    let quoted = head().flat_map(|line| line.split('`').skip(1).step_by(2));
    let code = text.lines().take_while(|line| *line != "#[cfg(test)]");
    Some(Twin {
        name,
        functions: code.filter_map(rust_function).collect(),
        named: quoted.filter(|word| word.ends_with(".wgsl")).collect(),
        has_none: head().any(|line| line.to_lowercase().contains("no twin")),
    })
}

/// The name that a line declares behind `keyword`.
fn name_behind<'a>(line: &'a str, keyword: &str) -> Option<&'a str> {
    let rest = line.strip_prefix(keyword)?;
    rest.split(|c: char| !c.is_alphanumeric() && c != '_')
        .next()
}

fn rust_function(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let line = match line.strip_prefix("pub") {
        Some(rest) => rest.split_once(' ')?.1,
        None => line,
    };
    name_behind(line.strip_prefix("const ").unwrap_or(line), "fn ")
}

/// The name that the twin of `function` has, and whether `new` will do.
fn twin_name<'a>(module: &str, function: &'a str) -> (&'a str, bool) {
    let stem = module.rsplit(['/', '.']).nth(1).unwrap_or(module);
    let name = function.strip_prefix("vtex_").unwrap_or(function);
    let of_module = |part: &str| stem.split('_').any(|of_stem| of_stem == part);
    match name.split_once('_') {
        Some((part, rest)) if of_module(part) => (rest, false),
        _ => (name, of_module(name)),
    }
}

/// Both sides name files that exist, and no module with functions is without a twin.
fn check_names(modules: &[Module<'_>], twins: &[Twin<'_>]) -> Vec<String> {
    let mut problems = Vec::new();
    for twin in twins {
        if twin.named.is_empty() != twin.has_none {
            problems.push(format!(
                "{TWIN}{}: names the modules that it is the twin of, or says \"no twin\"",
                twin.name
            ));
        }
        for pattern in &twin.named {
            if !modules.iter().any(|module| matches(pattern, module.name)) {
                problems.push(format!("{TWIN}{}: no module {pattern}", twin.name));
            }
        }
    }
    for module in modules {
        let named_by = |twin: &&Twin<'_>| twin.names(module.name);
        if !module.functions.is_empty() && !twins.iter().any(|twin| named_by(&twin)) {
            problems.push(format!("{WGSL}{}: no file of {TWIN} names it", module.name));
        }
        for stem in &module.named {
            let file = format!("{stem}.rs");
            let mut named = twins.iter().filter(named_by);
            if !named.any(|twin| twin.name == file) {
                problems.push(format!(
                    "{WGSL}{}: cpu/{file} does not name it",
                    module.name
                ));
            }
        }
    }
    problems
}

/// Whether a function of a module has a twin by the rule, in one of the files that name the module.
fn has_twin(module: &Module<'_>, function: &str, twins: &[Twin<'_>]) -> bool {
    let (name, may_be_new) = twin_name(module.name, function);
    twins
        .iter()
        .filter(|twin| twin.names(module.name))
        .any(|twin| twin.functions.contains(name) || may_be_new && twin.functions.contains("new"))
}

/// Whether a function of a twin has one in WGSL by the rule.
fn has_wgsl(twin: &Twin<'_>, function: &str, modules: &[Module<'_>]) -> bool {
    // A constructor: WGSL has them for every struct.
    function == "new"
        || modules
            .iter()
            .filter(|module| twin.names(module.name))
            .any(|module| {
                let mut functions = module.functions.iter();
                functions.any(|wgsl| twin_name(module.name, wgsl).0 == function)
            })
}

fn check_functions(modules: &[Module<'_>], twins: &[Twin<'_>], table: &Table<'_>) -> Vec<String> {
    let mut problems = Vec::new();
    for module in modules {
        for &function in &module.functions {
            let declared = table.otherwise.iter().any(|(_, _, wgsl)| *wgsl == function)
                || table.only_wgsl.iter().any(|(wgsl, _)| *wgsl == function);
            if !declared && !has_twin(module, function, twins) {
                let (name, _) = twin_name(module.name, function);
                problems.push(format!(
                    "{WGSL}{}: {function} has no twin `{name}`",
                    module.name
                ));
            }
        }
    }
    for twin in twins.iter().filter(|twin| !twin.has_none) {
        for &function in &twin.functions {
            let otherwise =
                |(file, rust, _): &(&str, &str, &str)| *file == twin.name && *rust == function;
            let only_rust = |(file, rust, _): &(&str, &[&str], &str)| {
                *file == twin.name && rust.contains(&function)
            };
            let declared =
                table.otherwise.iter().any(otherwise) || table.only_rust.iter().any(only_rust);
            if !declared && !has_wgsl(twin, function, modules) {
                problems.push(format!(
                    "{TWIN}{}: `{function}` is the twin of no function",
                    twin.name
                ));
            }
        }
    }
    problems
}

/// An entry of the table that names what is not there, or what keeps the rule, is out of date.
fn check_table(modules: &[Module<'_>], twins: &[Twin<'_>], table: &Table<'_>) -> Vec<String> {
    let twin_with = |file: &str, function: &str| {
        let mut twins = twins.iter();
        twins.find(|twin| twin.name == file && twin.functions.contains(function))
    };
    let module_with = |function: &str| {
        let mut modules = modules.iter();
        modules.find(|module| module.functions.contains(&function))
    };
    let otherwise = table.otherwise.iter().filter(|(file, rust, wgsl)| {
        match (twin_with(file, rust), module_with(wgsl)) {
            (Some(twin), Some(module)) => {
                twin_name(module.name, wgsl).0 == *rust && twin.names(module.name)
            }
            _ => true,
        }
    });
    let rust = table.only_rust.iter();
    let rust = rust.flat_map(|(file, functions, _)| functions.iter().map(move |one| (*file, *one)));
    let rust = rust.filter(|(file, function)| {
        twin_with(file, function).is_none_or(|twin| has_wgsl(twin, function, modules))
    });
    let wgsl = table.only_wgsl.iter().map(|(function, _)| *function);
    let wgsl = wgsl.filter(|function| {
        module_with(function).is_none_or(|module| has_twin(module, function, twins))
    });
    let needless = otherwise
        .map(|(file, rust, wgsl)| format!("{file} {rust} = {wgsl}"))
        .chain(rust.map(|(file, function)| format!("{file} {function}")))
        .chain(wgsl.map(str::to_owned));
    needless
        .map(|entry| format!("tools/xtask/src/tidy/twins/table.rs: {entry}: out of date"))
        .collect()
}
