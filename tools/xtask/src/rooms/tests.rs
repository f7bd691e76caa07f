use std::collections::BTreeMap;

use super::exemptions::{Exemption, Finding, Rule};
use super::*;

/// A package `a-b` in the folder `a` with these files below `a/src`.
fn package(files: &[(&str, &str)]) -> Result<Crate> {
    let sources: BTreeMap<String, String> = files
        .iter()
        .map(|(file, text)| (format!("a/src/{file}"), (*text).to_owned()))
        .collect();
    Crate::new("a-b", "a", sources)
}

/// Arrows as `from:line to`, without the folder.
fn arrows(files: &[(&str, &str)]) -> Vec<String> {
    let arrows = package(files).unwrap().arrows;
    let arrows = arrows.lines.keys().map(|&edge| arrows.describe(edge));
    let mut arrows: Vec<String> = arrows
        .map(|text| text.replace("a/src/", "").replace(" imports", ""))
        .collect();
    arrows.sort();
    arrows
}

fn circles(files: &[(&str, &str)]) -> Vec<String> {
    let package = package(files).unwrap();
    let found = check::circles(&package.arrows).into_iter();
    found.map(|finding| finding.text).collect()
}

#[test]
fn nested_trees_reach_the_files_that_define() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod c;\n"),
        (
            "a.rs",
            "use crate::{\n    b::{self as bee, One},\n    c::{Two as Too, Three},\n};\n",
        ),
        ("b.rs", "pub struct One;"),
        ("c.rs", "pub struct Two;\npub struct Three;\n"),
    ];
    assert_eq!(arrows(&files), ["a.rs:2 b.rs", "a.rs:3 c.rs"]);
}

#[test]
fn paths_in_code_and_in_macros_count() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod c;\nmod d;\n"),
        (
            "a.rs",
            "use crate::c;\nfn f() {\n    crate::b::go(1);\n    println!(\"{}\", c::NAME);\n}\n\
             fn g() -> [crate::d::D; 2] { todo!() }\n",
        ),
        ("b.rs", "pub fn go(_: u32) {}"),
        ("c.rs", "pub const NAME: u32 = 1;"),
        ("d.rs", "pub struct D;"),
    ];
    assert_eq!(
        arrows(&files),
        ["a.rs:3 b.rs", "a.rs:4 c.rs", "a.rs:6 d.rs"]
    );
}

#[test]
fn comments_strings_fields_and_variables_do_not_count() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\npub use b::go;\n"),
        (
            "a.rs",
            "//! [`crate::b::go`]\n// use crate::b::go;\nuse crate::b;\n\
             fn f(b: &str) -> String { format!(\"crate::b::go {} {}\", b, other.b) }\n",
        ),
        ("b.rs", "pub fn go() {}"),
    ];
    assert_eq!(arrows(&files), [""; 0]);
}

#[test]
fn a_variable_hides_a_name_that_was_re_exported() {
    let user = "mod b;\npub(crate) use b::go;\n";
    let hidden = format!("{user}fn f(go: u32) -> u32 {{ go }}\n");
    let called = format!("{user}fn f() {{ go() }}\n");
    let b = ("a/b.rs", "pub fn go() {}");
    assert_eq!(
        arrows(&[("lib.rs", "mod a;"), ("a/mod.rs", &hidden), b]),
        [""; 0]
    );
    assert_eq!(
        arrows(&[("lib.rs", "mod a;"), ("a/mod.rs", &called), b]),
        ["a/mod.rs:3 a/b.rs"]
    );
}

#[test]
fn re_exports_and_globs_are_followed() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod c;\nmod d;\n"),
        ("a.rs", "use super::b::{Far, Near};\n"),
        (
            "b/mod.rs",
            "mod deep;\npub(crate) use crate::c::Far;\npub(crate) use deep::*;\n",
        ),
        ("b/deep.rs", "pub(crate) struct Near;"),
        ("c.rs", "pub(crate) use super::d::Long as Far;\n"),
        ("d.rs", "pub(crate) struct Long;"),
    ];
    assert_eq!(arrows(&files), ["a.rs:1 b/deep.rs", "a.rs:1 d.rs"]);
}

#[test]
fn self_and_super_are_followed_from_inline_modules() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\n"),
        (
            "a/mod.rs",
            "mod c;\nmod inner {\n    use super::super::b::One;\n    fn f() { self::g(); super::c::two() }\n    fn g() {}\n}\n",
        ),
        ("a/c.rs", "pub fn two() {}"),
        ("b.rs", "pub struct One;"),
    ];
    assert_eq!(arrows(&files), ["a/mod.rs:3 b.rs", "a/mod.rs:4 a/c.rs"]);
}

#[test]
fn tests_may_import_anything() {
    let files = [
        (
            "lib.rs",
            "mod a;\nmod b;\n#[cfg(test)]\nmod a_tests;\n#[cfg(all(test, unix))]\nmod testing;\n",
        ),
        (
            "a.rs",
            "#[cfg(test)]\nuse crate::b::One;\n#[cfg(test)]\nmod tests { use crate::b::One; }\n\
             impl X { #[cfg(test)] fn f() { crate::b::One; } }\n#[test] fn g() { crate::b::One; }\n",
        ),
        ("b.rs", "pub struct One;"),
        ("a_tests.rs", "use crate::a::X;"),
        ("testing/mod.rs", "use crate::b::One;"),
    ];
    assert_eq!(arrows(&files), [""; 0]);
}

#[test]
fn a_program_imports_its_library_by_name() {
    let files = [
        ("lib.rs", "pub mod a;\n"),
        ("a.rs", "pub fn run() {}"),
        ("main.rs", "fn main() { a_b::a::run(); other::a::run(); }\n"),
    ];
    assert_eq!(arrows(&files), ["main.rs:1 a.rs"]);
}

#[test]
fn what_a_macro_makes_is_looked_for_where_it_is_named() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\n"),
        ("a.rs", "use crate::b::MADE;\n"),
        ("b.rs", "table! { MADE = 1; }\n"),
    ];
    assert_eq!(arrows(&files), ["a.rs:1 b.rs"]);
}

#[test]
fn a_module_may_name_its_file() {
    let files = [
        ("lib.rs", "mod a;\n#[path = \"elsewhere.rs\"]\nmod b;\n"),
        ("a.rs", "use crate::b::One;\n"),
        ("elsewhere.rs", "pub struct One;"),
    ];
    assert_eq!(arrows(&files), ["a.rs:1 elsewhere.rs"]);
    let missing = package(&[("lib.rs", "\nmod gone;\n")]).err().unwrap();
    assert_eq!(missing.to_string(), "a/src/lib.rs:2: mod gone has no file");
}

#[test]
fn files_of_one_room_may_import_each_other() {
    let files = [
        ("lib.rs", "mod one;\nmod two;\nmod room;\n"),
        ("one.rs", "use crate::two::Two;\npub struct One;\n"),
        ("two.rs", "use crate::one::One;\npub struct Two;\n"),
        // The room's own file and its children are one room.
        (
            "room.rs",
            "mod child;\nuse child::Child;\npub struct Parent;\n",
        ),
        ("room/child.rs", "use super::Parent;\npub struct Child;\n"),
    ];
    assert_eq!(circles(&files), [""; 0]);
    assert_eq!(package(&files).unwrap().arrows.edges().len(), 4);
}

#[test]
fn rooms_that_import_each_other_are_a_problem_even_by_different_files() {
    let files = [
        ("lib.rs", "mod one;\nmod two;\n"),
        ("one/mod.rs", "mod x;\nmod y;\npub(crate) use y::Y;\n"),
        ("one/x.rs", "use crate::two::Two;\n"),
        ("one/y.rs", "pub(crate) struct Y;\n"),
        ("two/mod.rs", "mod z;\npub(crate) struct Two;\n"),
        ("two/z.rs", "\nuse crate::one::Y;\n"),
    ];
    assert_eq!(
        circles(&files),
        ["a/src: rooms import each other: a/src/one, a/src/two\n    \
          a/src/one/x.rs:1 imports a/src/two/mod.rs\n    \
          a/src/two/z.rs:2 imports a/src/one/y.rs"]
    );
}

#[test]
fn a_room_and_a_file_beside_it_are_a_circle_too() {
    let files = [
        (
            "lib.rs",
            "mod room;\nmod file;\npub fn front() { room::Child; }\n",
        ),
        ("room/mod.rs", "mod child;\npub(crate) use child::Child;\n"),
        (
            "room/child.rs",
            "use crate::file::File;\npub(crate) struct Child;\n",
        ),
        (
            "file.rs",
            "use crate::room::Child;\npub(crate) struct File;\n",
        ),
    ];
    let found = circles(&files);
    assert_eq!(found.len(), 1);
    assert!(found[0].starts_with("a/src: rooms import each other: a/src/room, a/src/file.rs\n"));
}

#[test]
fn a_room_within_a_room_points_one_way() {
    let files = |parent: &'static str| {
        [
            ("lib.rs", "mod outer;\n"),
            ("outer/mod.rs", parent),
            ("outer/base.rs", "pub struct Base;\n"),
            (
                "outer/inner/mod.rs",
                "use super::base::Base;\nuse super::Top;\npub struct Inner;\n",
            ),
        ]
    };
    let declared = "mod base;\nmod inner;\npub(crate) use inner::Inner;\npub struct Top;\n";
    let used = "mod base;\nmod inner;\nuse inner::Inner;\npub struct Top;\n";
    assert_eq!(circles(&files(declared)), [""; 0]);
    assert_eq!(
        circles(&files(used)),
        [
            "a/src/outer: rooms import each other: a/src/outer/inner, a/src/outer/mod.rs\n    \
          a/src/outer/inner/mod.rs:2 imports a/src/outer/mod.rs\n    \
          a/src/outer/mod.rs:3 imports a/src/outer/inner/mod.rs"
        ]
    );
}

#[test]
fn crowded_folders_are_found_and_data_is_not() {
    let files = |folder: &str, count: usize| -> Vec<String> {
        (0..count).map(|n| format!("{folder}/f{n}.rs")).collect()
    };
    let mut all = files("a/src", size::MAX_FILES);
    all.extend(files("a/data/rust", 40));
    all.push("a/src/below/more.rs".to_owned());
    all.push("a/src/notes.md".to_owned());
    assert!(size::findings(&all).is_empty());
    all.push("a/src/one_more.wgsl".to_owned());
    let found = size::findings(&all);
    assert_eq!(found.len(), 1);
    assert_eq!(
        found[0].text,
        "a/src: 13 source files in one folder, 12 at most"
    );
}

#[test]
fn exemptions_cover_their_room_and_are_needed() {
    let finding = || Finding {
        rule: Rule::Size,
        room: "a/src".to_owned(),
        text: "crowded".to_owned(),
    };
    let exemption = |rule, room| Exemption {
        rule,
        room,
        reason: "its issue is not done",
        issue: "#7",
    };
    let covering = exemption(Rule::Size, "a/src");
    assert_eq!(exemptions::apply(&[], vec![finding()]), ["crowded"]);
    assert_eq!(exemptions::apply(&[covering], vec![finding()]), [""; 0]);
    for other in [
        exemption(Rule::Circle, "a/src"),
        exemption(Rule::Size, "a/src/b"),
    ] {
        let problems = exemptions::apply(&[other], vec![finding()]);
        assert_eq!(problems.len(), 2, "{problems:?}");
        assert!(problems[0].ends_with("(#7: its issue is not done)"));
    }
}
