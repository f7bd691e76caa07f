//! One hash of many lookups a file, to see whether a change leaves them bit-identical.
//!
//! `cargo run --release -p vtex-tests --example lookups_digest -- 1000000 FILE.vtex...` looks every
//! file up so many times with the CPU twin, packed with default options, half of them points and
//! half footprints between 2^-14 and 2 of the canvas. The same build of Rust on the same machine
//! prints the same lines; run it before and after a change and compare them.

#![expect(clippy::print_stdout, reason = "the hashes are wanted")]

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context as _, Result};
use rayon::prelude::*;
use vtex_format::{Limits, VtexFile};
use vtex_shaders::{PackOptions, Packed, cpu, pack};
use vtex_tests::random::Random;

/// Lookups that one task does; each block has random numbers of its own.
const BLOCK: usize = 1 << 14;
/// Footprints are between 2^-14 and 2^1 of the canvas long.
const OCTAVES: u32 = 15;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let usage = "usage: lookups_digest COUNT FILE.vtex...";
    let count: usize = arguments.next().context(usage)?.parse().context(usage)?;
    for path in arguments {
        let bytes = std::fs::read(&path).with_context(|| path.clone())?;
        let file = VtexFile::parse(&bytes, &Limits::default()).with_context(|| path.clone())?;
        let packed = pack(&file, &PackOptions::default());
        let name = Path::new(&path).file_name().unwrap_or_default();
        println!(
            "{}  words {}  {}",
            digest(&packed, count),
            hash_words(&packed.words),
            name.display()
        );
    }
    Ok(())
}

/// The hash of all bits of `count` lookups, in order.
fn digest(packed: &Packed, count: usize) -> String {
    let sampler = cpu::Sampler::new(packed);
    let blocks: Vec<String> = (0..count.div_ceil(BLOCK))
        .into_par_iter()
        .map(|block| {
            let size = BLOCK.min(count - block * BLOCK);
            hash_words(&lookups(&sampler, block as u64, size))
        })
        .collect();
    hex(vtex_shaders::hash(&blocks.concat()))
}

/// Bits of the colours of `size` lookups, points and footprints by turns.
fn lookups(sampler: &cpu::Sampler<'_>, seed: u64, size: usize) -> Vec<u32> {
    let mut random = Random::new(seed);
    let mut bits = Vec::with_capacity(4 * size);
    for index in 0..size {
        // A little beyond the canvas too: address modes are part of a lookup.
        let uv = [random.between(-0.1, 1.1), random.between(-0.1, 1.1)];
        let footprint = if index % 2 == 0 {
            [0.0; 4]
        } else {
            footprint(&mut random)
        };
        bits.extend(sampler.sample(uv, footprint).map(f32::to_bits));
    }
    bits
}

/// A parallelogram: isotropic, long and thin, or slanted.
fn footprint(random: &mut Random) -> [f32; 4] {
    // A power of two and a mantissa: no function whose last bit depends on the platform.
    let long = random.between(1.0, 2.0) / (1_u32 << random.below(OCTAVES)) as f32;
    let [u, v] = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)].map(|part| part * long);
    match random.below(4) {
        0 => [long, 0.0, 0.0, long],
        1 => [u, v, -v, u],
        2 => {
            let thin = 1.0 / (1_u32 << random.below(5)) as f32;
            [u, v, -v * thin, u * thin]
        }
        _ => {
            let other = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
            [u, v, other[0] * long, other[1] * long]
        }
    }
}

fn hash_words(words: &[u32]) -> String {
    let mut text = String::with_capacity(8 * words.len());
    for word in words {
        // Writing to a string does not fail.
        let _ = write!(text, "{word:08x}");
    }
    hex(vtex_shaders::hash(&text))
}

/// Half of a hash is enough to tell files apart.
fn hex(hash: [u8; 32]) -> String {
    hash[..16]
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}
