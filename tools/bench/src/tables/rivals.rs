//! Other ways to look up a texture, which the design was weighed against. They need no file.

use anyhow::{Result, ensure};

use super::compared;
use super::sfg22::{self, LAYER_COUNTS, LAYER_SIZE};
use crate::report::{Cell, Table};
use crate::subject::{RASTER_SIZE, halves_kernel, hardware_kernel, synthetic};
use crate::timing::{Device, Effort, Kernel, QuerySet, Screen, Timing, Trial};

/// Texels of the mip chains compared when minified: the baker's default.
const MIP0_SIZE: u32 = 512;

/// Lookups of a set that are compared one by one.
const COMPARED: usize = 1 << 20;

/// Kernels with their names; the first is the baseline.
type Named = Vec<(String, Kernel)>;

/// The loop of \[SFG22\] beside the raster texture.
pub(crate) fn sfg22_table(device: &Device, effort: Effort) -> Result<Table> {
    let baseline = hardware_kernel(device, &synthetic(RASTER_SIZE));
    let mut kernels = vec![(format!("raster {RASTER_SIZE}^2, sampler"), baseline)];
    let layers = sfg22::Layers::upload(device);
    for count in LAYER_COUNTS {
        if let Some(kernel) = layers.kernel(device, count) {
            kernels.push((
                format!("[SFG22] loop, {count} layers {LAYER_SIZE}^2"),
                kernel,
            ));
        }
    }
    let screen = Screen::new([1.0, 1.0]);
    let count = effort.gpu_lookups;
    let sets = [
        screen.close([0.375, 0.375], count),
        screen.whole(count),
        screen.scattered(count),
    ];
    let mut table = lookups_table("[SFG22]'s dense layers", &kernels, device, &sets, effort)?;
    table.note(
        "One MSDF a shape, all read at each lookup: four `textureLoad`s a layer, not unrolled, \
         composited back to front.",
    );
    Ok(table)
}

/// Trilinear by hand from half floats beside the sampler (decision 0001).
pub(crate) fn minified_table(device: &Device, effort: Effort) -> Result<Table> {
    let image = synthetic(MIP0_SIZE);
    let kernels = vec![
        (
            format!("sRGB8 {MIP0_SIZE}^2, sampler"),
            hardware_kernel(device, &image),
        ),
        (
            format!("halves {MIP0_SIZE}^2 in a buffer, by hand"),
            halves_kernel(device, &image),
        ),
        ("no texture".to_owned(), nothing_kernel(device)),
    ];
    let screen = Screen::new([1.0, 1.0]);
    let near = screen.minified(effort.gpu_lookups);
    let claim = ("Minified lookups", "linear light");
    equals_table(claim, &kernels, device, near, effort)
}

/// One MSDF sample from a texture and from tiles in a buffer (decision 0001).
pub(crate) fn fetch_table(device: &Device, effort: Effort) -> Result<Table> {
    let kernels = vec![
        (
            "RGBA8 texture, 4 textureLoad".to_owned(),
            sfg22::fetch_texture_kernel(device),
        ),
        (
            "tiles in a buffer, 1 + 4 words".to_owned(),
            sfg22::fetch_buffer_kernel(device),
        ),
        ("no texture".to_owned(), nothing_kernel(device)),
    ];
    let screen = Screen::new([1.0, 1.0]);
    let near = screen.close([0.375, 0.375], effort.gpu_lookups);
    let claim = ("One MSDF sample", "the median");
    equals_table(claim, &kernels, device, near, effort)
}

/// Kernels of which the first two claim the same answer, looked up at `near`, at 1x and at random
/// points; `claim` is the title and what the answer is.
fn equals_table(
    (title, answer): (&str, &str),
    kernels: &Named,
    device: &Device,
    near: QuerySet,
    effort: Effort,
) -> Result<Table> {
    let screen = Screen::new([1.0, 1.0]);
    let count = effort.gpu_lookups;
    let sets = [near, screen.whole(count), screen.scattered(count)];
    let mut table = lookups_table(title, kernels, device, &sets, effort)?;
    let worst = disagreement(device, [&kernels[0].1, &kernels[1].1], &sets)?;
    table.note(format!(
        "The first two differ by at most {worst:.6} in {answer}."
    ));
    Ok(table)
}

/// Rows are kernels, columns are query sets, ratios are to the first row.
fn lookups_table(
    title: &str,
    kernels: &Named,
    device: &Device,
    sets: &[QuerySet],
    effort: Effort,
) -> Result<Table> {
    let mut columns = vec!["GPU, million lookups/s"];
    columns.extend(sets.iter().map(|set| set.name));
    let mut table = Table::new(title, &columns);
    let mut rows: Vec<Vec<Cell>> = kernels
        .iter()
        .map(|(name, _)| vec![Cell::Text(name.clone())])
        .collect();
    for set in sets {
        let batch = device.batch(set);
        let trials = kernels
            .iter()
            .map(|(_, kernel)| Trial::timed(set.len(), || device.time(kernel, &batch)));
        let timings = effort.interleave(trials.collect())?;
        let cells = compared(&timings, Timing::millions_a_second);
        rows.iter_mut()
            .zip(cells)
            .for_each(|(row, cell)| row.push(cell));
    }
    rows.into_iter().for_each(|row| table.row(row));
    Ok(table)
}

/// Largest difference of two kernels in any channel. Only rivals with the same answer can be compared.
fn disagreement(device: &Device, kernels: [&Kernel; 2], sets: &[QuerySet]) -> Result<f32> {
    let mut worst = 0.0_f32;
    for set in sets {
        let batch = device.kept_batch(&set.shorter(COMPARED));
        let mut answers = Vec::with_capacity(2);
        for kernel in kernels {
            device.time(kernel, &batch)?;
            answers.push(device.results(&batch)?);
        }
        let pairs = answers[0].iter().flatten().zip(answers[1].iter().flatten());
        worst = pairs.fold(worst, |worst, (a, b)| worst.max((a - b).abs()));
    }
    Ok(worst)
}

/// Checks that kernels look up the same points in the same order as the CPU.
///
/// # Errors
/// When they do not: figures would compare different work.
pub(crate) fn check_queries(device: &Device) -> Result<()> {
    let kernel = nothing_kernel(device);
    let screen = Screen::new([3.0, 2.0]);
    for set in [
        screen.close([0.3, 0.2], 1 << 18),
        screen.scattered(1 << 18),
        screen.tour(1 << 19),
    ] {
        let batch = device.kept_batch(&set);
        device.time(&kernel, &batch)?;
        for (query, result) in set.queries().iter().zip(device.results(&batch)?) {
            let [u, v] = query.uv;
            let expect = [u, v, query.footprint[0], query.footprint[3]];
            let same = expect
                .iter()
                .zip(result)
                .all(|(cpu, gpu)| (cpu - gpu).abs() < 1e-6);
            ensure!(
                same,
                "{}: the GPU asks at {result:?}, the CPU at {expect:?}",
                set.name
            );
        }
    }
    Ok(())
}

pub(super) fn nothing_kernel(device: &Device) -> Kernel {
    let tint = [1.0_f32; 4];
    let tint = device.buffer(bytemuck::cast_slice(&tint), wgpu::BufferUsages::UNIFORM);
    device.kernel(
        include_str!("../wgsl/nothing.wgsl"),
        &[tint.as_entire_binding()],
    )
}
