//! Collects tables, prints each when it is complete, and writes all to files at the end.

mod table;

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context as _, Result};
use serde_json::{Value, json};

use crate::timing::{Device, Machine, load_average};

pub(crate) use table::{Cell, Table};

/// One run of the benchmark.
#[derive(Debug)]
pub(crate) struct Report {
    machine: Machine,
    adapter: Option<Value>,
    loads: Vec<f64>,
    start: Instant,
    markdown: String,
    tables: Vec<Table>,
    remarks: Vec<String>,
}

impl Report {
    /// Prints the machine and the adapter.
    pub(crate) fn begin(machine: Machine, device: Option<&Device>, fonts: usize) -> Result<Self> {
        let mut report = Self {
            adapter: device.map(Device::to_json),
            loads: load_average().into_iter().collect(),
            start: Instant::now(),
            markdown: String::new(),
            tables: Vec::new(),
            remarks: Vec::new(),
            machine,
        };
        let mut lines = report.machine.lines();
        lines.extend(device.map(Device::lines).unwrap_or_default());
        lines.push(("Fonts", format!("{fonts} faces of the system")));
        let lines = lines
            .iter()
            .map(|(name, value)| format!("- {name}: {value}\n"));
        report.print(&lines.collect::<String>())?;
        Ok(report)
    }

    /// The machine that it runs on.
    pub(crate) fn machine(&self) -> &Machine {
        &self.machine
    }

    /// Prints a sentence and keeps it.
    pub(crate) fn say(&mut self, sentence: &str) -> Result<()> {
        self.print(&format!("\n{sentence}\n"))?;
        self.remarks.push(sentence.to_owned());
        Ok(())
    }

    /// Prints a table and keeps it.
    pub(crate) fn add(&mut self, table: Table) -> Result<()> {
        self.print(&format!("\n{}", table.to_markdown()))?;
        self.tables.push(table);
        Ok(())
    }

    /// As [`Report::add`].
    pub(crate) fn add_all(&mut self, tables: Vec<Table>) -> Result<()> {
        tables.into_iter().try_for_each(|table| self.add(table))
    }

    /// Prints how busy the machine was, and writes the files that the command line names.
    pub(crate) fn finish(mut self, markdown: Option<&Path>, json: Option<&Path>) -> Result<()> {
        self.loads.extend(load_average());
        let loads: Vec<String> = self.loads.iter().map(|load| format!("{load:.1}")).collect();
        let seconds = self.start.elapsed().as_secs_f64();
        let mut last = format!("\nThe whole run took {seconds:.0} s.");
        if !loads.is_empty() {
            let cores = self.machine.cores();
            let loads = loads.join(" before and ");
            last.push_str(&format!(" Load average: {loads} after, on {cores} cores."));
        }
        self.print(&format!("{last}\n"))?;
        if let Some(path) = markdown {
            write(path, &self.markdown)?;
        }
        if let Some(path) = json {
            write(path, &format!("{:#}\n", self.to_json()))?;
        }
        Ok(())
    }

    fn to_json(&self) -> Value {
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "machine": self.machine.to_json(),
            "adapter": self.adapter,
            "load_average": self.loads,
            "seconds": self.start.elapsed().as_secs_f64(),
            "remarks": self.remarks,
            "tables": self.tables.iter().map(Table::to_json).collect::<Vec<_>>(),
        })
    }

    fn print(&mut self, text: &str) -> Result<()> {
        self.markdown.push_str(text);
        let mut out = std::io::stdout().lock();
        out.write_all(text.as_bytes())
            .and_then(|()| out.flush())
            .context("cannot print")
    }
}

fn write(path: &Path, text: &str) -> Result<()> {
    fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}
