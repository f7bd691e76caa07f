//! The commands, one a file.

mod bake;
mod compare;
mod demo;
mod extract;
mod info;
mod preview;
mod render;
mod validate;
mod worker;

use crate::args::{Cli, Command};
use crate::console::{Console, Verbosity};
use crate::failure::{ExitCode, Failure, Outcome};

/// Stack of each thread: drawings nest groups deeper than two megabytes take.
pub(crate) const STACK_BYTES: usize = 64 << 20;

/// Runs the command line and says with what the process is to exit. Failures are told on stderr.
pub fn run(cli: Cli) -> ExitCode {
    let console = Console {
        verbosity: match (cli.global.quiet, cli.global.verbose) {
            (true, _) => Verbosity::Quiet,
            (_, true) => Verbosity::Verbose,
            _ => Verbosity::Normal,
        },
        format: cli.global.format,
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(cli.global.threads)
        .stack_size(STACK_BYTES)
        .build();
    let outcome = match pool {
        Ok(pool) => pool.install(|| dispatch(cli.command, console)),
        Err(error) => Err(Failure::runtime(format!("cannot start threads: {error}"))),
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
        Command::Demo(args) => demo::run(args, console),
        Command::Worker(args) => worker::run(&args),
    }
}
