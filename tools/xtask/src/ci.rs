//! `cargo xtask ci`: everything a change must pass, each step timed.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};

use crate::workspace::Workspace;
use crate::{package, tidy};

/// How a step ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    Passed,
    Failed,
    /// Could not be done here, and the output says why.
    Skipped,
}

/// What browsers run.
const WASM: &str = "wasm32-unknown-unknown";

type Step = (&'static str, fn(&Workspace) -> Result<Outcome>);

/// Quick ones first.
const STEPS: &[Step] = &[
    ("format", |ws| cargo(ws, &["fmt", "--all", "--check"])),
    ("tidy", |ws| Ok(outcome(tidy::run(ws)?))),
    ("package", |ws| Ok(outcome(package::run(ws)?))),
    ("clippy", |ws| {
        let lint = [
            "clippy",
            "--release",
            "--workspace",
            "--all-targets",
            "--locked",
        ];
        cargo(ws, &[&lint[..], &["--", "-D", "warnings"]].concat())
    }),
    ("doc", |ws| {
        let arguments = ["doc", "--release", "--workspace", "--no-deps", "--locked"];
        let mut command = ws.cargo(&arguments);
        execute(command.env("RUSTDOCFLAGS", "-D warnings"))
    }),
    ("wasm", wasm),
    // Unit, integration and doc tests.
    ("test", |ws| {
        cargo(ws, &["test", "--release", "--workspace", "--locked"])
    }),
    // The same reader with overflow checks, which the release profile leaves out.
    ("test-overflow", |ws| {
        cargo(ws, &["test", "-p", "vtex-format", "--locked"])
    }),
    ("deny", |ws| {
        if !has_deny(ws) {
            return Ok(Outcome::Failed);
        }
        // Without `-D warnings`: a duplicate version is worth a look, not a red build.
        cargo(
            ws,
            &["deny", "--locked", "check", "bans", "licenses", "sources"],
        )
    }),
    ("advisories", advisories),
];

/// Runs all steps, or the named ones, even when one fails. False when one did.
fn run_steps(ws: &Workspace, steps: &[Step]) -> Result<bool> {
    let mut report = Vec::new();
    for (name, step) in steps {
        println!("==> {name}");
        let start = Instant::now();
        let outcome = step(ws).with_context(|| format!("step {name}"))?;
        report.push((*name, outcome, start.elapsed()));
        println!("<== {}", row(report.last().expect("a row was pushed")));
    }
    println!("\nstep            outcome     wall");
    for line in &report {
        println!("{}", row(line));
    }
    Ok(report
        .iter()
        .all(|(_, outcome, _)| *outcome != Outcome::Failed))
}

/// Entry of `cargo xtask ci`.
pub(crate) fn run(ws: &Workspace, names: &[String]) -> Result<bool> {
    for name in names {
        let known = STEPS.iter().any(|(step, _)| step == name);
        ensure!(
            known,
            "no step {name}; there are {}",
            step_names().join(", ")
        );
    }
    let wanted = |step: &&Step| names.is_empty() || names.iter().any(|name| name == step.0);
    let steps: Vec<Step> = STEPS.iter().filter(wanted).copied().collect();
    run_steps(ws, &steps)
}

fn step_names() -> Vec<&'static str> {
    STEPS.iter().map(|(name, _)| *name).collect()
}

fn row((name, outcome, wall): &(&str, Outcome, Duration)) -> String {
    let outcome = format!("{outcome:?}").to_lowercase();
    format!("{name:<15} {outcome:<8} {:>6.1} s", wall.as_secs_f64())
}

fn outcome(passed: bool) -> Outcome {
    if passed {
        Outcome::Passed
    } else {
        Outcome::Failed
    }
}

fn execute(command: &mut Command) -> Result<Outcome> {
    let status = command
        .status()
        .with_context(|| format!("cannot run {command:?}"))?;
    Ok(outcome(status.success()))
}

fn cargo(ws: &Workspace, arguments: &[&str]) -> Result<Outcome> {
    execute(&mut ws.cargo(arguments))
}

/// The runtime, and all below it, in a browser: with the path tracer and without.
fn wasm(ws: &Workspace) -> Result<Outcome> {
    let directory = ["--print", "target-libdir", "--target", WASM];
    let directory = Workspace::output_of(ws.command("rustc", &directory))?;
    if !Path::new(directory.trim()).is_dir() {
        println!("no standard library for {WASM}: rustup target add {WASM}");
        return Ok(Outcome::Failed);
    }
    // The smaller set last: what it shares with the larger one is built by then.
    for features in ["webgpu,ruzstd,tracer", "webgpu,ruzstd"] {
        let mut arguments = vec!["check", "--release", "--locked", "--target", WASM];
        arguments.extend(["-p", "vtex-runtime", "--no-default-features"]);
        arguments.extend(["--features", features]);
        if cargo(ws, &arguments)? == Outcome::Failed {
            return Ok(Outcome::Failed);
        }
    }
    Ok(Outcome::Passed)
}

/// Whether cargo-deny is there; says how to get it otherwise.
fn has_deny(ws: &Workspace) -> bool {
    let version = Workspace::output_of(ws.cargo(&["deny", "--version"]));
    if version.is_err() {
        println!("cargo-deny is missing: cargo install cargo-deny --locked");
    }
    version.is_ok()
}

/// Known vulnerabilities, when their database can be reached: a build without a network is not
/// the project's fault.
fn advisories(ws: &Workspace) -> Result<Outcome> {
    if !has_deny(ws) {
        return Ok(Outcome::Failed);
    }
    if cargo(ws, &["deny", "--locked", "fetch", "db"])? == Outcome::Failed {
        println!("advisories were not checked: their database cannot be fetched here");
        return Ok(Outcome::Skipped);
    }
    cargo(
        ws,
        &["deny", "--locked", "check", "--disable-fetch", "advisories"],
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_have_their_own_names() {
        let mut names = step_names();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), STEPS.len());
    }

    #[test]
    fn a_row_tells_name_outcome_and_time() {
        let row = row(&("clippy", Outcome::Failed, Duration::from_millis(61_240)));
        assert_eq!(row, "clippy          failed     61.2 s");
    }
}
