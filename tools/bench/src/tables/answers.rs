//! How the answers of rivals differ from those that they replace.

use anyhow::Result;
use vtex_shaders::FilterMode;

use super::left_out;
use super::lookups::vtex_kernel;
use crate::report::{Cell, Table};
use crate::subject::{Subject, filtered, hardware_kernel};
use crate::timing::{Device, Effort, Kernel, QuerySet};

/// Lookups whose answers are compared.
const COMPARED: usize = 1 << 18;

/// Rows are files.
pub(crate) fn answers_table(
    device: &Device,
    subjects: &[Subject],
    effort: Effort,
) -> Result<Table> {
    let columns = [
        "mean; largest",
        "bands, 8x",
        "bands, 1x",
        "BC7, 8x",
        "BC7, 1x",
        "shapes",
        "curves",
        "bands leave out",
    ];
    let mut table = Table::new("Answers of rivals", &columns);
    table.note(
        "Differences in any channel of linear light, in the windows `8x` and `1x` of the tables \
         above: of bands from `footprint`, of BC7 4096^2 from the raster. Bands have one ray in x \
         and one in y, weighted within a pixel; `footprint` is the mean of 32 samples. Bands \
         composite in linear light, so that translucent paints differ more. What they leave out \
         they do not pay for.",
    );
    for (index, subject) in subjects.iter().enumerate() {
        if effort.is_over() {
            table.note(left_out(&subjects[index..]));
            break;
        }
        table.row(row(device, subject)?);
    }
    Ok(table)
}

fn row(device: &Device, subject: &Subject) -> Result<Vec<Cell>> {
    let bands = &subject.bands;
    let footprint = vtex_kernel(device, subject, filtered(FilterMode::Footprint))?;
    let bc7 = device.has_bc7().then(|| subject.bc7().kernel(device, 0));
    let raster = hardware_kernel(device, &subject.raster);
    let [_, close, whole, _] = subject.query_sets(COMPARED);
    let mut cells = vec![Cell::Text(subject.name.clone())];
    for (rival, answer) in [(bands.kernel(device), &footprint), (bc7, &raster)] {
        for set in [&close, &whole] {
            cells.push(match &rival {
                Some(rival) => {
                    let [mean, largest] = differences(device, [rival, answer], set)?;
                    Cell::Text(format!("{mean:.5}; {largest:.3}"))
                }
                None => Cell::none(),
            });
        }
    }
    cells.push(Cell::Number(bands.shape_count() as f64, 0));
    cells.push(Cell::Number(bands.curve_count() as f64, 0));
    cells.push(match bands.left_out.is_empty() {
        true => Cell::Text("nothing".to_owned()),
        false => Cell::Text(bands.left_out.join(", ")),
    });
    Ok(cells)
}

/// Mean and largest difference of two kernels' answers.
fn differences(device: &Device, kernels: [&Kernel; 2], set: &QuerySet) -> Result<[f64; 2]> {
    let set = set.shorter(COMPARED);
    let batch = device.kept_batch(&set);
    let mut answers = Vec::with_capacity(2);
    for kernel in kernels {
        device.time(kernel, &batch)?;
        answers.push(device.results(&batch)?);
    }
    let [own, other] = [0, 1].map(|i| answers[i].as_flattened());
    let differences = own.iter().zip(other).map(|(a, b)| f64::from((a - b).abs()));
    let [sum, largest] = differences.fold([0.0, 0.0_f64], |[sum, largest], difference| {
        [sum + difference, largest.max(difference)]
    });
    Ok([sum / (4 * set.len()) as f64, largest])
}
