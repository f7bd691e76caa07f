//! Rules on the text of files.

/// Lines of a source file, tests included. Past it a reader loses the thread; a file that is
/// better long says why in its first lines, after [`LONG_FILE`].
const MAX_LINES: usize = 500;
/// How many lines count as first.
const FIRST_LINES: usize = 12;

// In parts, so that this file keeps its own rules.
const LONG_FILE: &str = concat!("tidy: long ", "because ");
const SYNC: &str = concat!("keep in ", "sync");
const MARK: &str = concat!("TO", "DO");
/// Folders of one machine or another that have no place in a file.
const MACHINE_PATHS: [&str; 6] = [
    concat!("/ho", "me/"),
    concat!("/ro", "ot/"),
    concat!("/Us", "ers/"),
    concat!("/wo", "rk/"),
    concat!("/mn", "t/"),
    concat!("/tm", "p/"),
];

/// What is wrong with a file's text, one line each.
pub(crate) fn check(file: &str, content: &str) -> Vec<String> {
    let extension = file.rsplit_once('.').map_or("", |(_, extension)| extension);
    let is_source = matches!(extension, "rs" | "wgsl");
    let mut problems = Vec::new();
    if is_source {
        problems.extend(check_length(file, content));
    }
    // Test modules say it by their names.
    if extension == "rs" && !file.contains("tests") && !content.starts_with("//!") {
        problems.push(format!("{file}:1: no //! line says what the file holds"));
    }
    for (number, line) in (1..).zip(content.lines()) {
        let mut note = |what: String| problems.push(format!("{file}:{number}: {what}"));
        if is_source && line.to_lowercase().contains(SYNC) {
            note("a copy that someone must remember; make one of them the source".to_owned());
        }
        if is_source && !todos_have_issues(line) {
            note(format!("{MARK} needs an issue: {MARK}(#12)"));
        }
        if let Some(path) = MACHINE_PATHS.iter().find(|path| names_path(line, path)) {
            note(format!("{path} is a path of one machine"));
        }
    }
    problems
}

fn check_length(file: &str, content: &str) -> Option<String> {
    let length = content.lines().count();
    let excused = content
        .lines()
        .take(FIRST_LINES)
        .any(|line| line.contains(LONG_FILE));
    (length > MAX_LINES && !excused).then(|| {
        format!("{file}: {length} lines, {MAX_LINES} at most; split it, or say \"{LONG_FILE}...\"")
    })
}

/// Every mark is followed by an issue's number in parentheses.
fn todos_have_issues(line: &str) -> bool {
    line.split(MARK).skip(1).all(|rest| {
        let number = rest
            .strip_prefix("(#")
            .and_then(|rest| rest.split_once(')'));
        number.is_some_and(|(digits, _)| {
            !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
        })
    })
}

/// Whether the path stands at its beginning, not in the middle of another or of an address.
fn names_path(line: &str, path: &str) -> bool {
    line.match_indices(path).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        before.is_none_or(|c| !c.is_alphanumeric() && !matches!(c, '.' | '-' | '_' | '/' | '}'))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn expect(file: &str, content: &str, places: &[&str]) {
        let found = check(file, content);
        let same = found.len() == places.len()
            && found
                .iter()
                .zip(places)
                .all(|(found, place)| found.starts_with(place));
        assert!(same, "{found:#?} instead of {places:?}");
    }

    #[test]
    fn long_files_need_a_reason() {
        let long = "//! x\n".repeat(MAX_LINES + 1);
        expect("a.rs", &long, &["a.rs: 501 lines"]);
        expect("a.wgsl", &long, &["a.wgsl: 501 lines"]);
        expect("a.svg", &long, &[]);
        expect("a.rs", &"//! x\n".repeat(MAX_LINES), &[]);
        expect(
            "a.rs",
            &format!("//! x\n// {LONG_FILE}it is a table.\n{long}"),
            &[],
        );
    }

    #[test]
    fn files_say_what_they_hold() {
        expect("a.rs", "fn main() {}\n", &["a.rs:1: no //!"]);
        expect("a_tests.rs", "use super::*;\n", &[]);
    }

    #[test]
    fn copies_are_refused() {
        let line = SYNC.replace("keep", "Keep");
        expect(
            "a.rs",
            &format!("//! x\n// {line} with b\n"),
            &["a.rs:2: a copy"],
        );
        expect("a.md", &line, &[]);
    }

    #[test]
    fn promises_need_an_issue() {
        expect("a.wgsl", &format!("// {MARK}(#12): faster\n"), &[]);
        expect("a.wgsl", &format!("// {MARK}: faster\n"), &["a.wgsl:1"]);
        expect("a.wgsl", &format!("// {MARK}(#): faster\n"), &["a.wgsl:1"]);
        expect(
            "a.wgsl",
            &format!("// {MARK}(me): {MARK}(#1)\n"),
            &["a.wgsl:1"],
        );
    }

    #[test]
    fn machine_paths_are_refused_where_they_begin() {
        let path = MACHINE_PATHS[0];
        expect("a.md", &format!("see {path}someone/x\n"), &["a.md:1"]);
        expect("a.md", &format!("{path}someone\n"), &["a.md:1"]);
        expect("a.md", &format!("https://example.org{path}x\n"), &[]);
        expect("a.md", &format!("$PREFIX{path}x and ${{D}}{path}\n"), &[]);
    }
}
