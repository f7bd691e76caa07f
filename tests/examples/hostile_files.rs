//! Writes the files of `vtex_tests::hostile`, to measure what reading and loading make of them.
//!
//! `cargo run --release -p vtex-tests --example hostile_files -- FOLDER`

#![expect(clippy::print_stdout, reason = "the names are wanted")]

use std::path::PathBuf;

use anyhow::{Context as _, Result};
use vtex_tests::hostile::HOSTILE;

fn main() -> Result<()> {
    let folder = std::env::args_os().nth(1);
    let folder = PathBuf::from(folder.context("usage: hostile_files FOLDER")?);
    for hostile in &HOSTILE {
        let bytes = hostile.bytes();
        let path = folder.join(hostile.name).with_extension("vtex");
        std::fs::write(&path, &bytes).with_context(|| path.display().to_string())?;
        println!("{}: {} bytes, {}", hostile.name, bytes.len(), hostile.what);
    }
    Ok(())
}
