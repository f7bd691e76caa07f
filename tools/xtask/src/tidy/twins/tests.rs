//! What the check finds in small pairs.

use super::*;

const NONE: Table<'_> = Table {
    otherwise: &[],
    only_rust: &[],
    only_wgsl: &[],
};

const MODULE: &str = "// Twin: cpu/edge.rs.\nfn vtex_edge_wind(a: u32) -> u32 {\n}\n";
const TWIN_FILE: &str = "//! Twin of `vtex/edge_*.wgsl`.\n\npub(super) const fn wind() {}\n\
    #[cfg(test)]\nmod tests {\n    fn alone() {}\n}\n";

fn problems(files: &[(&str, &str)], table: &Table<'_>) -> Vec<String> {
    let own = |(path, text): &(&str, &str)| ((*path).to_owned(), (*text).to_owned());
    let files: Vec<Text> = files.iter().map(own).collect();
    check_with(&files, table)
}

/// The pair with other texts.
fn pair(module: &str, twin: &str, table: &Table<'_>) -> Vec<String> {
    let files = [
        ("shaders/wgsl/vtex/edge_any.wgsl", module),
        ("shaders/src/cpu/edge.rs", twin),
        ("shaders/src/cpu/mod.rs", "//! The twin.\nfn other() {}\n"),
    ];
    problems(&files, table)
}

#[track_caller]
fn expect(found: &[String], parts: &[&str]) {
    assert_eq!(found.len(), parts.len(), "{found:#?}");
    for (problem, part) in found.iter().zip(parts) {
        assert!(problem.contains(part), "{problem}, not {part}");
    }
}

#[test]
fn a_pair_that_agrees_is_sound() {
    expect(&pair(MODULE, TWIN_FILE, &NONE), &[]);
}

#[test]
fn files_that_do_not_exist_are_found() {
    let renamed = TWIN_FILE.replace("edge_*", "border_*");
    let expected = [
        "no module vtex/border_*.wgsl",
        "no file of",
        "does not name it",
    ];
    let found = pair(MODULE, &renamed, &NONE);
    for part in expected {
        assert!(
            found.iter().any(|problem| problem.contains(part)),
            "{part}: {found:#?}"
        );
    }
    let elsewhere = MODULE.replace("cpu/edge", "cpu/border");
    expect(
        &pair(&elsewhere, TWIN_FILE, &NONE),
        &["cpu/border.rs does not name it"],
    );
}

#[test]
fn a_twin_says_of_what() {
    let silent = "//! Edges.\n";
    let found = problems(&[("shaders/src/cpu/edge.rs", silent)], &NONE);
    expect(&found, &["or says \"no twin\""]);
    let alone = "//! Edges: no twin.\nfn any() {}\n";
    expect(&problems(&[("shaders/src/cpu/edge.rs", alone)], &NONE), &[]);
}

#[test]
fn functions_of_one_side_are_found() {
    let more = format!("{MODULE}fn vtex_edge_covered() {{\n}}\n");
    expect(
        &pair(&more, TWIN_FILE, &NONE),
        &["vtex_edge_covered has no twin `covered`"],
    );
    let renamed = TWIN_FILE.replace("fn wind", "fn add");
    let found = pair(MODULE, &renamed, &NONE);
    expect(
        &found,
        &["has no twin `wind`", "`add` is the twin of no function"],
    );
}

#[test]
fn a_function_named_for_its_module_may_be_a_constructor() {
    let module = "fn vtex_edge() {\n}\n";
    for name in ["edge", "new"] {
        let twin =
            format!("//! Twin of `vtex/edge_any.wgsl`.\nimpl A {{\n    fn {name}() {{}}\n}}\n");
        expect(&pair(module, &twin, &NONE), &[]);
    }
}

#[test]
fn deviations_are_declared_and_end() {
    let renamed = TWIN_FILE.replace("fn wind", "fn add");
    let otherwise = Table {
        otherwise: &[("edge.rs", "add", "vtex_edge_wind")],
        ..NONE
    };
    expect(&pair(MODULE, &renamed, &otherwise), &[]);
    expect(
        &pair(MODULE, TWIN_FILE, &otherwise),
        &["edge.rs add = vtex_edge_wind: out of date"],
    );
    let alone = Table {
        only_rust: &[("edge.rs", &["add"], "")],
        only_wgsl: &[("vtex_edge_wind", "")],
        ..NONE
    };
    expect(&pair(MODULE, &renamed, &alone), &[]);
    let found = pair(MODULE, TWIN_FILE, &alone);
    expect(
        &found,
        &["edge.rs add: out of date", "vtex_edge_wind: out of date"],
    );
}
