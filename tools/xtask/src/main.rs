//! Checks and chores of this workspace: `cargo xtask ci`, `cargo xtask tidy`, `cargo xtask bakes`,
//! `cargo xtask corpus`.

#![expect(clippy::print_stdout, reason = "a tool talks to its user")]
#![expect(clippy::print_stderr, reason = "a tool talks to its user")]

mod bakes;
mod ci;
mod corpus;
mod drawings;
mod package;
mod rooms;
mod tidy;
mod workspace;

use std::process::ExitCode;

use workspace::Workspace;

const USAGE: &str = "\
usage: cargo xtask ci [STEP...]   all checks, or the named ones
       cargo xtask tidy           the rules that no compiler knows
       cargo xtask rooms          files, import circles and floors of every crate and folder
       cargo xtask bakes OLD NEW DIR  what two builds of vtex bake differently; alone: its options
       cargo xtask corpus DIR     every SVG of a folder baked and measured; alone: its options";

/// Exit code of a difference found, as `vtex compare`'s.
const DIFFERENCE: u8 = 7;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut failed = 2;
    let result = match arguments.split_first() {
        Some((name, steps)) if name == "ci" => Workspace::find().and_then(|ws| ci::run(&ws, steps)),
        Some((name, [])) if name == "tidy" => Workspace::find().and_then(|ws| tidy::run(&ws)),
        Some((name, [])) if name == "rooms" => Workspace::find().and_then(|ws| rooms::run(&ws)),
        Some((name, [])) if name == "bakes" => {
            eprintln!("{}", bakes::USAGE);
            return ExitCode::from(1);
        }
        Some((name, rest)) if name == "bakes" => {
            failed = DIFFERENCE;
            bakes::run(rest)
        }
        Some((name, [])) if name == "corpus" => {
            eprintln!("{}", corpus::USAGE);
            return ExitCode::from(1);
        }
        Some((name, rest)) if name == "corpus" => {
            failed = DIFFERENCE;
            Workspace::find().and_then(|ws| corpus::run(&ws, rest))
        }
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(1);
        }
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(failed),
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::from(2)
        }
    }
}
