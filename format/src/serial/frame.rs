//! Stored bytes to raw bytes and back: one zstd frame a section.

use bytemuck::Pod;
use zstd::zstd_safe;

use crate::container::issue::{self, IssueKind};
use crate::container::section::{Codec, SectionInfo};

/// Levels by the most raw bytes that take them: small sections as tight as zstd packs, larger ones
/// where the next level costs more time than its bytes are worth. CPU time on one core:
///
/// | the Tiger's | level 12 | 15 | 17 | 19 |
/// |---|---|---|---|---|
/// | mip 0, 946 KB | 73.6 KB, 9 ms | 73.2 KB, 26 ms | 66.2 KB, 42 ms | 64.9 KB, 128 ms |
/// | mip 1, 237 KB | 29.5 KB, 8 ms | 28.3 KB, 19 ms | 28.3 KB, 37 ms | 28.2 KB, 47 ms |
/// | outlines, 137 KB | 98.3 KB, 6 ms | 93.3 KB, 17 ms | 92.6 KB, 18 ms | 92.6 KB, 27 ms |
/// | tiles, 1.6 MB | 404 KB, 170 ms | 398 KB, 660 ms | | 364 KB, 2.2 s |
const LEVELS: [(usize, i32); 2] = [(32 << 10, 19), (usize::MAX, 12)];

/// Raw bytes as stored: a zstd frame, or themselves when that is no shorter.
///
/// # Errors
/// When zstd has no memory.
pub(crate) fn compress(raw: &[u8]) -> std::io::Result<(Codec, Vec<u8>)> {
    let fits = |(most, level): (usize, i32)| (raw.len() <= most).then_some(level);
    let level = LEVELS.into_iter().find_map(fits).unwrap_or_default();
    let frame = zstd::bulk::compress(raw, level)?;
    Ok(if frame.len() < raw.len() {
        (Codec::Zstd, frame)
    } else {
        (Codec::Raw, raw.to_vec())
    })
}

/// Why a section's bytes could not be had.
pub(crate) type Refusal = (IssueKind, String);

/// Unpacks a section into memory of just its raw length.
pub(crate) fn decompress(
    section: &SectionInfo,
    stored: &[u8],
    raw: &mut [u8],
) -> Result<(), Refusal> {
    match section.codec {
        Codec::Raw => raw.copy_from_slice(stored),
        Codec::Zstd => unpack(stored, raw)?,
        Codec::Unknown(number) => return Err((issue::CODEC, format!("codec {number}"))),
    }
    if *blake3::hash(raw).as_bytes() != section.hash {
        let message = "the raw bytes are not those that were written";
        return Err((issue::HASH, message.to_owned()));
    }
    Ok(())
}

fn unpack(stored: &[u8], raw: &mut [u8]) -> Result<(), Refusal> {
    let refuse = |message: String| Err((issue::FRAME, message));
    // One frame and nothing else: zstd itself would also take several, and skip what it pleases.
    match zstd_safe::find_frame_compressed_size(stored) {
        Ok(length) if length == stored.len() => {}
        Ok(length) => return refuse(format!("the frame ends after {length} bytes")),
        Err(_) => return refuse("not a whole frame".into()),
    }
    match zstd_safe::get_frame_content_size(stored) {
        Ok(Some(length)) if length == raw.len() as u64 => {}
        _ => {
            return refuse(format!(
                "the frame does not say that it holds {} bytes",
                raw.len()
            ));
        }
    }
    match zstd::bulk::decompress_to_buffer(stored, raw) {
        Ok(length) if length == raw.len() => Ok(()),
        Ok(length) => refuse(format!("{length} bytes instead of {}", raw.len())),
        Err(error) => refuse(error.to_string()),
    }
}

/// Zeroed elements of `bytes` in all, in one piece. The caller has checked `bytes` against its
/// budgets; what the machine does not have is refused where `vec!` would abort.
pub(crate) fn allocate<T: Pod>(bytes: u64) -> Result<Vec<T>, Refusal> {
    let size = size_of::<T>() as u64;
    if !bytes.is_multiple_of(size) {
        let message = format!("{bytes} bytes are no whole number of {size}-byte records");
        return Err((issue::RECORD_LENGTH, message));
    }
    let refuse = || (issue::MEMORY, format!("{bytes} bytes"));
    let count = usize::try_from(bytes / size).map_err(|_| refuse())?;
    let mut elements = Vec::new();
    elements.try_reserve_exact(count).map_err(|_| refuse())?;
    elements.resize(count, T::zeroed());
    Ok(elements)
}
