//! Image files that an SVG names: read only from the folders that the user allowed.

use std::collections::BTreeSet;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use vtex_baker::ImageReader;

use super::wire::Summary;
use crate::cli::{ExitCode, Failure, Outcome};

/// Largest image file that is read; larger ones are left out with a warning.
const MAX_IMAGE_BYTES: u64 = 256 << 20;

/// Folders whose images may be read, also from folders inside them.
#[derive(Clone, Debug, Default)]
pub(crate) struct ImageFolders {
    /// Absolute, links resolved.
    folders: Arc<Vec<PathBuf>>,
}

impl ImageFolders {
    /// Resolves the folders.
    ///
    /// # Errors
    /// When one does not exist.
    pub(crate) fn new(folders: &[PathBuf]) -> Outcome<Self> {
        let resolve = |folder: &PathBuf| match fs::canonicalize(folder) {
            Ok(resolved) if resolved.is_dir() => Ok(resolved),
            _ => {
                let message = format!("{}: this image folder does not exist", folder.display());
                Err(Failure::new(ExitCode::Io, message))
            }
        };
        let folders: Outcome<Vec<_>> = folders.iter().map(resolve).collect();
        Ok(Self {
            folders: Arc::new(folders?),
        })
    }

    /// Images of the SVG at `path`. References are relative to its folder, and to the current folder
    /// for an SVG from standard input.
    pub(crate) fn near(&self, path: &Path) -> SvgImages {
        SvgImages {
            folders: Arc::clone(&self.folders),
            base: path.parent().unwrap_or(Path::new("")).to_owned(),
            seen: Arc::default(),
        }
    }
}

/// The images that one SVG names.
#[derive(Debug)]
pub(crate) struct SvgImages {
    folders: Arc<Vec<PathBuf>>,
    base: PathBuf,
    seen: Arc<Mutex<Seen>>,
}

#[derive(Debug, Default)]
struct Seen {
    files: BTreeSet<PathBuf>,
    named: bool,
}

impl SvgImages {
    /// The reader that the baker calls; `None` when no folder is allowed.
    pub(crate) fn reader(&self) -> Option<ImageReader> {
        if self.folders.is_empty() {
            return None;
        }
        let (folders, base, seen) = (
            Arc::clone(&self.folders),
            self.base.clone(),
            Arc::clone(&self.seen),
        );
        Some(ImageReader::new(move |reference| {
            let mut seen = seen.lock().unwrap_or_else(PoisonError::into_inner);
            seen.named = true;
            let file = find(reference, &base, &folders)?;
            let bytes = read(&file)?;
            seen.files.insert(file);
            Ok(bytes)
        }))
    }

    /// Adds the files that were read to the summary of the bake.
    pub(crate) fn tell(&self, summary: &mut Summary) {
        let seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        summary.names_files = seen.named;
        summary.files = seen.files.iter().map(Into::into).collect();
    }
}

/// The file that a reference means. Links and `..` are resolved before the path is compared with
/// the allowed folders, so that neither leads out of them.
fn find(reference: &str, base: &Path, folders: &[PathBuf]) -> Result<PathBuf, String> {
    let path = local_path(reference)?;
    // One message for files that are missing and files that are not allowed: otherwise an SVG could
    // find out which files exist on this machine.
    let refused = || "no such file below a folder of --allow-images".to_owned();
    let file = fs::canonicalize(base.join(path)).map_err(|_| refused())?;
    if folders.iter().any(|folder| file.starts_with(folder)) {
        Ok(file)
    } else {
        Err(refused())
    }
}

/// The path in a URL reference.
fn local_path(reference: &str) -> Result<PathBuf, String> {
    let path = match reference.split_once("://") {
        Some((scheme, rest)) if scheme.eq_ignore_ascii_case("file") => {
            rest.strip_prefix("localhost").unwrap_or(rest)
        }
        Some(_) => return Err("nothing is read from the network".to_owned()),
        None => reference,
    };
    // `//host/x` names a host in a URL, and on Windows a file on another machine.
    let slashes = |c: char| matches!(c, '/' | '\\');
    if path.starts_with(slashes) && path[1..].starts_with(slashes) {
        return Err("nothing is read from the network".to_owned());
    }
    Ok(PathBuf::from(percent_decoded(path)))
}

/// Replaces `%20` and so on by the characters they stand for; returns the text unchanged when the
/// result is not UTF-8.
fn percent_decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        let code = match (first, tail) {
            (b'%', [high, low, ..]) => hex(*high).zip(hex(*low)),
            _ => None,
        };
        match code {
            Some((high, low)) => {
                bytes.push(high << 4 | low);
                rest = &tail[2..];
            }
            None => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8(bytes).unwrap_or_else(|_| text.to_owned())
}

fn hex(digit: u8) -> Option<u8> {
    char::from(digit)
        .to_digit(16)
        .and_then(|value| u8::try_from(value).ok())
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    let cannot = |error: std::io::Error| format!("cannot read: {error}");
    // Reading a pipe or a device may never end.
    if !fs::metadata(path).map_err(cannot)?.is_file() {
        return Err("not a file".to_owned());
    }
    let mut bytes = Vec::new();
    let file = fs::File::open(path).map_err(cannot)?;
    file.take(MAX_IMAGE_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(cannot)?;
    if bytes.len() as u64 > MAX_IMAGE_BYTES {
        return Err("the file is too large".to_owned());
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_are_urls() {
        let path = |reference| local_path(reference).unwrap();
        assert_eq!(path("a%20b/c.png"), Path::new("a b/c.png"));
        assert_eq!(path("file:///x/%zz"), Path::new("/x/%zz"));
        assert_eq!(path("FILE://localhost/x"), Path::new("/x"));
        assert_eq!(path("100%"), Path::new("100%"));
        for reference in [
            "http://h/x.png",
            "https://h/x",
            "//h/x.png",
            "\\\\h\\x",
            "file:////h/x",
            "ftp://h/x",
        ] {
            assert!(local_path(reference).is_err(), "{reference}");
        }
    }

    #[test]
    fn only_files_below_the_folder_are_found() {
        let root = tempfile::tempdir().unwrap();
        let base = root.path().join("svg");
        fs::create_dir_all(base.join("images")).unwrap();
        fs::create_dir_all(root.path().join("images-2")).unwrap();
        for name in ["svg/images/in.png", "svg/out.png", "images-2/out.png"] {
            fs::write(root.path().join(name), name).unwrap();
        }
        let allowed = ImageFolders::new(&[base.join("images")]).unwrap();
        let found = |reference: &str| find(reference, &base, &allowed.folders).is_ok();
        assert!(found("images/in.png") && found("images/../images/in.png"));
        for reference in [
            "out.png",
            "images/../out.png",
            "images/%2e%2e/out.png",
            "../images-2/out.png",
            "/etc/passwd",
            "images/none.png",
        ] {
            assert!(!found(reference), "{reference}");
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("../out.png", base.join("images/link.png")).unwrap();
            assert!(!found("images/link.png"), "a link led out");
            std::os::unix::fs::symlink("in.png", base.join("images/inner.png")).unwrap();
            assert!(found("images/inner.png"), "a link inside was refused");
        }
        assert!(ImageFolders::new(&[base.join("none")]).is_err());
    }
}
