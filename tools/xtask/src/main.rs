//! Checks and chores of this workspace: `cargo xtask ci`, `cargo xtask tidy`.

#![expect(clippy::print_stdout, reason = "a tool talks to its user")]
#![expect(clippy::print_stderr, reason = "a tool talks to its user")]

mod ci;
mod tidy;
mod workspace;

use std::process::ExitCode;

use workspace::Workspace;

const USAGE: &str = "\
usage: cargo xtask ci [STEP...]   all checks, or the named ones
       cargo xtask tidy           the rules that no compiler knows";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let result = match arguments.split_first() {
        Some((name, steps)) if name == "ci" => Workspace::find().and_then(|ws| ci::run(&ws, steps)),
        Some((name, [])) if name == "tidy" => Workspace::find().and_then(|ws| tidy::run(&ws)),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(1);
        }
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(2),
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::from(2)
        }
    }
}
