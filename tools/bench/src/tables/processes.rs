//! Whole processes side by side: `vtex bake`, and resvg rasterising the same file.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, ensure};
use vtex_baker::Resources;

use crate::report::{Cell, Table};
use crate::subject::{RASTER_SIZE, name, parse, read, render, system_fonts};
use crate::timing::{Spread, Trial, interleave};

/// What the rival prints, in this order.
const RIVAL_STAGES: [&str; 4] = ["parse", "render", "encode", "write"];

/// The whole work of the rival: parse, render, encode, write. Like a bake it loads the system fonts
/// only when the file may hold text.
pub(crate) fn rasterise_to_png(svg: &Path, png: &Path) -> Result<()> {
    let mut marks = vec![Instant::now()];
    let bytes = read(svg)?;
    let has_text = bytes.windows(5).any(|part| part == b"<text");
    let resources = if has_text {
        system_fonts()
    } else {
        Resources::default()
    };
    let tree = parse(&bytes, &resources)?;
    marks.push(Instant::now());
    let pixmap = render(&tree, RASTER_SIZE)?;
    marks.push(Instant::now());
    let encoded = pixmap.encode_png().context("cannot encode a PNG")?;
    marks.push(Instant::now());
    fs::write(png, encoded).with_context(|| format!("cannot write {}", png.display()))?;
    marks.push(Instant::now());
    let milliseconds = marks
        .windows(2)
        .map(|pair| format!("{}", (pair[1] - pair[0]).as_secs_f64() * 1e3));
    let line = milliseconds.collect::<Vec<_>>().join(" ");
    writeln!(std::io::stdout(), "{line}").context("cannot print")
}

/// Milliseconds from start to exit of `vtex bake` on one thread and on all, and of the rival.
pub(crate) fn process_tables(files: &[PathBuf], rounds: usize) -> Result<Vec<Table>> {
    let programs = Programs::find()?;
    let png = format!("resvg, PNG {RASTER_SIZE}^2");
    let mut whole = Table::new(
        "Whole processes",
        &["ms", "bake", "bake, 1 thread", &png, "KB, PNG"],
    );
    whole.note(
        "From start to exit, files read and written, in turn within each round. resvg renders and encodes on \
         one thread. The ratio says how many times as fast as the bake on all threads that is.",
    );
    let mut columns = vec!["ms"];
    columns.extend(RIVAL_STAGES);
    let mut stages = Table::new("Where resvg's time goes", &columns);
    stages.note("Medians. Those of a bake stand in the table of its stages.");
    for path in files {
        let (row, rival) = rows(path, &programs, rounds)?;
        whole.row(row);
        stages.row(rival);
    }
    Ok(vec![whole, stages])
}

/// The programs and a folder for what they write, which is removed in the end.
struct Programs {
    vtex: PathBuf,
    rival: PathBuf,
    folder: PathBuf,
}

impl Programs {
    fn find() -> Result<Self> {
        let rival = std::env::current_exe().context("cannot find this program")?;
        let vtex = rival.with_file_name(format!("vtex{}", std::env::consts::EXE_SUFFIX));
        ensure!(
            vtex.is_file(),
            "{} is not there: cargo build --release --workspace",
            vtex.display()
        );
        let folder = std::env::temp_dir().join(format!("vtex-bench-{}", std::process::id()));
        fs::create_dir_all(&folder)
            .with_context(|| format!("cannot create {}", folder.display()))?;
        Ok(Self {
            vtex,
            rival,
            folder,
        })
    }

    fn bake(&self, svg: &Path, threads: usize) -> Result<Duration> {
        let mut command = Command::new(&self.vtex);
        command.arg("bake").arg(svg).arg("-q");
        command.arg("-o").arg(self.folder.join("out.vtex"));
        command.arg("--threads").arg(threads.to_string());
        Ok(run(&mut command)?.0)
    }

    fn rasterise(&self, svg: &Path) -> Result<(Duration, String)> {
        let mut command = Command::new(&self.rival);
        command.arg(svg).arg("--png").arg(self.png());
        run(&mut command)
    }

    fn png(&self) -> PathBuf {
        self.folder.join("out.png")
    }
}

impl Drop for Programs {
    fn drop(&mut self) {
        // What is left behind lies in the folder for temporary files.
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// From start to exit, and what was printed.
fn run(command: &mut Command) -> Result<(Duration, String)> {
    let start = Instant::now();
    let output = command
        .stdin(Stdio::null())
        .stderr(Stdio::inherit())
        .output()
        .with_context(|| format!("cannot run {}", command.get_program().display()))?;
    let time = start.elapsed();
    ensure!(output.status.success(), "{command:?}: {}", output.status);
    Ok((time, String::from_utf8_lossy(&output.stdout).into_owned()))
}

fn rows(path: &Path, programs: &Programs, rounds: usize) -> Result<(Vec<Cell>, Vec<Cell>)> {
    let name = name(path);
    let mut printed = Vec::new();
    let trials = vec![
        Trial::timed(1, || programs.bake(path, 0)),
        Trial::timed(1, || programs.bake(path, 1)),
        Trial::timed(1, || {
            let (time, line) = programs.rasterise(path)?;
            printed.push(line);
            Ok(time)
        }),
    ];
    let timings = interleave(trials, rounds)?;
    let png_bytes = fs::metadata(programs.png())?.len();
    let measured = |index: usize, ratio| Cell::Measured {
        value: timings[index].milliseconds(),
        ratio,
    };
    let row = vec![
        Cell::Text(name.clone()),
        measured(0, None),
        measured(1, Some(timings[1].speed_against(&timings[0]))),
        measured(2, Some(timings[2].speed_against(&timings[0]))),
        Cell::Number(png_bytes as f64 / 1000.0, 0),
    ];
    // The first run was the warm-up.
    let lines: Vec<Vec<f64>> = printed[1..]
        .iter()
        .map(|line| {
            line.split(' ')
                .filter_map(|n| n.trim().parse().ok())
                .collect()
        })
        .collect();
    let mut rival = vec![Cell::Text(name)];
    for stage in 0..RIVAL_STAGES.len() {
        let times = lines.iter().filter_map(|line| line.get(stage).copied());
        rival.push(Cell::Number(Spread::of(times).median, 1));
    }
    Ok((row, rival))
}
