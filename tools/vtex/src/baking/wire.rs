//! Messages between `vtex bake` and its workers, over pipes: a line of JSON, followed by as many raw
//! bytes as the line announces.

use std::ffi::OsString;
use std::io::{self, BufRead, Read, Write};
use std::path::PathBuf;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use vtex_format::{VtexFile, Warning};

use crate::cli::Failure;

/// Most bytes of a line: far more than any list of warnings needs, and few enough that a broken
/// writer cannot fill the memory of the reader.
const MAX_LINE_BYTES: u64 = 64 << 20;

/// To a worker: bake the SVG that follows.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Request {
    /// Path of the SVG, for messages and for relative references in it. An `OsString`, since paths
    /// need not be Unicode.
    pub(crate) path: OsString,
    /// Bytes of the SVG.
    pub(crate) svg_bytes: u64,
}

/// From a worker: any number of `Detail`, then one `Baked` or `Failed`.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Reply {
    /// The step that begins, for `--verbose`.
    Detail(String),
    /// The bake is done; its bytes follow.
    Baked {
        /// How many bytes follow.
        bytes: u64,
        /// What the bake made.
        summary: Summary,
    },
    /// The bake failed.
    Failed(Failure),
}

/// What the command reports about a bake.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Summary {
    /// Number of shapes.
    pub(crate) shapes: usize,
    /// Number of layers.
    pub(crate) layers: usize,
    /// Features of the SVG that were approximated or left out.
    pub(crate) warnings: Vec<Warning>,
    /// Other files that the bake read.
    pub(crate) files: Vec<OsString>,
    /// Whether the SVG names files. Then its own bytes do not determine the bake.
    pub(crate) names_files: bool,
}

impl Summary {
    /// The summary of a bake that read no other files.
    pub(crate) fn of(file: &VtexFile) -> Self {
        Self {
            shapes: file.shapes.len(),
            layers: file.layers.len(),
            warnings: file
                .provenance
                .as_ref()
                .map_or_else(Vec::new, |p| p.warnings.clone()),
            ..Self::default()
        }
    }

    /// Other files that the bake read.
    pub(crate) fn paths(&self) -> Vec<PathBuf> {
        self.files.iter().map(PathBuf::from).collect()
    }
}

/// Writes one message.
///
/// # Errors
/// When the pipe is closed.
pub(crate) fn send(to: &mut impl Write, message: &impl Serialize, bytes: &[u8]) -> io::Result<()> {
    let mut line = serde_json::to_vec(message)?;
    line.push(b'\n');
    to.write_all(&line)?;
    to.write_all(bytes)?;
    to.flush()
}

/// Reads one message without the bytes that follow it.
///
/// # Errors
/// When the pipe is closed, or the line is no message of type `T`.
pub(crate) fn receive<T: DeserializeOwned>(from: &mut impl BufRead) -> io::Result<T> {
    let mut line = Vec::new();
    from.take(MAX_LINE_BYTES).read_until(b'\n', &mut line)?;
    if line.last() != Some(&b'\n') {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(serde_json::from_slice(&line)?)
}

/// Reads the `count` bytes that follow a message.
///
/// # Errors
/// When the pipe is closed before that.
pub(crate) fn receive_bytes(from: &mut impl Read, count: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(count).read_to_end(&mut bytes)?;
    if bytes.len() as u64 != count {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_and_bytes_alternate() {
        let mut pipe = Vec::new();
        for (path, svg) in [("a\nb.svg", b"12\n4".as_slice()), ("c", b"")] {
            let request = Request {
                path: path.into(),
                svg_bytes: svg.len() as u64,
            };
            send(&mut pipe, &request, svg).unwrap();
        }
        let mut reader = pipe.as_slice();
        for (path, svg) in [("a\nb.svg", b"12\n4".as_slice()), ("c", b"")] {
            let request: Request = receive(&mut reader).unwrap();
            assert_eq!(request.path, path);
            assert_eq!(receive_bytes(&mut reader, request.svg_bytes).unwrap(), svg);
        }
        assert!(receive::<Request>(&mut reader).is_err());
        assert!(receive_bytes(&mut reader, 1).is_err());
    }
}
