//! Makes the newest store of dictionaries in `vtex-format` from the shaders as they are now:
//! `cargo run --release -p vtex-shaders --features precompile --example shader_dictionaries`.
//!
//! Files that were written with dictionaries of the store before cannot be read any more. After a
//! release its store stays: name the new one after its ABI or with a letter behind it, and add it to
//! `STORES` in `format/src/packing/dictionary.rs`.

#![expect(clippy::print_stdout, reason = "an example talks to its user")]

use std::error::Error;
use std::path::Path;

use vtex_format::shader_dictionaries;
use vtex_shaders::{dictionary_keys, shader_blob};

/// The newest store.
const STORE: &str = "../format/src/packing/shaders-5.bin";

fn main() -> Result<(), Box<dyn Error>> {
    let keys = dictionary_keys();
    let shaders: Vec<_> = keys.iter().map(shader_blob).collect::<Result<_, _>>()?;
    let raw: usize = shaders
        .iter()
        .map(|shader| shader.wgsl_fragment.len() + 4 * shader.batch_spirv.len())
        .sum();
    let store = shader_dictionaries(&shaders)?;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(STORE);
    std::fs::write(&path, &store)?;
    let count = shaders.len();
    println!(
        "{count} shaders, {raw} bytes: a store of {} bytes",
        store.len()
    );
    Ok(())
}
