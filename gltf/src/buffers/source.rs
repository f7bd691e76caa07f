//! Where the bytes of an asset come from.

use base64::Engine as _;
use vtex_format::VtexFile;

use crate::document::Document;
use crate::error::{GltfError, Outcome, find, malformed};

/// What a program lends to the reader: files beside the asset, and a baker of SVG. The reader itself
/// opens no file and parses no SVG.
pub trait Files {
    /// The bytes of a file that the asset names by a relative URI, with its percent signs decoded.
    ///
    /// # Errors
    /// Why there are none. The reader says who asked.
    fn read(&mut self, uri: &str) -> Result<Vec<u8>, String>;

    /// A texture of the bytes of an SVG; `name` is for messages.
    ///
    /// # Errors
    /// Why there is none.
    fn bake(&mut self, svg: &[u8], name: &str) -> Result<VtexFile, String>;
}

/// No files and no baker: for assets that hold all they need.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl Files for NoFiles {
    fn read(&mut self, _uri: &str) -> Result<Vec<u8>, String> {
        Err("this program reads no files beside the asset".to_owned())
    }

    fn bake(&mut self, _svg: &[u8], _name: &str) -> Result<VtexFile, String> {
        Err("this program bakes no SVG; name a .vtex file instead".to_owned())
    }
}

/// The buffers of an asset, each with at least as many bytes as it claims.
#[derive(Debug)]
pub(crate) struct Buffers {
    data: Vec<Vec<u8>>,
}

impl Buffers {
    pub(crate) fn new(
        document: &Document,
        bin: Option<&[u8]>,
        files: &mut dyn Files,
    ) -> Outcome<Self> {
        let mut data = Vec::with_capacity(document.buffers.len());
        for (index, buffer) in document.buffers.iter().enumerate() {
            let place = format!("buffers[{index}]");
            let bytes = match (&buffer.uri, bin) {
                (Some(uri), _) => uri_bytes(uri, &place, files)?,
                (None, Some(bin)) if index == 0 => bin.to_vec(),
                (None, _) => {
                    return malformed(&place, "it has no uri, and there is no binary chunk for it");
                }
            };
            let (claims, has) = (buffer.byte_length, bytes.len());
            if claims > has as u64 {
                return malformed(&place, format!("it claims {claims} bytes and has {has}"));
            }
            data.push(bytes);
        }
        Ok(Self { data })
    }

    /// The bytes of `bufferViews[index]`.
    pub(crate) fn view(&self, document: &Document, index: usize, place: &str) -> Outcome<&[u8]> {
        let view = find(&document.buffer_views, index, "bufferViews", place)?;
        let place = format!("bufferViews[{index}]");
        let buffer = find(&self.data, view.buffer, "buffers", &place)?;
        let end = view.byte_offset.checked_add(view.byte_length);
        let range = usize::try_from(view.byte_offset).ok();
        let range = range.zip(end.and_then(|end| usize::try_from(end).ok()));
        match range.and_then(|(start, end)| buffer.get(start..end)) {
            Some(bytes) => Ok(bytes),
            None => malformed(
                &place,
                format!(
                    "{} bytes from {} lie past the end of buffers[{}], which has {}",
                    view.byte_length,
                    view.byte_offset,
                    view.buffer,
                    buffer.len()
                ),
            ),
        }
    }
}

/// The bytes that a URI names: those in it, or those of a file.
pub(crate) fn uri_bytes(uri: &str, place: &str, files: &mut dyn Files) -> Outcome<Vec<u8>> {
    if let Some(data) = uri.strip_prefix("data:") {
        let Some((_, encoded)) = data.split_once(";base64,") else {
            return malformed(place, "a data URI that is not base64");
        };
        let engine = base64::engine::general_purpose::STANDARD;
        let decoded = engine.decode(encoded.trim_end());
        return decoded.or_else(|error| malformed(place, format!("base64: {error}")));
    }
    let path = percent_decoded(uri);
    if path.contains("://") {
        let message = format!("{place}: {uri}: nothing is read from a network");
        return Err(GltfError::Unsupported(message));
    }
    let read = files.read(&path);
    read.map_err(|error| GltfError::Missing(format!("{place}: {path}: {error}")))
}

fn percent_decoded(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let hex = (byte == b'%').then(|| bytes.get(at + 1..at + 3)).flatten();
        let hex = hex.and_then(|hex| std::str::from_utf8(hex).ok());
        match hex.and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(value) => {
                decoded.push(value);
                at += 3;
            }
            None => {
                decoded.push(byte);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&decoded).into_owned()
}
