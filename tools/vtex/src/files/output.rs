//! Writing files: each is written completely or not at all.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use vtex_truth::comparison::Page;

use crate::cli::{ExitCode, Failure, Outcome};

/// Writes `bytes` to `path`. The bytes go to a temporary file in the same folder, which is then
/// renamed to `path`: no reader ever sees half a file, and a failure leaves the old file in place.
/// Devices and pipes are written directly.
///
/// # Errors
/// When the folder is missing or the file cannot be written.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Outcome<()> {
    let target = resolve(path);
    if is_device(path, &target)? {
        return fs::OpenOptions::new()
            .write(true)
            .open(&target)
            .and_then(|mut device| device.write_all(bytes).and_then(|()| device.flush()))
            .map_err(|error| Failure::io("write", path, &error));
    }
    replace(&target, bytes).map_err(|error| explain(path, &target, &error))
}

/// Checks that [`write()`] can write to `path`, before work whose result would be lost otherwise.
/// Nothing is left behind.
///
/// # Errors
/// Those of [`write()`] that can be foreseen.
pub(crate) fn check(path: &Path) -> Outcome<()> {
    let target = resolve(path);
    if is_device(path, &target)? {
        return Ok(());
    }
    // Only an attempt tells whether the system allows it.
    tempfile_for(&target)
        .map(drop)
        .map_err(|error| explain(path, &target, &error))
}

/// Whether `target`, to which the links of `path` lead, exists and is no file but a device or a
/// pipe.
fn is_device(path: &Path, target: &Path) -> Outcome<bool> {
    match fs::metadata(target) {
        Ok(existing) if existing.is_dir() => Err(Failure::new(
            ExitCode::Io,
            format!("{}: this is a folder; name a file", path.display()),
        )),
        Ok(existing) => Ok(!existing.is_file()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(Failure::io("write", path, &error)),
    }
}

/// Follows links, so that writing to a link replaces its target and not the link. The target need
/// not exist.
fn resolve(path: &Path) -> PathBuf {
    /// As many links as Linux follows; more are a loop.
    const MAX_LINKS: usize = 40;
    let mut target = path.to_owned();
    for _ in 0..MAX_LINKS {
        match fs::read_link(&target) {
            Ok(next) => target = folder_of(&target).join(next),
            Err(_) => break,
        }
    }
    fs::canonicalize(&target).unwrap_or(target)
}

/// Files that a command must not write to, without links.
pub(crate) fn taken<'a>(paths: impl IntoIterator<Item = &'a Path>) -> BTreeSet<PathBuf> {
    paths.into_iter().map(resolve).collect()
}

/// Refuses an output that is one of the files that the command reads or writes otherwise.
///
/// # Errors
/// When `output` is an existing file in `taken`.
pub(crate) fn keep_apart(output: &Path, taken: &BTreeSet<PathBuf>) -> Outcome<()> {
    let target = resolve(output);
    // Devices and pipes may be read and written.
    if target.is_file() && taken.contains(&target) {
        let name = output.display();
        return Err(Failure::usage(format!(
            "{name} is an input too and would be overwritten; name another output"
        )));
    }
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = tempfile_for(path)?;
    file.write_all(bytes)?;
    file.flush()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// A temporary file that can be renamed to `path`.
fn tempfile_for(path: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".vtex-").suffix(".tmp");
    let permissions = fs::metadata(path)
        .ok()
        .map(|existing| existing.permissions());
    #[cfg(unix)]
    let permissions = permissions.or_else(|| {
        use std::os::unix::fs::PermissionsExt;
        // The mode that `File::create` uses, from which the umask is subtracted. Temporary files are
        // private otherwise.
        Some(fs::Permissions::from_mode(0o666))
    });
    if let Some(permissions) = permissions.filter(|p| !p.readonly()) {
        builder.permissions(permissions);
    }
    builder.tempfile_in(folder_of(path))
}

/// The failure to write to `path`, whose links lead to `target`.
fn explain(path: &Path, target: &Path, error: &io::Error) -> Failure {
    let folder = folder_of(target);
    if error.kind() == io::ErrorKind::NotFound && !folder.is_dir() {
        return Failure::new(
            ExitCode::Io,
            format!(
                "{}: the folder {} does not exist; create it first",
                path.display(),
                folder.display()
            ),
        );
    }
    Failure::io("write", path, error)
}

/// Writes a page into `folder`, the pictures before the text that shows them.
///
/// # Errors
/// When the folder cannot be created, or a file cannot be written or is one of `taken`.
pub(crate) fn write_page(folder: &Path, page: Page, taken: &BTreeSet<PathBuf>) -> Outcome<()> {
    for file in page.finish() {
        let path = folder.join(&file.name);
        create_folder(folder_of(&path))?;
        write_apart(&path, &file.bytes, taken)?;
    }
    Ok(())
}

/// Writes a file that the user has not named, in a folder that may hold anything.
///
/// # Errors
/// As [`keep_apart`] and [`write`].
pub(crate) fn write_apart(path: &Path, bytes: &[u8], taken: &BTreeSet<PathBuf>) -> Outcome<()> {
    keep_apart(path, taken)?;
    write(path, bytes)
}

/// Creates a folder and those above it.
///
/// # Errors
/// When it cannot be created.
pub(crate) fn create_folder(path: &Path) -> Outcome<()> {
    fs::create_dir_all(path).map_err(|error| match path.is_file() {
        true => Failure::new(
            ExitCode::Io,
            format!(
                "{}: this is a file; name a folder for several outputs",
                path.display()
            ),
        ),
        false => Failure::io("create the folder", path, &error),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_leaves_no_file_and_names_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        let failure = write(&folder.path().join("no/such/x.vtex"), b"x").unwrap_err();
        assert_eq!(failure.code, ExitCode::Io, "{failure}");
        assert!(failure.message.contains("does not exist"), "{failure}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn an_existing_file_is_replaced_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x");
        write(&path, b"a long first version").unwrap();
        write(&path, b"short").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"short");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn an_output_is_no_input() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.svg");
        write(&path, b"a drawing").unwrap();
        let same = folder
            .path()
            .join("../")
            .join(folder.path().file_name().unwrap());
        let inputs = taken([path.as_path(), Path::new("-")]);
        let failure = keep_apart(&same.join("x.svg"), &inputs).unwrap_err();
        assert_eq!(failure.code, ExitCode::Usage, "{failure}");
        keep_apart(&folder.path().join("y.svg"), &inputs).unwrap();
        keep_apart(Path::new("-"), &inputs).unwrap();
    }

    #[test]
    fn what_cannot_be_written_is_known_before() {
        let folder = tempfile::tempdir().unwrap();
        let inside = |name: &str| folder.path().join(name);
        for path in [inside("no/such/x"), folder.path().to_owned()] {
            let failure = check(&path).unwrap_err();
            assert_eq!(failure, write(&path, b"x").unwrap_err());
        }
        check(&inside("x")).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_and_lead_to_what_is_written() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let inside = |name: &str| folder.path().join(name);
        fs::create_dir(inside("far")).unwrap();
        symlink("second", inside("first")).unwrap();
        symlink("far/file", inside("second")).unwrap();
        // First the target is missing, then it exists.
        for bytes in [b"new", b"old"] {
            write(&inside("first"), bytes).unwrap();
            assert_eq!(fs::read(inside("far/file")).unwrap(), bytes);
            for link in ["first", "second"] {
                assert!(inside(link).is_symlink(), "{link} was replaced");
            }
        }
        symlink("loop", inside("loop")).unwrap();
        check(&inside("loop")).unwrap_err();
        write(&inside("loop"), b"x").unwrap_err();
        assert!(inside("loop").is_symlink(), "the loop was replaced");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_reported_and_not_renamed_over() {
        use std::os::unix::fs::FileTypeExt;
        let failure = write(Path::new("/dev/full"), b"x").unwrap_err();
        assert_eq!(failure.code, ExitCode::Io, "{failure}");
        let device = fs::metadata("/dev/full").unwrap();
        assert!(device.file_type().is_char_device());
    }
}
