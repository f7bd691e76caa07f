//! What shaders cost on instruction sets, as their compilers say.

use anyhow::{Context as _, Result, ensure};

use crate::isa::{Chip, Compiled, Kernel, fragment_and_tracer, measure, named, of_files};
use crate::report::{Cell, Report, Table};
use vtex_format::VtexFile;

/// Statistics of RADV with their columns. A driver that has none of them gets a column for each of
/// its own.
const COLUMNS: [(&str, &str); 9] = [
    ("Instructions", "instructions"),
    ("VGPRs", "VGPRs"),
    ("SGPRs", "SGPRs"),
    ("Spilled VGPRs", "spilled VGPRs"),
    ("Spilled SGPRs", "spilled SGPRs"),
    ("Scratch size", "scratch bytes a wave"),
    ("Subgroups per SIMD", "waves a SIMD"),
    ("Branches", "branches"),
    ("Code size", "code bytes"),
];

/// Adds a table for each chip, or a sentence where its compiler is missing. Without `files` the
/// batch kernels are those of usual feature sets.
///
/// # Errors
/// When no chip gave a table.
pub(crate) fn add_isa_tables(
    report: &mut Report,
    chips: &[Chip],
    files: &[VtexFile],
) -> Result<()> {
    let mut kernels = match files {
        [] => named(),
        files => of_files(files),
    };
    kernels.extend(fragment_and_tracer()?);
    let mut count = 0;
    for chip in chips {
        match measure(chip, &kernels) {
            Ok((device, results)) => {
                report.add(table(&device, &kernels, &results)?)?;
                count += 1;
            }
            Err(problem) => report.say(&format!("No instruction set, {chip}: {problem:#}."))?,
        }
    }
    ensure!(count > 0, "no driver compiled the shaders");
    Ok(())
}

fn table(device: &str, kernels: &[Kernel], results: &[Result<Compiled, String>]) -> Result<Table> {
    let compiled: Vec<&Compiled> = results.iter().flatten().collect();
    let first = compiled.first().with_context(|| {
        let problem = results.iter().find_map(|result| result.as_ref().err());
        format!(
            "{device} compiled no shader: {}",
            problem.map_or("", String::as_str)
        )
    })?;
    let has = |name: &str| first.statistics.iter().any(|(own, _)| own == name);
    let mut columns: Vec<(&str, &str)> = COLUMNS
        .into_iter()
        .filter(|(statistic, _)| has(statistic))
        .collect();
    if columns.is_empty() {
        columns = first
            .statistics
            .iter()
            .map(|(name, _)| (name.as_str(), name.as_str()))
            .collect();
    }
    let heads: Vec<&str> = ["shader"]
        .into_iter()
        .chain(columns.iter().map(|(_, head)| *head))
        .chain(["compile ms"])
        .collect();
    let mut table = Table::new(format!("Instruction set, {device}"), &heads);
    table.note(
        "Compiled, not run: loops count once, and what no lookup of a file reaches counts as well.",
    );
    for (kernel, result) in kernels.iter().zip(results) {
        match result {
            Ok(compiled) => table.row(row(&kernel.name, &columns, compiled)),
            Err(problem) => table.note(format!("{}: {problem}", kernel.name)),
        }
    }
    Ok(table)
}

fn row(name: &str, columns: &[(&str, &str)], compiled: &Compiled) -> Vec<Cell> {
    let value = |name: &str| {
        let found = compiled.statistics.iter().find(|(own, _)| own == name);
        found.map_or(Cell::Text("-".to_owned()), |(_, value)| {
            Cell::Number(*value, 0)
        })
    };
    let mut cells = vec![Cell::Text(name.to_owned())];
    cells.extend(columns.iter().map(|(statistic, _)| value(statistic)));
    cells.push(Cell::Number(compiled.milliseconds, 0));
    cells
}
