//! What each rival takes on the GPU, and how long it takes to get there.

use std::hint::black_box;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result};
use vtex_format::{Limits, VtexFile};
use vtex_shaders::{FilterMode, PackOptions, Packed, fine_words, load, pack};

use super::sfg22::LAYER_SIZE;
use super::{compared, left_out};
use crate::report::{Cell, Table};
use crate::subject::{BC7_SIZES, RASTER_SIZE, Subject, ktx2};
use crate::timing::{Effort, Timing, Trial};

/// Which of [`BC7_SIZES`] is read from a file.
const READ: usize = 1;
/// zstd level of that file: the highest that needs no more memory to read than usual.
const ZSTD_LEVEL: i32 = 19;

/// Rows are files. The baseline of load times is the BC7 texture's.
pub(crate) fn load_table(subjects: &[Subject], effort: Effort) -> Result<Table> {
    let raster = format!("RGBA8 {RASTER_SIZE}^2");
    let bc7 = BC7_SIZES.map(|size| format!("BC7 {size}^2"));
    let read = format!("{} as a file", bc7[READ]);
    let load = format!("{} loads, ms", bc7[READ]);
    let mut columns = vec!["GPU bytes, KB (1000 bytes)", raster.as_str()];
    columns.extend(bc7.iter().map(String::as_str));
    columns.extend(["[SFG22]", "bands", "vector", &read, "vector file"]);
    columns.extend([
        "profile load",
        &load,
        "vector loads, ms",
        "profile load, ms",
    ]);
    let mut table = Table::new("GPU bytes and load time", &columns);
    table.note(format!(
        "Textures with all mips. `[SFG22]`: one RGBA8 layer of {LAYER_SIZE}^2 a shape. `bands`: \
         bounds, colours, bands and curves of the loop. `vector`: packed words and texels for lookups of \
         points. Files in KB."
    ));
    table.note(format!(
        "Load times are from the file's bytes in memory to the bytes of the upload, on one thread. \
         The vector texture: parsing, hashing, decoding, packing; `profile load` is the file that \
         `vtex bake --profile load` makes. BC7: unpacking each level's zstd \
         frame (level {ZSTD_LEVEL}), as KTX2 has it; nothing is hashed."
    ));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    for (index, subject) in subjects.iter().enumerate() {
        if effort.is_over() {
            table.note(left_out(&subjects[index..]));
            break;
        }
        // Blocks are encoded on all threads, before the one-threaded pool.
        let texture = ktx2::write(subject.bc7().levels(READ), ZSTD_LEVEL)?;
        let row = pool.install(|| row(subject, &texture, effort));
        table.row(row.with_context(|| subject.name.clone())?);
    }
    Ok(table)
}

fn row(subject: &Subject, texture: &[u8], effort: Effort) -> Result<Vec<Cell>> {
    let file = subject.file.to_bytes()?;
    let fine = fine_words(&subject.file, FilterMode::Point);
    let quick = VtexFile {
        fine,
        ..subject.file.clone()
    }
    .to_bytes()?;
    let packed = pack(&subject.file, &PackOptions::default());
    let trials = vec![
        Trial::timed(1, || timed(|| ktx2::read(texture))),
        Trial::timed(1, || timed(|| loaded(&file))),
        Trial::timed(1, || timed(|| loaded(&quick))),
    ];
    let timings = effort.interleave(trials)?;
    let kilobytes = |bytes: usize| Cell::Number(bytes as f64 / 1000.0, 1);
    let layer = 4 * (LAYER_SIZE * LAYER_SIZE) as usize;
    let mut cells = vec![Cell::Text(subject.name.clone())];
    cells.push(kilobytes(subject.raster.mips.iter().map(Vec::len).sum()));
    cells.extend((0..BC7_SIZES.len()).map(|first| kilobytes(subject.bc7().bytes(first))));
    cells.extend([
        kilobytes(layer * subject.file.shapes.len()),
        kilobytes(subject.bands.bytes()),
        kilobytes(packed.bytes()),
        kilobytes(texture.len()),
        kilobytes(file.len()),
        kilobytes(quick.len()),
    ]);
    cells.extend(compared(&timings, Timing::milliseconds));
    Ok(cells)
}

fn loaded(file: &[u8]) -> Result<Packed> {
    Ok(load(file, &Limits::default(), &PackOptions::default())?.packed)
}

fn timed<T>(work: impl FnOnce() -> Result<T>) -> Result<Duration> {
    let start = Instant::now();
    black_box(work()?);
    Ok(start.elapsed())
}
