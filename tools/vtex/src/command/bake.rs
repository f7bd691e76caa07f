//! `vtex bake`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use rayon::prelude::*;
use serde_json::{Value, json};
use vtex_baker::{BakeConfig, Stage};
use vtex_format::{VtexFile, Warning};

use crate::args::Bake;
use crate::baking;
use crate::cache::Cache;
use crate::console::{Console, Format, human_bytes};
use crate::failure::{ExitCode, Failure, Outcome};
use crate::fonts::FontLibrary;
use crate::input::{self, Input};
use crate::output;

/// Warnings shown for one file unless `--verbose`.
const WARNINGS_SHOWN: usize = 3;

/// Runs `vtex bake`.
pub(super) fn run(args: Bake, console: Console) -> Outcome<ExitCode> {
    let job = Job::new(&args, console)?;
    let progress = console.progress(job.pairs.len() as u64, "baking");
    let results: Vec<_> = job
        .pairs
        .par_iter()
        .map(|pair| {
            let result = job.bake_one(pair);
            progress.step();
            result
        })
        .collect();
    drop(progress);
    job.report(&results)?;
    if let Some(depfile) = &args.depfile {
        output::write(depfile, depfile_text(&job.pairs).as_bytes())?;
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

/// What came of one input.
struct Baked {
    code: ExitCode,
    summary: Value,
    line: String,
    warnings: Vec<Warning>,
}

struct Job<'a> {
    args: &'a Bake,
    console: Console,
    config: BakeConfig,
    fonts: FontLibrary,
    cache: Option<Cache>,
    pairs: Vec<Pair>,
}

impl<'a> Job<'a> {
    fn new(args: &'a Bake, console: Console) -> Outcome<Self> {
        let to_stdout = is_stdout(&args.output);
        if to_stdout && console.format == Format::Json {
            return Err(Failure::usage(
                "-o - and --format json both want standard output",
            ));
        }
        if args.check && to_stdout {
            return Err(Failure::usage(
                "--check needs files to compare with, not -o -",
            ));
        }
        let config = baking::config(&args.options)?;
        config
            .check()
            .map_err(|error| Failure::usage(error.to_string()))?;
        let pairs = pair_up(input::expand(&args.inputs)?, &args.output)?;
        Ok(Self {
            args,
            console,
            config,
            fonts: FontLibrary::new(args.options.fonts.clone())?,
            cache: args.cache_dir.as_deref().map(Cache::open).transpose()?,
            pairs,
        })
    }

    fn bake_one(&self, pair: &Pair) -> Outcome<Baked> {
        let begun = Instant::now();
        let svg = pair.input.read()?;
        let key = self
            .cache
            .as_ref()
            .map(|_| Cache::key(&svg, &self.config, &self.fonts.fingerprint(&svg)));
        let kept = self
            .cache
            .as_ref()
            .zip(key.as_ref())
            .and_then(|(cache, key)| cache.get(key));
        let cached = kept.is_some();
        let (file, bytes) = match kept {
            Some(kept) => kept,
            None => self.bake_afresh(pair, &svg)?,
        };
        if let (false, Some(cache), Some(key)) = (cached, &self.cache, &key) {
            cache.put(key, &bytes)?;
        }
        let code = self.deliver(pair, &bytes)?;
        let seconds = begun.elapsed().as_secs_f64();
        Ok(self.describe(pair, &file, &bytes, Spent { seconds, cached }, code))
    }

    fn bake_afresh(&self, pair: &Pair, svg: &[u8]) -> Outcome<(VtexFile, Vec<u8>)> {
        let path = &pair.input.path;
        let begun = Instant::now();
        let observer = |stage: Stage| {
            let at = begun.elapsed().as_secs_f64();
            self.console
                .detail(&format!("{}: {at:7.3} s {stage:?}", path.display()));
        };
        let file = baking::bake(path, svg, &self.config, &self.fonts, &observer)?;
        let bytes = baking::to_bytes(path, &file)?;
        Ok((file, bytes))
    }

    /// Writes the bytes, or with `--check` compares them with what is there.
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

    fn describe(
        &self,
        pair: &Pair,
        file: &VtexFile,
        bytes: &[u8],
        spent: Spent,
        code: ExitCode,
    ) -> Baked {
        let warnings = file
            .provenance
            .as_ref()
            .map_or_else(Vec::new, |p| p.warnings.clone());
        let (shapes, layers) = (file.shapes.len(), file.layers.len());
        let verdict = match (self.args.check, code) {
            (true, ExitCode::Ok) => "up to date: ",
            (true, _) => "missing or different, bake it again: ",
            _ => "",
        };
        let output = pair.output.display();
        let line = format!(
            "{output}: {verdict}{}, {shapes} shapes in {layers} layers, {:.2} s{}",
            human_bytes(bytes.len() as u64),
            spent.seconds,
            if spent.cached { " (cached)" } else { "" },
        );
        let summary = json!({
            "input": pair.input.path, "output": pair.output, "bytes": bytes.len(),
            "shapes": shapes, "layers": layers, "seconds": spent.seconds, "cached": spent.cached,
            "code": code as u8, "warnings": super::info::warnings_json(&warnings),
        });
        Baked {
            code,
            summary,
            line,
            warnings,
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
                        "input": pair.input.path, "code": failure.code as u8,
                        "error": failure.message,
                    }),
                });
            self.console.json(&Value::Array(files.collect()))?;
        }
        Ok(())
    }

    fn warn(&self, path: &Path, warnings: &[Warning]) {
        use crate::console::Verbosity::Verbose;
        let all = self.console.verbosity == Verbose;
        let shown = if all { warnings.len() } else { WARNINGS_SHOWN };
        for warning in warnings.iter().take(shown) {
            let text = super::info::warning_text(warning);
            self.console
                .note(&format!("{}: warning: {text}", path.display()));
        }
        if warnings.len() > shown {
            let more = warnings.len() - shown;
            self.console
                .note(&format!("{}: {more} more warnings (-v)", path.display()));
        }
    }
}

struct Spent {
    seconds: f64,
    cached: bool,
}

fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Decides where each input goes.
fn pair_up(inputs: Vec<Input>, out: &Path) -> Outcome<Vec<Pair>> {
    let alone = matches!(inputs.as_slice(), [input] if input.named);
    if is_stdout(out) && !alone {
        return Err(Failure::usage("-o - takes one input"));
    }
    let into_folder = !is_stdout(out) && (!alone || out.is_dir() || ends_with_slash(out));
    let mut pairs: Vec<Pair> = Vec::with_capacity(inputs.len());
    for mut input in inputs {
        if into_folder && input.is_stdin() {
            return Err(Failure::usage("standard input needs a file name after -o"));
        }
        // In a folder that a bake fills, missing folders are made.
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

fn ends_with_slash(path: &Path) -> bool {
    path.to_string_lossy().ends_with(std::path::MAIN_SEPARATOR)
}

/// One Makefile rule a file, and one without recipe for each input, so that a removed input does
/// not stop make.
fn depfile_text(pairs: &[Pair]) -> String {
    let mut text = String::new();
    for pair in pairs.iter().filter(|pair| !pair.input.is_stdin()) {
        let [output, input] = [&pair.output, &pair.input.path].map(|path| escape(path));
        // Writing to a String does not fail.
        let _ = writeln!(text, "{output}: {input}\n{input}:");
    }
    text
}

/// As make reads names: blanks and `#` with a backslash, `$` doubled.
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
