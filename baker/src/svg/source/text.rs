//! From bytes to SVG text: decompressing, decoding, limits.

use std::io::Read;

use super::entities;
use crate::error::BakeError;

/// Most bytes of SVG text. The largest real drawings, maps, have about 30 MiB. A gzip stream that
/// decompresses to more is refused while it is read, so a bomb never takes its memory.
const MAX_SVG_BYTES: usize = 64 << 20;

/// The first bytes of a gzip stream.
pub(super) const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];

/// The text of an SVG, if it is short enough, also with its entities expanded.
pub(super) fn checked_text(bytes: &[u8]) -> Result<&str, BakeError> {
    if bytes.len() > MAX_SVG_BYTES {
        return Err(too_many_bytes());
    }
    let text = std::str::from_utf8(bytes)
        .map_err(|e| BakeError::Svg(format!("not UTF-8 text (byte {})", e.valid_up_to())))?;
    if text.trim_start_matches('\u{feff}').trim().is_empty() {
        return Err(BakeError::Svg("the input is empty".to_owned()));
    }
    if entities::expanded_bytes(text) > MAX_SVG_BYTES {
        return Err(BakeError::Limit(
            "entities expand to too much text".to_owned(),
        ));
    }
    Ok(text)
}

/// Decompresses an SVGZ, to one byte more than the limit at most.
pub(super) fn gunzip(svgz: &[u8]) -> Result<Vec<u8>, BakeError> {
    let mut bytes = Vec::new();
    let bound = MAX_SVG_BYTES as u64 + 1;
    flate2::read::GzDecoder::new(svgz)
        .take(bound)
        .read_to_end(&mut bytes)
        .map_err(|e| match e.kind() {
            std::io::ErrorKind::OutOfMemory => {
                BakeError::Limit("there is no memory for the unpacked SVG".to_owned())
            }
            _ => BakeError::Svg(format!("broken gzip stream: {e}")),
        })?;
    Ok(bytes)
}

fn too_many_bytes() -> BakeError {
    BakeError::Limit(format!(
        "the SVG text is larger than {} MiB",
        MAX_SVG_BYTES >> 20
    ))
}
