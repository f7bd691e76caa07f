//! `vtex bake`.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use serde_json::{Value, json};
use vtex_baker::BakeConfig;
use vtex_format::Warning;
use vtex_truth::comparison::human_bytes;

use crate::baking;
use crate::baking::cache::Cache;
use crate::baking::fonts::FontLibrary;
use crate::baking::images::ImageFolders;
use crate::baking::wire::Summary;
use crate::baking::workers::Workers;
use crate::cli::args::Bake;
use crate::cli::{Console, ExitCode, Failure, Format, Outcome, counted};
use crate::files::input::{self, Input};
use crate::files::{lossy, output};

/// Most warnings printed for one file without `--verbose`.
const WARNINGS_SHOWN: usize = 3;

/// Runs `vtex bake`.
pub(super) fn run(args: Bake, console: Console) -> Outcome<ExitCode> {
    let job = Job::new(&args, console)?;
    let results = job.bake_all();
    job.report(&results)?;
    if let Some(depfile) = &args.depfile {
        let text = depfile_text(job.pairs.iter().zip(&results));
        output::write(depfile, text.as_bytes())?;
    }
    let codes = results
        .iter()
        .map(|result| result.as_ref().map_or_else(|f| f.code, |b| b.code));
    Ok(codes.max().unwrap_or(ExitCode::Ok))
}

/// An input and where its bake goes.
struct Pair {
    input: Input,
    output: PathBuf,
}

/// The result for one input.
struct Baked {
    code: ExitCode,
    summary: Value,
    line: String,
    warnings: Vec<Warning>,
    /// Other files that the bake read, such as images.
    files: Vec<PathBuf>,
}

struct Job<'a> {
    args: &'a Bake,
    console: Console,
    config: BakeConfig,
    fonts: FontLibrary,
    cache: Option<Cache>,
    pairs: Vec<Pair>,
    /// Number of files baked at the same time.
    lanes: usize,
    workers: Workers,
}

impl<'a> Job<'a> {
    fn new(args: &'a Bake, console: Console) -> Outcome<Self> {
        let to_stdout = is_stdout(&args.output);
        if to_stdout && console.format == Format::Json {
            return Err(Failure::usage(
                "-o - and --format json cannot both write to standard output",
            ));
        }
        if args.check && to_stdout {
            return Err(Failure::usage(
                "--check compares with files, so -o cannot be -",
            ));
        }
        let config = baking::checked_config(&args.options)?;
        let pairs = pair_up(input::expand(&args.inputs)?, &args.output)?;
        keep_inputs(&pairs, args.depfile.as_deref())?;
        check_outputs(args, &pairs)?;
        // Checked here too, so that a missing folder is reported once and not by every worker.
        ImageFolders::new(&args.options.allow_images)?;
        let threads = rayon::current_num_threads();
        let lanes = threads.min(pairs.len()).max(1);
        Ok(Self {
            args,
            console,
            config,
            fonts: FontLibrary::new(args.options.fonts.clone())?,
            cache: args.cache_dir.as_deref().map(Cache::open).transpose()?,
            pairs,
            lanes,
            workers: Workers::new(args.budget, threads / lanes),
        })
    }

    /// Bakes every pair; results are in the order of the pairs.
    fn bake_all(&self) -> Vec<Outcome<Baked>> {
        let progress = self.console.progress(self.pairs.len() as u64, "baking");
        let order = self.largest_first();
        let next = AtomicUsize::new(0);
        let results: Vec<OnceLock<Outcome<Baked>>> =
            self.pairs.iter().map(|_| OnceLock::new()).collect();
        let lane = || {
            while let Some(&index) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
                results[index].get_or_init(|| self.bake_one(&self.pairs[index]));
                progress.step();
            }
        };
        // A lane blocks until its worker process answers. Threads of the pool must not block, so
        // lanes are threads of their own.
        std::thread::scope(|scope| {
            for _ in 0..self.lanes {
                scope.spawn(lane);
            }
        });
        let missing = || Err(Failure::runtime("internal error: a file was skipped"));
        results
            .into_iter()
            .map(|result| result.into_inner().unwrap_or_else(missing))
            .collect()
    }

    /// Indices of the pairs, the largest input first: a large file that started last would keep one
    /// lane busy after all others have finished.
    fn largest_first(&self) -> Vec<usize> {
        let bytes = |pair: &Pair| fs::metadata(&pair.input.path).map_or(0, |file| file.len());
        let sizes: Vec<u64> = self.pairs.iter().map(bytes).collect();
        let mut order: Vec<usize> = (0..sizes.len()).collect();
        order.sort_by_key(|&index| std::cmp::Reverse(sizes[index]));
        order
    }

    fn bake_one(&self, pair: &Pair) -> Outcome<Baked> {
        let begun = Instant::now();
        let svg = pair.input.read()?;
        let key = self.cache.as_ref().map(|_| self.cache_key(&svg));
        let kept = self
            .cache
            .as_ref()
            .zip(key.as_ref())
            .and_then(|(cache, key)| cache.get(key));
        let cached = kept.is_some();
        let (summary, bytes) = match kept {
            Some((file, bytes)) => (Summary::of(&file), bytes),
            None => {
                let detail = |text: &str| self.console.detail(text);
                let baked = self.workers.bake(&pair.input.path, &svg, &detail)?;
                (baked.summary, baked.bytes)
            }
        };
        if let (false, Some(cache), Some(key)) = (cached, &self.cache, &key)
            // The key holds the bytes of the SVG only, not those of other files that it names.
            && !summary.names_files
        {
            cache.put(key, &bytes)?;
        }
        let code = self.deliver(pair, &bytes)?;
        let seconds = begun.elapsed().as_secs_f64();
        let spent = Spent {
            seconds,
            cached,
            bytes: bytes.len(),
        };
        Ok(self.describe(pair, summary, spent, code))
    }

    /// The key says whether image files are allowed, since an SVG that names some bakes differently
    /// without them. Bakes that read image files are not kept at all.
    fn cache_key(&self, svg: &[u8]) -> String {
        let images = match self.args.options.allow_images.as_slice() {
            [] => "",
            _ => "with images ",
        };
        let besides = format!("{images}{}", self.fonts.fingerprint(svg));
        Cache::key(svg, &self.config, &besides)
    }

    /// Writes the bytes, or compares them with the existing file for `--check`.
    fn deliver(&self, pair: &Pair, bytes: &[u8]) -> Outcome<ExitCode> {
        if self.args.check {
            let same = input::read(&pair.output).is_ok_and(|there| there == bytes);
            return Ok(if same {
                ExitCode::Ok
            } else {
                ExitCode::Difference
            });
        }
        if is_stdout(&pair.output) {
            self.console.result(bytes)?;
            return Ok(ExitCode::Ok);
        }
        if !pair.input.named
            && let Some(folder) = pair.output.parent()
        {
            output::create_folder(folder)?;
        }
        output::write(&pair.output, bytes)?;
        Ok(ExitCode::Ok)
    }

    fn describe(&self, pair: &Pair, summary: Summary, spent: Spent, code: ExitCode) -> Baked {
        let Spent {
            seconds,
            cached,
            bytes,
        } = spent;
        let (shapes, layers) = (summary.shapes, summary.layers);
        let files = summary.paths();
        let verdict = match (self.args.check, code) {
            (true, ExitCode::Ok) => "up to date: ",
            (true, _) => "missing or different; bake it again. A new bake has ",
            _ => "",
        };
        let output = pair.output.display();
        let line = format!(
            "{output}: {verdict}{}, {} in {}, {seconds:.2} s{}",
            human_bytes(bytes as u64),
            counted(shapes, "shape"),
            counted(layers, "layer"),
            if cached { " (cached)" } else { "" },
        );
        let warnings = summary.warnings;
        let summary = json!({
            "input": lossy(&pair.input.path), "output": lossy(&pair.output), "bytes": bytes,
            "shapes": shapes, "layers": layers, "seconds": seconds, "cached": cached,
            "code": code as u8, "warnings": super::info::warnings_json(&warnings),
        });
        Baked {
            code,
            summary,
            line,
            warnings,
            files,
        }
    }

    fn report(&self, results: &[Outcome<Baked>]) -> Outcome<()> {
        for (pair, result) in self.pairs.iter().zip(results) {
            match result {
                Ok(baked) => {
                    self.warn(&pair.input.path, &baked.warnings);
                    if baked.code == ExitCode::Difference {
                        self.console.failure(&Failure::new(baked.code, &baked.line));
                    } else {
                        self.console.note(&baked.line);
                    }
                }
                Err(failure) => self.console.failure(failure),
            }
        }
        let failed = results.iter().filter(|result| result.is_err()).count();
        if results.len() > 1 {
            let baked = results.len() - failed;
            self.console.note(&format!(
                "{baked} of {} baked, {failed} failed",
                results.len()
            ));
        }
        if self.console.format == Format::Json {
            let files = self
                .pairs
                .iter()
                .zip(results)
                .map(|(pair, result)| match result {
                    Ok(baked) => baked.summary.clone(),
                    Err(failure) => json!({
                        "input": lossy(&pair.input.path), "code": failure.code as u8,
                        "error": failure.message,
                    }),
                });
            self.console.json(&Value::Array(files.collect()))?;
        }
        Ok(())
    }

    fn warn(&self, path: &Path, warnings: &[Warning]) {
        use crate::cli::Verbosity::Verbose;
        let all = self.console.verbosity == Verbose;
        let shown = if all { warnings.len() } else { WARNINGS_SHOWN };
        for warning in warnings.iter().take(shown) {
            let text = super::info::warning_text(warning);
            self.console
                .note(&format!("{}: warning: {text}", path.display()));
        }
        if warnings.len() > shown {
            let more = counted(warnings.len() - shown, "more warning");
            self.console
                .note(&format!("{}: {more}; -v prints all", path.display()));
        }
    }
}

struct Spent {
    seconds: f64,
    cached: bool,
    /// Size of the bake.
    bytes: usize,
}

fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Finds the output path of each input.
fn pair_up(inputs: Vec<Input>, out: &Path) -> Outcome<Vec<Pair>> {
    let alone = matches!(inputs.as_slice(), [input] if input.named);
    if is_stdout(out) && !alone {
        return Err(Failure::usage(
            "-o - takes one input file, and no folder or glob",
        ));
    }
    let into_folder = !is_stdout(out) && (!alone || out.is_dir() || ends_with_slash(out));
    let mut pairs: Vec<Pair> = Vec::with_capacity(inputs.len());
    for mut input in inputs {
        if into_folder && input.is_stdin() {
            return Err(Failure::usage("when the input is -, -o must name a file"));
        }
        // Missing folders are created for outputs in a folder, not for an output named by itself.
        input.named &= !into_folder;
        let output = match into_folder {
            true => out.join(&input.relative).with_extension("vtex"),
            false => out.to_owned(),
        };
        pairs.push(Pair { input, output });
    }
    let mut outputs: Vec<_> = pairs.iter().map(|pair| &pair.output).collect();
    outputs.sort();
    match outputs.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(twice) => Err(Failure::usage(format!(
            "two inputs would be written to {}; bake them into different folders",
            twice[0].display()
        ))),
        None => Ok(pairs),
    }
}

/// Checks before the work what will be written by name. Outputs in a folder are left to the work:
/// it makes missing folders, and one bad output stops no other.
fn check_outputs(args: &Bake, pairs: &[Pair]) -> Outcome<()> {
    for pair in pairs {
        if pair.input.named && !args.check && !is_stdout(&pair.output) {
            output::check(&pair.output)?;
        }
    }
    let Some(depfile) = &args.depfile else {
        return Ok(());
    };
    let folder = depfile.parent().unwrap_or(Path::new(""));
    let comes = |pair: &Pair| !pair.input.named && pair.output.starts_with(folder);
    match folder.exists() || !pairs.iter().any(comes) {
        true => output::check(depfile),
        false => Ok(()),
    }
}

fn ends_with_slash(path: &Path) -> bool {
    path.to_string_lossy().ends_with(std::path::MAIN_SEPARATOR)
}

/// Refuses outputs, the depfile among them, that would overwrite an input or each other.
fn keep_inputs(pairs: &[Pair], depfile: Option<&Path>) -> Outcome<()> {
    let inputs = output::taken(pairs.iter().map(|pair| pair.input.path.as_path()));
    for pair in pairs {
        output::keep_apart(&pair.output, &inputs)?;
    }
    let Some(depfile) = depfile else {
        return Ok(());
    };
    output::keep_apart(depfile, &inputs)?;
    if pairs.iter().any(|pair| pair.output == depfile) {
        let name = depfile.display();
        return Err(Failure::usage(format!(
            "{name} is named as output and as --depfile; give them different names"
        )));
    }
    Ok(())
}

/// One Makefile rule for each output, and a rule without recipe for each input: without that, make
/// stops with an error when an input was removed.
fn depfile_text<'a>(bakes: impl Iterator<Item = (&'a Pair, &'a Outcome<Baked>)>) -> String {
    let mut text = String::new();
    let mut inputs = BTreeSet::new();
    for (pair, baked) in bakes {
        let own = (!pair.input.is_stdin()).then_some(&pair.input.path);
        let others = baked.as_ref().map_or(&[][..], |baked| &baked.files);
        for input in own.into_iter().chain(others) {
            let [output, input] = [&pair.output, input].map(|path| escape(path));
            // Writing to a String does not fail.
            let _ = writeln!(text, "{output}: {input}");
            if inputs.insert(input.clone()) {
                let _ = writeln!(text, "{input}:");
            }
        }
    }
    text
}

/// A path as make reads it: a backslash before blanks and `#`, `$` doubled.
fn escape(path: &Path) -> String {
    let mut text = String::new();
    for c in path.to_string_lossy().chars() {
        match c {
            ' ' | '#' | '\\' => text.extend(['\\', c]),
            '$' => text.push_str("$$"),
            _ => text.push(c),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(relative: &str) -> Input {
        Input {
            path: Path::new("in").join(relative),
            relative: relative.into(),
            named: false,
        }
    }

    #[test]
    fn folders_are_mirrored_and_collisions_refused() {
        let pairs = pair_up(vec![input("a.svg"), input("x/b.svgz")], Path::new("out")).unwrap();
        let outputs: Vec<_> = pairs
            .iter()
            .map(|pair| pair.output.to_str().unwrap())
            .collect();
        assert_eq!(outputs, ["out/a.vtex", "out/x/b.vtex"]);
        let clash = pair_up(vec![input("a.svg"), input("a.svgz")], Path::new("out"));
        assert_eq!(clash.err().unwrap().code, ExitCode::Usage);
    }

    #[test]
    fn make_reads_odd_names() {
        assert_eq!(escape(Path::new("a b#$c")), "a\\ b\\#$$c");
    }
}
