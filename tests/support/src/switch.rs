//! Environment variables that switch tests on and off, and how a test says that it did not run.

use std::io::Write as _;
use std::panic::Location;

/// Whether tests run at full length: `VTEX_SLOW=1`. Tests that sample take more samples; those
/// that take minutes run at all, see [`slow_only`].
///
/// # Panics
/// On any value but `1` and `0`: a switch with a typing error must not look switched off.
pub fn slow() -> bool {
    match std::env::var("VTEX_SLOW").as_deref() {
        Ok("1") => true,
        Ok("0" | "") | Err(std::env::VarError::NotPresent) => false,
        other => panic!("VTEX_SLOW is 1 or absent, not {other:?}"),
    }
}

/// [`slow`], for a test that does nothing otherwise: without it says that `untested` was skipped.
///
/// # Panics
/// As [`slow`].
#[track_caller]
pub fn slow_only(untested: &str) -> bool {
    let slow = slow();
    if !slow {
        skip("runs with VTEX_SLOW=1", untested);
    }
    slow
}

/// Whether tests that need a GPU adapter run. With `VTEX_GPU=off` says that `untested` was
/// skipped; otherwise a missing adapter is a failure of the test that wanted it.
#[track_caller]
pub fn gpu(untested: &str) -> bool {
    let off = std::env::var("VTEX_GPU").is_ok_and(|value| value == "off");
    if off {
        skip("VTEX_GPU=off", untested);
    }
    !off
}

/// Says in one line that a test left out `untested`, and why.
///
/// The line goes to the process's stderr itself: `eprintln!` goes to a buffer that libtest drops
/// when the test passes.
#[track_caller]
pub fn skip(why: &str, untested: &str) {
    let line = line(Location::caller(), why, untested);
    // A closed stderr is no reason to fail a test.
    let _ = std::io::stderr().write_all(line.as_bytes());
}

fn line(caller: &Location<'_>, why: &str, untested: &str) -> String {
    // libtest names a test's thread after the test, except when it runs all in the main thread.
    let thread = std::thread::current();
    let name = thread.name().filter(|name| *name != "main");
    let place = format!("{}:{}", caller.file(), caller.line());
    let test = name.map_or(place.clone(), |name| format!("{name} ({place})"));
    format!("NOT TESTED  {test}: {untested}: {why}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_names_the_test_and_what_was_left_out() {
        let line = std::thread::Builder::new()
            .name("cells::looks_right".to_owned())
            .spawn(|| line(Location::caller(), "no corpus", "the tiger"))
            .expect("a thread")
            .join()
            .expect("a line");
        assert!(
            line.starts_with("NOT TESTED  cells::looks_right ("),
            "{line}"
        );
        assert!(line.ends_with("): the tiger: no corpus\n"), "{line}");
    }
}
