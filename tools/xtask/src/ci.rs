//! `cargo xtask ci`: everything a change must pass, each step timed.

use std::io::{BufRead, BufReader, IsTerminal as _, Write};
use std::path::Path;
use std::process::{Command, Stdio};
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

/// The second argument takes what tests say that they left out, for the summary.
type Step = (
    &'static str,
    fn(&Workspace, &mut Vec<String>) -> Result<Outcome>,
);

/// How tests begin the line that says that they did not run (`vtex_testing::skip`).
const NOT_TESTED: &str = "NOT TESTED";
/// The target of browsers.
const WASM: &str = "wasm32-unknown-unknown";

/// Quick ones first.
const STEPS: &[Step] = &[
    ("format", |ws, _| cargo(ws, &["fmt", "--all", "--check"])),
    ("tidy", |ws, _| Ok(outcome(tidy::run(ws)?))),
    // What crates.io would get, not built.
    ("package", |ws, _| Ok(outcome(package::run(ws)?))),
    ("clippy", |ws, _| {
        let lint = [
            "clippy",
            "--release",
            "--workspace",
            "--all-targets",
            "--locked",
        ];
        cargo(ws, &[&lint[..], &["--", "-D", "warnings"]].concat())
    }),
    ("doc", |ws, _| {
        let arguments = ["doc", "--release", "--workspace", "--no-deps", "--locked"];
        let mut command = ws.cargo(&arguments);
        execute(command.env("RUSTDOCFLAGS", "-D warnings"))
    }),
    // What a browser needs compiles without a C compiler.
    ("wasm", |ws, _| wasm(ws)),
    // Unit, integration and doc tests.
    ("test", |ws, left_out| {
        tests(ws, left_out, &["--release", "--workspace", "--locked"])
    }),
    // The same reader once more: with overflow checks, which the release profile leaves out, and with
    // the decoder in Rust, which no other step runs files through.
    ("test-overflow", |ws, left_out| {
        let format = ["-p", "vtex-format", "--locked", "--no-default-features"];
        let features = ["--features", "encode,decode,ruzstd"];
        tests(ws, left_out, &[&format[..], &features].concat())
    }),
    ("deny", |ws, _| {
        if !has_deny(ws) {
            return Ok(Outcome::Failed);
        }
        // Without `-D warnings`: a duplicate version is worth a look, not a red build.
        cargo(
            ws,
            &["deny", "--locked", "check", "bans", "licenses", "sources"],
        )
    }),
    ("advisories", |ws, _| advisories(ws)),
];

/// Runs all steps, or the named ones, even when one fails. False when one did.
fn run_steps(ws: &Workspace, steps: &[Step]) -> Result<bool> {
    let mut report = Vec::new();
    let mut left_out = Vec::new();
    for (name, step) in steps {
        println!("==> {name}");
        let start = Instant::now();
        let outcome = step(ws, &mut left_out).with_context(|| format!("step {name}"))?;
        report.push((*name, outcome, start.elapsed()));
        println!("<== {}", row(report.last().expect("a row was pushed")));
    }
    println!("\nstep            outcome     wall");
    for line in &report {
        println!("{}", row(line));
    }
    // The same test runs in several steps.
    left_out.sort();
    left_out.dedup();
    for line in &left_out {
        println!("{line}");
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

/// `cargo test`, with what tests left out: a missing corpus, for one, is no failure everywhere.
fn tests(ws: &Workspace, left_out: &mut Vec<String>, arguments: &[&str]) -> Result<Outcome> {
    let mut command = ws.cargo(&[&["test"], arguments].concat());
    let stderr = std::io::stderr();
    if stderr.is_terminal() && std::env::var_os("CARGO_TERM_COLOR").is_none() {
        command.env("CARGO_TERM_COLOR", "always");
    }
    let mut child = command
        .stderr(Stdio::piped())
        .spawn()
        .with_context(|| format!("cannot run {command:?}"))?;
    let pipe = child.stderr.take().context("stderr is piped")?;
    left_out.extend(relay(BufReader::new(pipe), &mut stderr.lock())?);
    Ok(outcome(child.wait()?.success()))
}

/// Passes on what comes line by line; returns the lines of tests that did not run.
fn relay(from: impl BufRead, to: &mut impl Write) -> Result<Vec<String>> {
    let mut left_out = Vec::new();
    for line in from.split(b'\n') {
        let line = [&line?[..], b"\n"].concat();
        to.write_all(&line)?;
        if line.starts_with(NOT_TESTED.as_bytes()) {
            left_out.push(String::from_utf8_lossy(&line).trim_end().to_owned());
        }
    }
    Ok(left_out)
}

/// Checks the libraries for wasm32.
fn wasm(ws: &Workspace) -> Result<Outcome> {
    let wanted = ["--print", "target-libdir", "--target", WASM];
    let folder = Workspace::output_of(ws.command("rustc", &wanted))?;
    if !Path::new(folder.trim()).is_dir() {
        println!("the target {WASM} is missing: rustup target add {WASM}");
        return Ok(Outcome::Failed);
    }
    let check = ["check", "--release", "--locked", "--target", WASM];
    // The runtime brings format and shaders.
    let runtime = ["-p", "vtex-runtime", "--no-default-features"];
    let features = ["--features", "webgpu,tracer,ruzstd"];
    cargo(ws, &[&check[..], &runtime, &features].concat())
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
    fn what_was_not_tested_is_collected() {
        let output = b"Compiling\nNOT TESTED  a (b:1): the tiger: no corpus\n\xff\n";
        let mut seen = Vec::new();
        let left_out = relay(&output[..], &mut seen).unwrap();
        assert_eq!(seen, output);
        assert_eq!(left_out, ["NOT TESTED  a (b:1): the tiger: no corpus"]);
    }

    #[test]
    fn a_row_tells_name_outcome_and_time() {
        let row = row(&("clippy", Outcome::Failed, Duration::from_millis(61_240)));
        assert_eq!(row, "clippy          failed     61.2 s");
    }
}
