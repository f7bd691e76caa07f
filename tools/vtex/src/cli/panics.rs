//! A panic is a defect of vtex. It is reported once, as one line that says where it happened.

use std::any::Any;
use std::panic;
use std::sync::{Mutex, PoisonError};

use super::Failure;

/// Where the last panic happened that nobody reported yet.
///
/// A panic carries its message but not its place: only the hook sees that, on the thread that
/// panics. The report is made later, by the thread that catches the panic, which is another one
/// when the panic comes from a thread pool. Two panics at the same moment could swap their places;
/// both are printed all the same.
static LAST_PLACE: Mutex<Option<String>> = Mutex::new(None);

/// Replaces Rust's own report on standard error: from now on a panic prints nothing and its place
/// is kept for [`panicked`].
pub(crate) fn keep_places() {
    panic::set_hook(Box::new(|info| {
        let place = info.location().map(|at| {
            let (file, line) = (short(at.file()), at.line());
            format!("{file}:{line}")
        });
        *LAST_PLACE.lock().unwrap_or_else(PoisonError::into_inner) = place;
    }));
}

/// The failure for a caught panic that happened while `doing` something.
pub(crate) fn panicked(doing: &str, panic: &(dyn Any + Send)) -> Failure {
    let text = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message");
    let place = LAST_PLACE
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .take()
        .unwrap_or_else(|| "unknown place".to_owned());
    Failure::runtime(format!(
        "{doing}: vtex has a bug, please report this line: panic at {place}: {text}"
    ))
}

/// The source file without the folders of the machine that built this program: crates of the
/// registry are compiled from `.../registry/src/<index>/name-version/...`.
fn short(file: &str) -> &str {
    let in_registry = file.split_once("registry/src/");
    let of_index = in_registry.and_then(|(_, rest)| rest.split_once('/'));
    of_index.map_or(file, |(_, path)| path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_on_another_thread_is_reported_with_its_place() {
        keep_places();
        let line = line!() + 1;
        let thread = std::thread::spawn(|| panic!("{} is odd", 3));
        let panic = thread.join().expect_err("it panics");
        // Other tests of this process may panic at the same time only if they fail.
        let failure = panicked("a.svg: baking", &*panic);
        let file = file!();
        assert_eq!(
            failure.message,
            format!(
                "a.svg: baking: vtex has a bug, please report this line: panic at {file}:{line}: 3 is odd"
            )
        );
    }

    #[test]
    fn places_in_other_crates_name_crate_and_file() {
        let registry = "/x/.cargo/registry/src/index.crates.io-1949cf8c/usvg-0.49.0/src/a.rs";
        assert_eq!(short(registry), "usvg-0.49.0/src/a.rs");
        assert_eq!(short("baker/src/lib.rs"), "baker/src/lib.rs");
    }
}
