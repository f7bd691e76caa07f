//! One file through `vtex bake`, `vtex info` and `vtex compare`.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use anyhow::Result;

use super::child;
use super::options::Options;
use super::row::{Content, Row, Zoom};

/// Names of the pictures that `vtex compare --pictures` writes.
const PICTURES: [&str; 3] = ["svg.png", "vtex.png", "difference.png"];

/// What files are measured with.
pub(crate) struct Bench<'a> {
    pub(crate) vtex: &'a Path,
    pub(crate) options: &'a Options,
    /// Folder for what children write.
    pub(crate) scratch: &'a Path,
}

impl Bench<'_> {
    /// Bakes and compares a file given by its path below the corpus; `index` is its own. What goes
    /// wrong with the file stands in the row.
    pub(crate) fn measure(&self, file: &str, index: usize) -> Result<Row> {
        let folder = file.split_once('/').map_or("", |(folder, _)| folder);
        let mut row = Row {
            folder: folder.to_owned(),
            file: file.to_owned(),
            ..Row::default()
        };
        if let Err(problem) = self.fill(&mut row, index)? {
            row.error = Some(problem);
        }
        Ok(row)
    }

    fn fill(&self, row: &mut Row, index: usize) -> Result<Result<(), String>> {
        let [svg, vtex] = [self.options.folder.join(&row.file), self.baked(index)];
        let mut bake = self.command("bake", &[&svg]);
        bake.arg("-o")
            .arg(&vtex)
            .args(&self.options.bake)
            .arg("--quiet");
        let started = Instant::now();
        if let Err(problem) = self.run(&mut bake, index)? {
            return Ok(Err(problem));
        }
        row.bake_seconds = Some(started.elapsed().as_secs_f64());
        let mut info = self.command("info", &[&vtex]);
        match self.run(info.args(["--format", "json"]), index)? {
            Ok(json) => row.content = Content::parse(&json)?,
            Err(problem) => return Ok(Err(problem)),
        }
        row.skipped = self.options.only_native && !row.content.native;
        if row.skipped {
            return Ok(Ok(()));
        }
        let mut compare = self.compare(&row.file, index, &self.options.zoom_list());
        match self.run(compare.args(["--format", "json"]), index)? {
            Ok(json) => row.zooms = Zoom::parse_all(&json)?,
            Err(problem) => return Ok(Err(problem)),
        }
        self.add_noise(row, index)
    }

    /// Asks for the truth's own noise at the zooms that miss their bar.
    fn add_noise(&self, row: &mut Row, index: usize) -> Result<Result<(), String>> {
        let bars = &self.options.bars;
        for (zoom, value) in self.options.zooms.iter().enumerate() {
            if row.above_db(bars, zoom).is_none_or(|above| above >= 0.0) {
                continue;
            }
            let mut compare = self.compare(&row.file, index, &value.to_string());
            match self.run(compare.args(["--noise", "--format", "json"]), index)? {
                Ok(json) => {
                    let again = Zoom::parse_all(&json)?;
                    row.zooms.splice(zoom..=zoom, again.into_iter().take(1));
                }
                Err(problem) => return Ok(Err(problem)),
            }
        }
        Ok(Ok(()))
    }

    /// Adds pictures of the row's worst window at zoom `zoom`.
    pub(crate) fn add_pictures(&self, row: &mut Row, index: usize, zoom: f64) -> Result<()> {
        let folder = self.scratch.join(format!("{index}.pictures"));
        let mut compare = self.compare(&row.file, index, &zoom.to_string());
        compare.arg("--pictures").arg(&folder);
        if let Err(problem) = self.run(&mut compare, index)? {
            row.error = Some(problem);
            return Ok(());
        }
        for name in PICTURES {
            row.pictures.push(std::fs::read(folder.join(name))?);
        }
        Ok(())
    }

    fn compare(&self, file: &str, index: usize, zooms: &str) -> Command {
        let svg = self.options.folder.join(file);
        let mut compare = self.command("compare", &[&svg, &self.baked(index)]);
        let options = self.options;
        let [size, spp, windows] =
            [options.size, options.spp, options.windows].map(|number| number.to_string());
        compare.args(["--zoom", zooms, "--size", &size, "--spp", &spp]);
        compare.args(["--windows", &windows]);
        // What the bake sees of fonts the comparison must see.
        let mut bake = self.options.bake.iter();
        while let Some(option) = bake.next() {
            match option.as_str() {
                "--no-system-fonts" => _ = compare.arg(option),
                "--font-dir" => _ = compare.arg(option).args(bake.next()),
                _ => {}
            }
        }
        compare
    }

    fn baked(&self, index: usize) -> PathBuf {
        self.scratch.join(format!("{index}.vtex"))
    }

    /// `vtex` on one thread: files run beside each other.
    fn command(&self, name: &str, files: &[&PathBuf]) -> Command {
        let mut command = Command::new(self.vtex);
        command.arg(name).args(files);
        if name != "info" {
            command.args(["--threads", "1"]);
        }
        command
    }

    fn run(&self, command: &mut Command, index: usize) -> Result<Result<Vec<u8>, String>> {
        let scratch = self.scratch.join(index.to_string());
        let finished = child::run(command, self.options.timeout, &scratch)?;
        let step = command.get_args().next().unwrap_or_default();
        Ok(match finished.error {
            None => Ok(finished.stdout),
            Some(problem) => Err(format!("{}: {problem}", step.display())),
        })
    }
}
