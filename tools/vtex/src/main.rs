//! The `vtex` command; everything is in the library.

fn main() -> std::process::ExitCode {
    vtex::run()
}
