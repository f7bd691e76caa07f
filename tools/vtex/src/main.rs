//! The `vtex` command; everything is in the library.

use std::panic::{self, AssertUnwindSafe};
use std::process::ExitCode;

use clap::Parser;
use clap::error::ErrorKind;
use vtex::args::Cli;
use vtex::console::Console;
use vtex::{baking, command, failure};

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let asked = matches!(
                error.kind(),
                ErrorKind::DisplayHelp | ErrorKind::DisplayVersion
            );
            // A closed pipe is the only way this fails, and nobody is left to be told.
            let _ = error.print();
            let code = if asked {
                failure::ExitCode::Ok
            } else {
                failure::ExitCode::Usage
            };
            return ExitCode::from(code as u8);
        }
    };
    // A panic is reported once, as one line, where it is caught.
    panic::set_hook(Box::new(|_| ()));
    let code =
        panic::catch_unwind(AssertUnwindSafe(|| command::run(cli))).unwrap_or_else(|panic| {
            let failure = baking::panicked("internal error", &*panic);
            Console::default().failure(&failure);
            failure.code
        });
    ExitCode::from(code as u8)
}
