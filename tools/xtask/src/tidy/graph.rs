//! Who may depend on whom: `format <- shaders <- {baker, runtime <- gltf}`, and what none of them may
//! pull in, however far away.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, Result};
use serde_json::Value;

/// One package of the resolved graph.
#[derive(Debug, Default)]
pub(crate) struct Package {
    id: String,
    name: String,
    /// Path of `Cargo.toml`, relative to the workspace for members.
    pub(crate) manifest: String,
    pub(crate) is_member: bool,
    /// Ids it needs to build and run; what only its tests need is left out.
    dependencies: Vec<String>,
}

/// What a crate of ours may see of ours, and must not see at all.
struct Rule {
    name: &'static str,
    may_use: &'static [&'static str],
    must_not_reach: &'static [&'static str],
}

const SVG: [&str; 6] = [
    "usvg",
    "resvg",
    "tiny-skia",
    "fdsm",
    "i_overlay",
    "linesweeper",
];
const GPU: [&str; 3] = ["wgpu", "wgpu-core", "wgpu-hal"];

const RULES: [Rule; 5] = [
    Rule {
        name: "vtex-format",
        may_use: &[],
        must_not_reach: &["wgpu", "wgpu-core", "usvg", "glam", "rayon"],
    },
    Rule {
        name: "vtex-shaders",
        may_use: &["vtex-format"],
        must_not_reach: &["wgpu", "wgpu-core", "usvg", "rayon"],
    },
    Rule {
        name: "vtex-baker",
        may_use: &["vtex-format", "vtex-shaders"],
        must_not_reach: &GPU,
    },
    Rule {
        name: "vtex-runtime",
        may_use: &["vtex-format", "vtex-shaders"],
        must_not_reach: &[SVG[0], SVG[1], SVG[2], SVG[3], SVG[4], "rayon"],
    },
    Rule {
        name: "vtex-gltf",
        may_use: &["vtex-format", "vtex-shaders", "vtex-runtime"],
        must_not_reach: &[SVG[0], SVG[1], SVG[2], SVG[3], SVG[4], "rayon"],
    },
];

/// Reads what `cargo metadata` printed.
pub(crate) fn packages(metadata: &Value) -> Result<Vec<Package>> {
    let list = |value: &Value, key: &str| -> Result<Vec<Value>> {
        let list = value[key].as_array();
        list.cloned()
            .with_context(|| format!("cargo metadata has no {key}"))
    };
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let root = text(&metadata["workspace_root"]);
    let members: BTreeSet<String> = list(metadata, "workspace_members")?
        .iter()
        .map(text)
        .collect();
    let mut needs: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for node in list(&metadata["resolve"], "nodes")? {
        let is_needed = |dependency: &&Value| {
            let kinds = dependency["dep_kinds"].as_array();
            kinds.is_none_or(|kinds| kinds.iter().any(|kind| kind["kind"] != "dev"))
        };
        let dependencies = list(&node, "deps")?;
        let needed = dependencies.iter().filter(is_needed);
        needs.insert(
            text(&node["id"]),
            needed.map(|dep| text(&dep["pkg"])).collect(),
        );
    }
    let packages = list(metadata, "packages")?.into_iter().map(|package| {
        let id = text(&package["id"]);
        let path = text(&package["manifest_path"]);
        let relative = path
            .strip_prefix(&root)
            .map(|path| path.trim_start_matches('/'));
        Package {
            name: text(&package["name"]),
            manifest: relative.unwrap_or(&path).to_owned(),
            is_member: members.contains(&id),
            dependencies: needs.remove(&id).unwrap_or_default(),
            id,
        }
    });
    Ok(packages.collect())
}

/// What is wrong with the graph.
pub(crate) fn check(packages: &[Package]) -> Vec<String> {
    let by_id: BTreeMap<&str, &Package> = packages
        .iter()
        .map(|package| (package.id.as_str(), package))
        .collect();
    let mut problems = Vec::new();
    for rule in &RULES {
        let Some(package) = packages.iter().find(|p| p.is_member && p.name == rule.name) else {
            problems.push(format!("the workspace has no {}", rule.name));
            continue;
        };
        let direct = package
            .dependencies
            .iter()
            .filter_map(|id| by_id.get(id.as_str()));
        for dependency in direct.filter(|dependency| dependency.is_member) {
            if !rule.may_use.contains(&dependency.name.as_str()) {
                problems.push(format!("{} must not use {}", rule.name, dependency.name));
            }
        }
        for (name, path) in reachable(package, &by_id) {
            if rule.must_not_reach.contains(&name) {
                problems.push(format!("{} must not reach {name}: {path}", rule.name));
            }
        }
    }
    problems
}

/// Names of all packages below one, each with one way to it.
fn reachable<'a>(
    package: &'a Package,
    by_id: &BTreeMap<&str, &'a Package>,
) -> BTreeMap<&'a str, String> {
    let mut ways = BTreeMap::from([(package.name.as_str(), package.name.clone())]);
    let mut seen = BTreeSet::from([package.id.as_str()]);
    let mut open = vec![(package, package.name.clone())];
    while let Some((package, way)) = open.pop() {
        for id in &package.dependencies {
            let Some(dependency) = by_id.get(id.as_str()) else {
                continue;
            };
            if seen.insert(&dependency.id) {
                let way = format!("{way} -> {}", dependency.name);
                ways.insert(&dependency.name, way.clone());
                open.push((dependency, way));
            }
        }
    }
    ways
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A workspace with the five crates in their order; `more` is `(user, used)`.
    fn workspace(more: &[(&str, &str)]) -> Vec<Package> {
        let edges = [
            ("vtex-shaders", "vtex-format"),
            ("vtex-baker", "vtex-shaders"),
            ("vtex-baker", "usvg"),
            ("vtex-runtime", "vtex-shaders"),
            ("vtex-runtime", "wgpu"),
            ("vtex-gltf", "vtex-runtime"),
            ("vtex", "vtex-baker"),
            ("vtex", "vtex-runtime"),
        ];
        let edges: Vec<_> = edges.iter().chain(more).collect();
        let names: BTreeSet<&str> = edges
            .iter()
            .flat_map(|(user, used)| [*user, *used])
            .collect();
        let package = |name: &&str| Package {
            id: format!("id of {name}"),
            name: (*name).to_owned(),
            is_member: name.starts_with("vtex"),
            dependencies: edges
                .iter()
                .filter(|(user, _)| user == name)
                .map(|(_, used)| format!("id of {used}"))
                .collect(),
            ..Package::default()
        };
        names.iter().map(package).collect()
    }

    #[track_caller]
    fn expect(more: &[(&str, &str)], problems: &[&str]) {
        assert_eq!(check(&workspace(more)), problems);
    }

    #[test]
    fn the_intended_direction_is_clean() {
        expect(&[], &[]);
    }

    #[test]
    fn baker_and_runtime_do_not_meet() {
        expect(
            &[("vtex-baker", "vtex-runtime")],
            &[
                "vtex-baker must not use vtex-runtime",
                "vtex-baker must not reach wgpu: vtex-baker -> vtex-runtime -> wgpu",
            ],
        );
    }

    #[test]
    fn libraries_use_no_tool() {
        expect(
            &[("vtex-format", "vtex-tests")],
            &["vtex-format must not use vtex-tests"],
        );
    }

    #[test]
    fn a_far_dependency_is_found_with_the_way_to_it() {
        expect(
            &[("wgpu", "pool"), ("pool", "rayon")],
            &[
                "vtex-runtime must not reach rayon: vtex-runtime -> wgpu -> pool -> rayon",
                "vtex-gltf must not reach rayon: vtex-gltf -> vtex-runtime -> wgpu -> pool -> rayon",
            ],
        );
    }

    #[test]
    fn metadata_is_read_without_dev_dependencies() {
        let metadata = serde_json::json!({
            "workspace_root": "/root-of-it",
            "workspace_members": ["a"],
            "packages": [
                {"id": "a", "name": "a", "manifest_path": "/root-of-it/a/Cargo.toml"},
                {"id": "b", "name": "b", "manifest_path": "/elsewhere/b/Cargo.toml"},
                {"id": "c", "name": "c", "manifest_path": "/elsewhere/c/Cargo.toml"},
            ],
            "resolve": {"nodes": [
                {"id": "a", "deps": [
                    {"pkg": "b", "dep_kinds": [{"kind": null}, {"kind": "dev"}]},
                    {"pkg": "c", "dep_kinds": [{"kind": "dev"}]},
                ]},
                {"id": "b", "deps": []},
                {"id": "c", "deps": []},
            ]},
        });
        let packages = packages(&metadata).unwrap();
        assert_eq!(packages[0].manifest, "a/Cargo.toml");
        assert_eq!(packages[0].dependencies, ["b"]);
        assert!(packages[0].is_member && !packages[1].is_member);
    }
}
