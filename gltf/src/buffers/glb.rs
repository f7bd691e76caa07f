//! The two containers: JSON text, and GLB with a binary chunk.

use crate::error::{GltfError, Outcome, malformed};

const MAGIC: &[u8; 4] = b"glTF";
const JSON: u32 = 0x4e4f_534a;
const BIN: u32 = 0x004e_4942;
const HEADER_BYTES: usize = 12;

/// The parts of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parts<'a> {
    pub(crate) json: &'a [u8],
    pub(crate) bin: Option<&'a [u8]>,
}

/// Splits a file; one that does not begin as a GLB does is JSON as a whole.
pub(crate) fn split(bytes: &[u8]) -> Outcome<Parts<'_>> {
    if !bytes.starts_with(MAGIC) {
        return Ok(Parts {
            json: bytes,
            bin: None,
        });
    }
    let [Some(version), Some(length)] = [4, 8].map(|at| word(bytes, at)) else {
        return malformed("GLB header", "the file ends in it");
    };
    if version != 2 {
        let message = format!("GLB of version {version}; this reader knows version 2");
        return Err(GltfError::Unsupported(message));
    }
    if (length as usize) < HEADER_BYTES || length as usize > bytes.len() {
        let has = bytes.len();
        let what = format!("the header says {length} bytes, the file has {has}: was it cut?");
        return malformed("GLB header", what);
    }
    let mut chunks = Vec::new();
    let mut rest = &bytes[HEADER_BYTES..length as usize];
    while !rest.is_empty() {
        let [Some(length), Some(kind)] = [0, 4].map(|at| word(rest, at)) else {
            return malformed("GLB chunk header", "the file ends in it");
        };
        let Some(chunk) = rest[8..].get(..length as usize) else {
            let left = rest.len() - 8;
            let what = format!("it says {length} bytes, {left} are left");
            return malformed("GLB chunk", what);
        };
        chunks.push((kind, chunk));
        // Chunks are padded to words; the last one of a sloppy file is not.
        let end = (8 + chunk.len()).next_multiple_of(4).min(rest.len());
        rest = &rest[end..];
    }
    match chunks.as_slice() {
        [(JSON, json), others @ ..] => Ok(Parts {
            json,
            bin: others
                .iter()
                .find(|(kind, _)| *kind == BIN)
                .map(|(_, bin)| *bin),
        }),
        _ => malformed("GLB", "the first chunk is not JSON"),
    }
}

/// A GLB of these parts.
pub(crate) fn join(json: &[u8], bin: &[u8]) -> Outcome<Vec<u8>> {
    let padded = |bytes: usize| bytes.next_multiple_of(4);
    let bin_bytes = if bin.is_empty() {
        0
    } else {
        8 + padded(bin.len())
    };
    let total = HEADER_BYTES + 8 + padded(json.len()) + bin_bytes;
    let Ok(total_word) = u32::try_from(total) else {
        return Err(GltfError::Limit(format!(
            "{total} bytes; a GLB holds 4 GiB"
        )));
    };
    let mut bytes = Vec::with_capacity(total);
    bytes.extend(MAGIC);
    bytes.extend(2_u32.to_le_bytes());
    bytes.extend(total_word.to_le_bytes());
    let mut chunk = |kind: u32, content: &[u8], pad: u8| {
        // Less than the total, which fits.
        let length = u32::try_from(padded(content.len())).unwrap_or(u32::MAX);
        bytes.extend(length.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend(content);
        bytes.resize(bytes.len().next_multiple_of(4), pad);
    };
    chunk(JSON, json, b' ');
    if !bin.is_empty() {
        chunk(BIN, bin, 0);
    }
    Ok(bytes)
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes
        .get(at..)?
        .first_chunk()
        .map(|word| u32::from_le_bytes(*word))
}
