//! Raw bytes to stored bytes: a zstd frame a section, or the raw bytes themselves.

use crate::container::section::Codec;

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
pub(crate) fn pack(raw: &[u8]) -> std::io::Result<(Codec, Vec<u8>)> {
    let fits = |(most, level): (usize, i32)| (raw.len() <= most).then_some(level);
    // The last row takes any length.
    let level = LEVELS.into_iter().find_map(fits).unwrap_or_default();
    let frame = zstd::bulk::compress(raw, level)?;
    Ok(if frame.len() < raw.len() {
        (Codec::Zstd, frame)
    } else {
        (Codec::Raw, raw.to_vec())
    })
}
