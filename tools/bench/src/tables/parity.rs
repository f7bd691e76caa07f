//! What the GPU answers beside the twin.

use anyhow::Result;
use rayon::prelude::*;
use vtex_runtime::{BatchSampler, LoadOptions, Trust};
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{BatchQuery, PackOptions};

use super::left_out;
use crate::report::{Cell, Table};
use crate::subject::{Subject, modes};
use crate::timing::{Device, Effort, random_queries};

/// A quarter of an 8-bit step: what two lookups may differ by and count as the same.
const SAME: f32 = 0.001;

/// Differences of the lookups of one file in one filter mode.
#[derive(Clone, Copy, Debug, Default)]
struct Difference {
    largest: f32,
    lookups: usize,
    different: usize,
}

impl Difference {
    fn of(cpu: &[[f32; 4]], gpu: &[[f32; 4]]) -> Self {
        let worst = |(cpu, gpu): (&[f32; 4], &[f32; 4])| {
            let channels = cpu.iter().zip(gpu).map(|(a, b)| (a - b).abs());
            channels.fold(0.0, |worst: f32, one| match one.is_nan() {
                true => f32::INFINITY,
                false => worst.max(one),
            })
        };
        let differences = cpu.iter().zip(gpu).map(worst);
        differences.fold(Self::default(), |sum, one| Self {
            largest: sum.largest.max(one),
            lookups: sum.lookups + 1,
            different: sum.different + usize::from(one > SAME),
        })
    }
}

/// A row a file, two columns a filter mode.
pub(crate) fn parity_table(device: &Device, subjects: &[Subject], effort: Effort) -> Result<Table> {
    let heads: Vec<[String; 2]> = modes()
        .iter()
        .map(|(mode, _)| [format!("{mode}, largest"), format!("{mode}, per million")])
        .collect();
    let mut columns = vec!["GPU and twin"];
    columns.extend(heads.iter().flatten().map(String::as_str));
    let mut table = Table::new("Differences between GPU and twin", &columns);
    let queries = random_queries(effort.cpu_lookups);
    let mut worst = (0.0_f32, String::from("no lookup differs"));
    for (index, subject) in subjects.iter().enumerate() {
        if effort.is_over() {
            table.note(left_out(&subjects[index..]));
            break;
        }
        let mut cells = vec![Cell::Text(subject.name.clone())];
        for (mode, pack) in modes() {
            let found = difference(device, subject, pack, &queries)?;
            if found.largest > worst.0 {
                worst = (found.largest, format!("{}, {mode}", subject.name));
            }
            let share = found.different as f64 / found.lookups as f64;
            cells.push(Cell::Number(found.largest.into(), 7));
            cells.push(Cell::Number(1e6 * share, 1));
        }
        table.row(cells);
    }
    table.note(format!(
        "{} lookups of each file in each mode, at random points on and around the canvas, with \
         footprints from 1/65536 of the canvas to all of it in any direction. Largest: the largest \
         difference in any channel, in linear light; over all {:.7} ({}). Per million: lookups that \
         differ by more than {SAME}, which at an edge one sample can make.",
        queries.len(),
        worst.0,
        worst.1,
    ));
    Ok(table)
}

fn difference(
    device: &Device,
    subject: &Subject,
    pack: PackOptions,
    queries: &[BatchQuery],
) -> Result<Difference> {
    let options = LoadOptions {
        pack,
        ..LoadOptions::default()
    };
    let (own, queue) = (&device.device, &device.queue);
    let gpu = BatchSampler::new(own, queue, &subject.file, &options, Trust::Regenerate)?;
    let answers = gpu.sample(queries)?;
    let packed = subject.packed(&pack);
    let twin = Sampler::new(&packed);
    let cpu: Vec<[f32; 4]> = queries
        .par_iter()
        .map(|query| twin.sample(query.uv, query.footprint))
        .collect();
    Ok(Difference::of(&cpu, &answers))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_counted_and_what_is_no_number_is_one() {
        let black = [0.0, 0.0, 0.0, 1.0];
        let cpu = [black; 3];
        let same = Difference::of(&cpu, &cpu);
        assert_eq!((same.largest, same.different, same.lookups), (0.0, 0, 3));
        let gpu = [black, [0.0, 0.25, 0.0, 1.0], [0.0, 0.0, SAME / 2.0, 1.0]];
        let some = Difference::of(&cpu, &gpu);
        assert_eq!((some.largest, some.different), (0.25, 1));
        let broken = Difference::of(&cpu, &[black, black, [f32::NAN; 4]]);
        assert_eq!((broken.largest, broken.different), (f32::INFINITY, 1));
    }
}
