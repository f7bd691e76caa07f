//! What the loop over curves of bands holds, and how its answers differ from the vector texture's.

use anyhow::Result;

use super::left_out;
use super::lookups::vtex_kernel;
use crate::report::{Cell, Table};
use crate::subject::Subject;
use crate::timing::{Device, Effort, Kernel, QuerySet};
use vtex_shaders::FilterMode;

/// Lookups whose answers are compared.
const COMPARED: usize = 1 << 18;

/// Rows are files.
pub(crate) fn bands_table(device: &Device, subjects: &[Subject], effort: Effort) -> Result<Table> {
    let columns = [
        "against `footprint`",
        "shapes",
        "curves",
        "8x: mean",
        "8x: largest",
        "1x: mean",
        "1x: largest",
        "left out",
    ];
    let mut table = Table::new("The answers of the loop over curves of bands", &columns);
    table.note(
        "Differences of lookups in the windows of the tables above, in any channel of linear light. \
         The loop has one ray in x and one in y, weighted within a pixel; the footprint's mean is \
         of 32 samples. It composites in linear light, so that translucent paints differ more. \
         `left out`: what the loop cannot draw, and so is not paid for.",
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
    let mut cells = vec![
        Cell::Text(subject.name.clone()),
        Cell::Number(bands.shape_count() as f64, 0),
        Cell::Number(bands.curve_count() as f64, 0),
    ];
    match bands.kernel(device) {
        Some(kernel) => {
            let ours = vtex_kernel(device, subject, FilterMode::Footprint);
            let [_, close, whole, _] = subject.query_sets(COMPARED);
            for set in [close, whole] {
                let [mean, largest] = differences(device, [&kernel, &ours], &set)?;
                cells.extend([Cell::Number(mean, 5), Cell::Number(largest, 3)]);
            }
        }
        None => cells.extend([(); 4].map(|()| Cell::none())),
    }
    cells.push(match bands.left_out.is_empty() {
        true => Cell::none(),
        false => Cell::Text(bands.left_out.join(", ")),
    });
    Ok(cells)
}

/// Mean and largest difference of two kernels' answers.
fn differences(device: &Device, kernels: [&Kernel; 2], set: &QuerySet) -> Result<[f64; 2]> {
    let batch = device.batch(set);
    let mut answers = Vec::with_capacity(2);
    for kernel in kernels {
        device.time(kernel, &batch)?;
        answers.push(device.results(&batch)?);
    }
    let channels = [0, 1].map(|i| answers[i].as_flattened().iter());
    let [ours, theirs] = channels;
    let differences = ours.zip(theirs).map(|(a, b)| f64::from((a - b).abs()));
    let [sum, largest] = differences.fold([0.0, 0.0_f64], |[sum, largest], difference| {
        [sum + difference, largest.max(difference)]
    });
    Ok([sum / (4 * set.len()) as f64, largest])
}
