//! Lints: members take the workspace's, and one file may call what is not safe.

/// The one member with lints of its own: calls of Vulkan are unsafe, and what the workspace forbids
/// no member can allow.
const OWN_LINTS: &str = "tools/isa/Cargo.toml";
/// Its only file that does.
const UNSAFE_FILE: &str = "tools/isa/src/vulkan.rs";
// In parts, so that this file keeps its own rule.
const LIFTED: &str = concat!("(unsafe", "_code");

/// A member takes the lints of `workspace`, the workspace's manifest. The exception repeats them
/// all, with unsafe code denied instead of forbidden.
pub(super) fn check_manifest(file: &str, content: &str, workspace: &str) -> Option<String> {
    if file == OWN_LINTS {
        let [forbidden, denied] = ["unsafe_code = \"forbid\"", "unsafe_code = \"deny\""];
        let expected: Vec<String> = tables(workspace, "[workspace.lints.")
            .map(|line| line.replace(forbidden, denied))
            .collect();
        let same = tables(content, "[lints.").eq(expected);
        return (!same).then(|| format!("{file}: lints other than the workspace's with {denied}"));
    }
    let mut lines = content
        .lines()
        .map(str::trim)
        .skip_while(|line| *line != "[lints]");
    let taken = lines.nth(1) == Some("workspace = true");
    (!taken).then(|| format!("{file}: lacks [lints] workspace = true"))
}

/// Lines of all tables whose heads begin with `prefix`, which the heads then lack.
fn tables<'a>(manifest: &'a str, prefix: &'a str) -> impl Iterator<Item = &'a str> {
    let mut is_inside = false;
    manifest.lines().map(str::trim).filter_map(move |line| {
        if line.starts_with('[') {
            is_inside = line.starts_with(prefix);
        }
        let line = line.strip_prefix(prefix).unwrap_or(line);
        (is_inside && !line.is_empty() && !line.starts_with('#')).then_some(line)
    })
}

/// Lines of a source file that lift the lint where it holds.
pub(super) fn check_source(file: &str, content: &str) -> Vec<String> {
    if file == UNSAFE_FILE || !file.ends_with(".rs") {
        return Vec::new();
    }
    (1..)
        .zip(content.lines())
        .filter(|(_, line)| line.contains(LIFTED))
        .map(|(number, _)| format!("{file}:{number}: unsafe code is for {UNSAFE_FILE} alone"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORKSPACE: &str = "[workspace]\nmembers = []\n\n[workspace.lints.rust]\n\
        unsafe_code = \"forbid\"\nmissing_docs = \"warn\"\n\n[workspace.lints.clippy]\n\
        todo = \"warn\"\n\n# Fast.\n[profile.release]\ndebug = false\n";

    #[test]
    fn members_take_the_lints() {
        let check = |content| check_manifest("a/Cargo.toml", content, WORKSPACE);
        let taken = "[package]\nname = \"a\"\n\n[lints]\nworkspace = true\n";
        assert_eq!(check(taken), None);
        assert!(check("[lints.rust]\n").is_some());
        assert!(check("[lints]\nworkspace = false\n").is_some());
    }

    #[test]
    fn the_exception_repeats_them() {
        let check = |content: &str| check_manifest(OWN_LINTS, content, WORKSPACE);
        let repeated = "[package]\nname = \"a\"\n\n[lints.rust]\nunsafe_code = \"deny\"\n\
            missing_docs = \"warn\"\n\n[lints.clippy]\ntodo = \"warn\"\n";
        assert_eq!(check(repeated), None);
        for (from, to) in [
            ("missing_docs = \"warn\"\n", ""),
            ("\"deny\"", "\"allow\""),
            ("todo = \"warn\"", "todo = \"allow\""),
        ] {
            assert!(check(&repeated.replace(from, to)).is_some(), "{from}");
        }
    }

    #[test]
    fn unsafe_code_is_lifted_in_one_file() {
        let line = format!("#![expect{LIFTED}, reason = \"why not\")]\n");
        assert_eq!(check_source(UNSAFE_FILE, &line), [""; 0]);
        assert_eq!(check_source("a.rs", &line).len(), 1);
        assert_eq!(check_source("a.md", &line), [""; 0]);
    }
}
