//! Inputs on the command line: files, folders, globs, standard input.

use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::cli::{ExitCode, Failure, Outcome};

/// Largest input that is read. No drawing comes near it; it stops reads of devices without end.
pub(crate) const MAX_INPUT_BYTES: u64 = 1 << 30;

/// One input.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Input {
    /// The path to read; `-` is standard input.
    pub(crate) path: PathBuf,
    /// Path relative to the folder on the command line, or the file name.
    pub(crate) relative: PathBuf,
    /// Whether the command line names this file itself, and not a folder or glob that holds it.
    pub(crate) named: bool,
}

impl Input {
    fn single(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            relative: path.file_name().map_or_else(|| path.into(), PathBuf::from),
            named: true,
        }
    }

    /// Whether this is standard input.
    pub(crate) fn is_stdin(&self) -> bool {
        self.path.as_os_str() == "-"
    }

    /// Reads all of it.
    ///
    /// # Errors
    /// When it cannot be read or is larger than [`MAX_INPUT_BYTES`].
    pub(crate) fn read(&self) -> Outcome<Vec<u8>> {
        read(&self.path)
    }
}

/// Reads a file, or standard input for `-`.
///
/// # Errors
/// When it cannot be read or is larger than [`MAX_INPUT_BYTES`].
pub(crate) fn read(path: &Path) -> Outcome<Vec<u8>> {
    let mut bytes = Vec::new();
    let outcome = if path.as_os_str() == "-" {
        io::stdin()
            .lock()
            .take(MAX_INPUT_BYTES + 1)
            .read_to_end(&mut bytes)
    } else {
        fs::File::open(path).and_then(|file| file.take(MAX_INPUT_BYTES + 1).read_to_end(&mut bytes))
    };
    outcome.map_err(|error| Failure::io("read", path, &error))?;
    if bytes.len() as u64 > MAX_INPUT_BYTES {
        return Err(Failure::new(
            ExitCode::Limit,
            format!(
                "{}: the file is larger than 1 GiB and was not read",
                path.display()
            ),
        ));
    }
    Ok(bytes)
}

/// The files that the arguments name, in the order of the arguments, sorted within each folder or
/// glob.
///
/// # Errors
/// When a folder cannot be listed or an argument matches nothing.
pub(crate) fn expand(arguments: &[PathBuf]) -> Outcome<Vec<Input>> {
    let mut inputs = Vec::new();
    for argument in arguments {
        let before = inputs.len();
        if argument.as_os_str() == "-" {
            inputs.push(Input::single(argument));
        } else if argument.is_dir() {
            walk(argument, argument, &mut inputs)?;
        } else if is_pattern(argument) {
            expand_glob(argument, &mut inputs)?;
        } else {
            inputs.push(Input::single(argument));
        }
        if inputs.len() == before {
            return Err(Failure::new(
                ExitCode::Io,
                format!("{}: no .svg or .svgz file found", argument.display()),
            ));
        }
        inputs[before..].sort();
    }
    Ok(inputs)
}

/// Whether the argument is a glob. A file whose name contains a bracket is not.
fn is_pattern(argument: &Path) -> bool {
    !argument.exists()
        && argument
            .to_str()
            .is_some_and(|text| text.contains(['*', '?', '[']))
}

fn is_svg(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ext| ext.eq_ignore_ascii_case("svg") || ext.eq_ignore_ascii_case("svgz"))
}

fn walk(root: &Path, folder: &Path, inputs: &mut Vec<Input>) -> Outcome<()> {
    let list = |error: io::Error| Failure::io("list", folder, &error);
    for entry in fs::read_dir(folder).map_err(list)? {
        let entry = entry.map_err(list)?;
        let path = entry.path();
        // The type of the entry itself: links to folders are not followed, so that links cannot
        // form a loop.
        if entry.file_type().map_err(list)?.is_dir() {
            walk(root, &path, inputs)?;
        } else if is_svg(&path) && path.is_file() {
            let relative = path.strip_prefix(root).unwrap_or(&path).to_owned();
            inputs.push(Input {
                path,
                relative,
                named: false,
            });
        }
    }
    Ok(())
}

fn expand_glob(pattern: &Path, inputs: &mut Vec<Input>) -> Outcome<()> {
    let text = pattern.to_string_lossy();
    let paths = glob::glob(&text)
        .map_err(|error| Failure::usage(format!("{text}: not a valid glob: {error}")))?;
    for path in paths {
        let path = path.map_err(|error| Failure::io("list", pattern, error.error()))?;
        if path.is_file() && is_svg(&path) {
            inputs.push(Input {
                named: false,
                ..Input::single(&path)
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_globs_and_files() {
        let root = tempfile::tempdir().unwrap();
        fs::create_dir(root.path().join("sub")).unwrap();
        for name in ["b.svg", "a.SVGZ", "note.txt", "sub/c.svg"] {
            fs::write(root.path().join(name), "").unwrap();
        }
        let relative = |argument: PathBuf| -> Vec<String> {
            let inputs = expand(&[argument]).unwrap();
            inputs
                .iter()
                .map(|i| i.relative.display().to_string())
                .collect()
        };
        assert_eq!(
            relative(root.path().to_owned()),
            ["a.SVGZ", "b.svg", "sub/c.svg"]
        );
        assert_eq!(relative(root.path().join("*.svg")), ["b.svg"]);
        assert_eq!(relative(root.path().join("note.txt")), ["note.txt"]);
        let failure = expand(&[root.path().join("*.x")]).unwrap_err();
        assert_eq!(failure.code, ExitCode::Io);
    }
}
