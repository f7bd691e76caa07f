//! What manifests promise: the oldest Rust that builds us, and what crates.io shows of a package.

use serde_json::Value;

/// Fields without which a package on crates.io is hard to find or to use.
const FIELDS: [&str; 5] = ["description", "license", "readme", "keywords", "categories"];

/// What is wrong with the members' manifests, given what `cargo metadata` printed.
pub(crate) fn check(metadata: &Value) -> Vec<String> {
    let packages = list(&metadata["packages"]);
    let members = list(&metadata["workspace_members"]);
    let is_member = |package: &&Value| members.contains(&package["id"]);
    let mut problems = rust_versions(packages, is_member);
    for package in packages.iter().filter(is_member) {
        if is_published(package) {
            problems.extend(missing_fields(package));
        }
    }
    problems
}

/// Names of the members that go to crates.io.
pub(crate) fn published(metadata: &Value) -> Vec<String> {
    let members = list(&metadata["workspace_members"]);
    let packages = list(&metadata["packages"]).iter();
    packages
        .filter(|package| members.contains(&package["id"]) && is_published(package))
        .map(|package| text(&package["name"]).to_owned())
        .collect()
}

/// All members name the same `rust-version`, and no dependency wants a later one.
fn rust_versions(packages: &[Value], is_member: impl Fn(&&Value) -> bool) -> Vec<String> {
    let mut problems = Vec::new();
    let ours = packages.iter().find(&is_member);
    let ours = ours.map_or("", |package| text(&package["rust_version"]));
    for package in packages {
        let name = text(&package["name"]);
        let theirs = text(&package["rust_version"]);
        if is_member(&package) && theirs != ours {
            problems.push(format!("{name}: rust-version {theirs:?}, others {ours:?}"));
        } else if version(theirs) > version(ours) {
            problems.push(format!(
                "{name} wants Rust {theirs}, rust-version is {ours}"
            ));
        }
    }
    problems
}

/// Whether `publish` leaves crates.io open.
fn is_published(package: &Value) -> bool {
    package["publish"].is_null()
}

fn missing_fields(package: &Value) -> Vec<String> {
    let name = text(&package["name"]);
    let is_empty = |field: &&&str| {
        let value = &package[**field];
        value.is_null() || value.as_array().is_some_and(Vec::is_empty)
    };
    let missing = FIELDS.iter().filter(is_empty);
    missing
        .map(|field| format!("{name}: no {field} in its manifest"))
        .collect()
}

/// Major, minor and patch; what is missing counts as 0.
fn version(text: &str) -> [u32; 3] {
    let mut numbers = text.split('.').map(|part| part.parse().unwrap_or(0));
    [0; 3].map(|_| numbers.next().unwrap_or(0))
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// Two members and one dependency.
    fn metadata() -> Value {
        let member = |name| {
            json!({
                "id": name, "name": name, "publish": null, "rust_version": "1.95",
                "description": "d", "license": "MIT", "readme": "README.md",
                "keywords": ["k"], "categories": ["c"],
            })
        };
        let dependency = json!({"id": "far", "name": "far", "rust_version": "1.90.1"});
        json!({
            "workspace_members": ["one", "two"],
            "packages": [member("one"), member("two"), dependency],
        })
    }

    #[track_caller]
    fn expect(change: impl FnOnce(&mut Value), problems: &[&str]) {
        let mut metadata = metadata();
        change(&mut metadata["packages"]);
        assert_eq!(check(&metadata), problems);
    }

    #[test]
    fn whole_manifests_are_clean() {
        expect(|_| (), &[]);
    }

    #[test]
    fn a_dependency_may_not_want_a_later_rust() {
        expect(
            |packages| packages[2]["rust_version"] = json!("1.95.1"),
            &["far wants Rust 1.95.1, rust-version is 1.95"],
        );
        expect(
            |packages| packages[2]["rust_version"] = json!("1.95.0"),
            &[],
        );
        expect(|packages| packages[2]["rust_version"] = json!(null), &[]);
    }

    #[test]
    fn members_name_the_same_rust() {
        expect(
            |packages| packages[1]["rust_version"] = json!("1.90"),
            &["two: rust-version \"1.90\", others \"1.95\""],
        );
    }

    #[test]
    fn only_what_is_published_needs_all_fields() {
        let bare = |packages: &mut Value| {
            packages[0]["keywords"] = json!([]);
            packages[0]["readme"] = json!(null);
        };
        expect(
            bare,
            &[
                "one: no readme in its manifest",
                "one: no keywords in its manifest",
            ],
        );
        let private = |packages: &mut Value| {
            bare(packages);
            packages[0]["publish"] = json!([]);
        };
        expect(private, &[]);
        let mut metadata = metadata();
        private(&mut metadata["packages"]);
        assert_eq!(published(&metadata), ["two"]);
    }
}
