//! The commands, one a file.

mod bake;
mod compare;
mod demo;
mod extract;
mod gltf;
mod info;
mod preview;
mod render;
mod validate;
mod worker;

use std::panic::{self, AssertUnwindSafe};
use std::process;

use clap::Parser;
use clap::error::ErrorKind;

use crate::cli::args::{Cli, Command};
use crate::cli::{Console, ExitCode, Failure, Outcome, Verbosity, keep_places, panicked};

/// Stack of each thread. Parsing and baking recurse into groups, and a drawing may nest them a
/// thousand deep: that takes more than the 2 MiB that a thread has by default. The system backs
/// only the part of a stack that was touched, so unused stack costs addresses and no memory.
const STACK_BYTES: usize = 64 << 20;

/// Runs the command line of this process and returns what the process is to exit with. Failures
/// are printed on standard error.
pub fn run() -> process::ExitCode {
    let code = match Cli::try_parse() {
        Ok(cli) => caught(cli),
        Err(error) => {
            // A closed pipe is the only way this fails, and then nobody reads the text.
            let _ = error.print();
            match error.kind() {
                ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => ExitCode::Ok,
                _ => ExitCode::Usage,
            }
        }
    };
    process::ExitCode::from(code as u8)
}

/// As [`execute`], where a panic is a failure like others.
fn caught(cli: Cli) -> ExitCode {
    keep_places();
    panic::catch_unwind(AssertUnwindSafe(|| execute(cli))).unwrap_or_else(|panic| {
        let failure = panicked("internal error", &*panic);
        Console::default().failure(&failure);
        failure.code
    })
}

fn execute(cli: Cli) -> ExitCode {
    let console = Console {
        verbosity: match (cli.global.quiet, cli.global.verbose) {
            (true, _) => Verbosity::Quiet,
            (_, true) => Verbosity::Verbose,
            _ => Verbosity::Normal,
        },
        format: cli.global.format,
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(cli.global.threads.into())
        .stack_size(STACK_BYTES)
        .build();
    let outcome = match pool {
        Ok(pool) => pool.install(|| dispatch(cli.command, console)),
        Err(error) => Err(Failure::runtime(format!(
            "cannot start threads: {error}; ask for fewer with --threads"
        ))),
    };
    outcome.unwrap_or_else(|failure| {
        console.failure(&failure);
        failure.code
    })
}

fn dispatch(command: Command, console: Console) -> Outcome<ExitCode> {
    match command {
        Command::Bake(args) => bake::run(*args, console),
        Command::Info(args) => info::run(&args, console),
        Command::Validate(args) => validate::run(&args, console),
        Command::Preview(args) => preview::run(&args, console),
        Command::Compare(args) => compare::run(args, console),
        Command::Extract(args) => extract::run(&args, console),
        Command::Render(args) => render::run(args, console),
        Command::Gltf(args) => gltf::run(&args, console),
        Command::Demo(args) => demo::run(args, console),
        Command::Worker(args) => worker::run(&args),
    }
}
