//! The checkout: its root, its files, its packages.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};

/// A package of the workspace.
pub(crate) struct Member {
    pub(crate) name: String,
    /// Relative to the root.
    pub(crate) folder: String,
}

/// The checkout this tool was built from.
pub(crate) struct Workspace {
    root: PathBuf,
}

impl Workspace {
    /// Finds it as the folder two above this package's.
    pub(crate) fn find() -> Result<Self> {
        let package = std::env::var("CARGO_MANIFEST_DIR").context("run this as `cargo xtask`")?;
        let root = Path::new(&package).join("../..").canonicalize()?;
        ensure!(
            root.join("Cargo.lock").is_file(),
            "{} is no workspace",
            root.display()
        );
        Ok(Self { root })
    }

    /// A command that runs in the root.
    pub(crate) fn command(&self, program: &str, arguments: &[&str]) -> Command {
        let mut command = Command::new(program);
        command.current_dir(&self.root).args(arguments);
        command
    }

    /// Cargo itself, the one that runs this tool.
    pub(crate) fn cargo(&self, arguments: &[&str]) -> Command {
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
        self.command(&cargo, arguments)
    }

    /// What a command prints.
    pub(crate) fn output_of(mut command: Command) -> Result<String> {
        let output = command
            .output()
            .with_context(|| format!("cannot run {command:?}"))?;
        if !output.status.success() {
            bail!(
                "{command:?} failed: {}",
                String::from_utf8_lossy(&output.stderr).trim()
            );
        }
        Ok(String::from_utf8(output.stdout)?)
    }

    /// Files that git tracks or would track, relative to the root, sorted.
    pub(crate) fn files(&self) -> Result<Vec<String>> {
        let listing = ["ls-files", "--cached", "--others", "--exclude-standard"];
        let text = Self::output_of(self.command("git", &listing))?;
        let mut files: Vec<String> = text.lines().map(str::to_owned).collect();
        // A deleted file stays in the index until it is committed.
        files.retain(|file| self.root.join(file).is_file());
        files.sort();
        files.dedup();
        Ok(files)
    }

    /// Text of a file; `None` when it is not UTF-8.
    pub(crate) fn read(&self, file: &str) -> Result<Option<String>> {
        let bytes = std::fs::read(self.root.join(file)).with_context(|| file.to_owned())?;
        Ok(String::from_utf8(bytes).ok())
    }

    /// The workspace's own packages, in the order of their names.
    pub(crate) fn members(&self) -> Result<Vec<Member>> {
        let arguments = ["metadata", "--format-version", "1", "--locked", "--no-deps"];
        let text = Self::output_of(self.cargo(&arguments))?;
        let metadata: serde_json::Value = serde_json::from_str(&text)?;
        let packages = metadata["packages"].as_array();
        let mut members = Vec::new();
        for package in packages.context("cargo metadata has no packages")? {
            let manifest = package["manifest_path"].as_str().unwrap_or_default();
            let folder = Path::new(manifest).parent().unwrap_or(&self.root);
            members.push(Member {
                name: package["name"].as_str().unwrap_or_default().to_owned(),
                folder: folder.strip_prefix(&self.root)?.display().to_string(),
            });
        }
        members.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(members)
    }

    /// `cargo metadata` with the dependencies that are built on this machine; those behind a
    /// foreign platform or a private `cfg` are not part of anything.
    pub(crate) fn metadata(&self) -> Result<serde_json::Value> {
        let rustc = Self::output_of(self.command("rustc", &["-vV"]))?;
        let host = rustc.lines().find_map(|line| line.strip_prefix("host: "));
        let platform = format!("--filter-platform={}", host.context("rustc tells no host")?);
        let arguments = ["metadata", "--format-version", "1", "--locked", &platform];
        let command = self.cargo(&arguments);
        Ok(serde_json::from_str(&Self::output_of(command)?)?)
    }
}
