//! The issue codes of the specification are those of the code.

use std::collections::BTreeSet;

/// Where the code has them, as `NAME = 1001 Fault "summary";`.
pub(crate) const ISSUES: &str = "format/src/container/issue.rs";
/// Where the specification has them, as `| V1001 | fault | summary |`.
pub(crate) const DOCUMENT: &str = "docs/format.md";

/// Codes that stand in one of the texts only.
pub(crate) fn check(issues: &str, document: &str) -> Vec<String> {
    let code = codes(issues, |line| {
        line.split_once(" = ")?
            .1
            .split_once(' ')
            .map(|(code, _)| code)
    });
    let specified = codes(document, |line| {
        line.strip_prefix("| V")?.split_once(' ').map(|p| p.0)
    });
    let mut problems = Vec::new();
    if code.is_empty() {
        problems.push(format!("{ISSUES}: no issue codes were found"));
    }
    for missing in code.difference(&specified) {
        problems.push(format!("{DOCUMENT}: lacks V{missing} of {ISSUES}"));
    }
    for stray in specified.difference(&code) {
        problems.push(format!("{DOCUMENT}: V{stray} is not in {ISSUES}"));
    }
    problems
}

/// The four-digit codes that `find` sees in the lines of a text.
fn codes(text: &str, find: impl Fn(&str) -> Option<&str>) -> BTreeSet<&str> {
    let is_code = |code: &&str| code.len() == 4 && code.bytes().all(|byte| byte.is_ascii_digit());
    text.lines()
        .map(str::trim)
        .filter_map(find)
        .filter(is_code)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_lists_must_be_the_same() {
        let issues = "    MAGIC = 1002 Malformed \"x\";\n    MAJOR = 1003 Unsupported \"y\";\n";
        let rows = |codes: [u32; 2]| codes.map(|code| format!("| V{code} | malformed | x |\n"));
        assert_eq!(
            check(issues, &rows([1002, 1003]).concat()),
            Vec::<String>::new()
        );
        assert_eq!(
            check(issues, &rows([1002, 1004]).concat()),
            [
                "docs/format.md: lacks V1003 of format/src/container/issue.rs",
                "docs/format.md: V1004 is not in format/src/container/issue.rs",
            ]
        );
    }

    #[test]
    fn an_empty_list_is_a_problem() {
        assert_eq!(check("", "").len(), 1);
    }
}
