//! `vtex-bench`: how long bakes, lookups and rays take on this machine, compared with their rivals.

mod args;
mod isa;
mod report;
mod subject;
mod tables;
mod timing;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, bail};
use clap::Parser as _;
use vtex_baker::Resources;

use crate::args::{Args, Part};
use crate::report::{Report, Table};
use crate::subject::{Subject, bake, find, name, system_fonts};
use crate::timing::{Device, Effort, Machine};

/// How much of a run with `--card` has passed when the part begins no more files: less than five
/// minutes in all, with time for the last file.
const PARITY_ENDS: Duration = Duration::from_secs(120);
const LOOKUPS_END: Duration = Duration::from_secs(170);
const ANSWERS_END: Duration = Duration::from_secs(200);
const RAYS_END: Duration = Duration::from_secs(250);
const LOADS_END: Duration = Duration::from_secs(270);
/// Graphics cards take a while to raise their clock.
const CARD_WARM_UP: Duration = Duration::from_millis(100);

fn main() -> Result<()> {
    let args = Args::parse();
    if args.isa_compile {
        return isa::serve();
    }
    if let Some(png) = &args.png {
        let [svg] = args.files.as_slice() else {
            bail!("--png takes one SVG file");
        };
        return tables::rasterise_to_png(svg, png);
    }
    let needs_device =
        [Part::Gpu, Part::Rays, Part::Parity, Part::Set].map(|part| args.wants(part));
    let device = needs_device
        .contains(&true)
        .then(Device::open)
        .transpose()?;
    if let Some(device) = device
        .as_ref()
        .filter(|_| args.card && !args.allow_software)
    {
        device.refuse_software()?;
    }
    let resources = system_fonts();
    let mut report = Report::begin(Machine::detect(), device.as_ref(), resources.fonts.len())?;
    let mut run = Run {
        effort: effort(&args),
        start: Instant::now(),
        paths: find(&args.files)?,
        resources,
        args,
    };
    run.measure(device.as_ref(), &mut report)?;
    let [markdown, json] = run.args.outputs();
    report.finish(markdown.as_deref(), json.as_deref())
}

fn effort(args: &Args) -> Effort {
    let [rounds, windows] = match args.card {
        true => [7, 64],
        false => [5, 4],
    };
    Effort {
        rounds: usize::from(args.rounds.unwrap_or(rounds)),
        gpu_lookups: usize::from(args.windows.unwrap_or(windows)) << 18,
        cpu_lookups: 1 << 18,
        warm_up: if args.card {
            CARD_WARM_UP
        } else {
            Duration::ZERO
        },
        deadline: None,
    }
}

/// What is measured, and on what.
struct Run {
    args: Args,
    effort: Effort,
    start: Instant,
    paths: Vec<PathBuf>,
    resources: Resources,
}

impl Run {
    fn measure(&mut self, device: Option<&Device>, report: &mut Report) -> Result<()> {
        let (paths, resources) = (&self.paths, &self.resources);
        if self.args.wants(Part::Bake) {
            self.bakes(report)?;
        }
        if self.args.wants(Part::Sizes) {
            report.add_all(tables::size_tables(paths, resources)?)?;
        }
        if self.args.wants(Part::Processes) {
            report.add_all(tables::process_tables(paths, self.effort.rounds)?)?;
        }
        if self.args.wants(Part::Isa) {
            self.instruction_sets(report)?;
        }
        if let Some(device) = device.filter(|_| self.args.wants(Part::Set)) {
            report.add_all(self.sets(device)?)?;
        }
        let lookups = [Part::Cpu, Part::Gpu, Part::Rays, Part::Parity, Part::Load];
        if !lookups.map(|part| self.args.wants(part)).contains(&true) {
            return Ok(());
        }
        let subjects: Vec<Subject> = paths
            .iter()
            .map(|path| Subject::bake(path, resources))
            .collect::<Result<_>>()?;
        if self.args.wants(Part::Cpu) {
            self.twin(&subjects, report)?;
        }
        if let Some(device) = device {
            self.gpu(device, &subjects, report)?;
        }
        if self.args.wants(Part::Load) {
            report.add(tables::load_table(&subjects, self.until(LOADS_END))?)?;
        }
        Ok(())
    }

    fn bakes(&self, report: &mut Report) -> Result<()> {
        let (paths, resources, rounds) = (&self.paths, &self.resources, self.effort.rounds);
        let cores = report.machine().cores();
        report.add(tables::stages_table(paths, resources, 1, rounds)?)?;
        if cores > 1 {
            report.add(tables::stages_table(paths, resources, cores, rounds)?)?;
        }
        Ok(())
    }

    /// Files are baked only, without their rasters: many may be named.
    fn sets(&self, device: &Device) -> Result<Vec<Table>> {
        let bake = |path: &PathBuf| Ok((name(path), bake(path, &self.resources)?));
        let files: Vec<_> = self.paths.iter().map(bake).collect::<Result<_>>()?;
        tables::set_tables(device, &files, self.effort)
    }

    /// Of the files' feature sets only when the user named files.
    fn instruction_sets(&self, report: &mut Report) -> Result<()> {
        let named: &[PathBuf] = if self.args.card {
            &[]
        } else {
            &self.args.files
        };
        let bake = |path: &PathBuf| bake(path, &self.resources);
        let files: Vec<_> = named.iter().map(bake).collect::<Result<_>>()?;
        let done = tables::add_isa_tables(report, &self.args.chips, &files);
        match self.args.only.as_slice() {
            [Part::Isa] => done.context("the only part asked for gave no table"),
            _ => done.or_else(|problem| report.say(&format!("No part isa: {problem:#}."))),
        }
    }

    fn twin(&self, subjects: &[Subject], report: &mut Report) -> Result<()> {
        let cores = report.machine().cores();
        report.add(tables::count_table(subjects, self.effort))?;
        report.add_all(tables::cpu_tables(subjects, 1, self.effort)?)?;
        if cores > 1 {
            report.add_all(tables::cpu_tables(subjects, cores, self.effort)?)?;
        }
        Ok(())
    }

    fn gpu(&self, device: &Device, subjects: &[Subject], report: &mut Report) -> Result<()> {
        if self.args.wants(Part::Parity) {
            let effort = self.until(PARITY_ENDS);
            report.add(tables::parity_table(device, subjects, effort)?)?;
        }
        if self.args.wants(Part::Gpu) {
            let effort = self.until(LOOKUPS_END);
            tables::check_queries(device)?;
            report.add(tables::sfg22_table(device, effort)?)?;
            report.add(tables::minified_table(device, effort)?)?;
            report.add(tables::fetch_table(device, effort)?)?;
            report.add_all(tables::gpu_tables(device, subjects, effort)?)?;
            let effort = self.until(ANSWERS_END);
            report.add(tables::answers_table(device, subjects, effort)?)?;
        }
        if self.args.wants(Part::Rays) {
            let effort = self.until(RAYS_END);
            let files: Vec<_> = subjects
                .iter()
                .map(|subject| (subject.name.clone(), subject.file.clone()))
                .collect();
            report.add_all(tables::staged_tables(device, &files, effort)?)?;
            let subjects: Vec<(&Path, &Subject)> = self
                .paths
                .iter()
                .map(PathBuf::as_path)
                .zip(subjects)
                .collect();
            report.add(tables::rays_table(
                device,
                &subjects,
                &self.resources,
                effort,
            )?)?;
        }
        Ok(())
    }

    /// The effort, with a deadline after `limit` of the whole run in the one mode that has one.
    fn until(&self, limit: Duration) -> Effort {
        Effort {
            deadline: self.args.card.then(|| self.start + limit),
            ..self.effort
        }
    }
}
