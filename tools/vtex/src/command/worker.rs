//! `vtex worker`: the process in which `vtex bake` bakes.

use std::io::{self, BufReader};
use std::path::Path;
use std::sync::mpsc::{self, Receiver};
use std::time::Instant;

use clap::Parser;
use vtex_baker::{BakeConfig, Resources, Stage};

use crate::baking::fonts::FontLibrary;
use crate::baking::images::ImageFolders;
use crate::baking::wire::{self, Reply, Request, Summary};
use crate::baking::{self, memory};
use crate::cli::args::{self, Bake, Cli, Command};
use crate::cli::{ExitCode, Failure, Outcome};

/// Runs `vtex worker`: bakes one drawing after another until standard input ends.
pub(super) fn run(args: &args::Worker) -> Outcome<ExitCode> {
    let name = std::ffi::OsString::from("vtex");
    let words = std::iter::once(&name).chain(&args.command_line);
    let cli = Cli::try_parse_from(words).map_err(Failure::usage)?;
    let Command::Bake(bake) = cli.command else {
        return Err(Failure::usage("only vtex bake has workers"));
    };
    limit_memory(&bake)?;
    let baker = Baker::new(&bake, cli.global.verbose)?;
    for (request, svg) in requests() {
        // Writing fails only when the parent process is gone.
        if baker.answer(&request, &svg).is_err() {
            break;
        }
    }
    Ok(ExitCode::Ok)
}

/// Limits the memory of this process. The limit counts the address space of all stacks, although
/// most of it is never touched, so the stacks come on top of `--max-memory`.
fn limit_memory(bake: &Bake) -> Outcome<()> {
    let stacks = rayon::current_num_threads() * super::STACK_BYTES;
    memory::limit((u64::from(bake.budget.max_memory) << 20) + stacks as u64)
}

/// Requests as they arrive. When standard input ends, the process exits at once, even in the middle
/// of a bake: the parent is gone, and nobody else would enforce the time limit.
fn requests() -> Receiver<(Request, Vec<u8>)> {
    let (sender, receiver) = mpsc::sync_channel(1);
    std::thread::spawn(move || {
        let mut input = BufReader::new(io::stdin());
        let mut next = || -> io::Result<(Request, Vec<u8>)> {
            let request: Request = wire::receive(&mut input)?;
            let svg = wire::receive_bytes(&mut input, request.svg_bytes)?;
            Ok((request, svg))
        };
        let error = loop {
            match next() {
                Err(error) => break error,
                Ok(request) => {
                    if sender.send(request).is_err() {
                        return;
                    }
                }
            }
        };
        std::process::exit(match error.kind() {
            io::ErrorKind::OutOfMemory => ExitCode::Limit as i32,
            _ => ExitCode::Ok as i32,
        });
    });
    receiver
}

struct Baker {
    config: BakeConfig,
    fonts: FontLibrary,
    images: ImageFolders,
    verbose: bool,
}

impl Baker {
    fn new(bake: &Bake, verbose: bool) -> Outcome<Self> {
        Ok(Self {
            config: baking::config(&bake.options),
            fonts: FontLibrary::new(bake.options.fonts.clone())?,
            images: ImageFolders::new(&bake.options.allow_images)?,
            verbose,
        })
    }

    /// Bakes one drawing and sends the result.
    fn answer(&self, request: &Request, svg: &[u8]) -> io::Result<()> {
        let mut to = io::stdout();
        match self.bake(Path::new(&request.path), svg) {
            Ok((summary, bytes)) => {
                let count = bytes.len() as u64;
                let reply = Reply::Baked {
                    bytes: count,
                    summary,
                };
                wire::send(&mut to, &reply, &bytes)
            }
            Err(failure) => wire::send(&mut to, &Reply::Failed(failure), &[]),
        }
    }

    fn bake(&self, path: &Path, svg: &[u8]) -> Outcome<(Summary, Vec<u8>)> {
        let begun = Instant::now();
        let observer = |stage: Stage| {
            if self.verbose {
                let at = begun.elapsed().as_secs_f64();
                let text = format!("{}: {at:7.3} s {stage:?}", path.display());
                // This fails only when the parent is gone; then the thread that reads standard
                // input ends the process.
                let _ = wire::send(&mut io::stdout(), &Reply::Detail(text), &[]);
            }
        };
        let images = self.images.near(path);
        let resources = Resources {
            fonts: self.fonts.for_svg(svg),
            images: images.reader(),
        };
        let file = baking::bake_with(path, svg, &self.config, &resources, &observer)?;
        let bytes = baking::to_bytes(path, &file)?;
        let mut summary = Summary::of(&file);
        images.tell(&mut summary);
        Ok((summary, bytes))
    }
}
