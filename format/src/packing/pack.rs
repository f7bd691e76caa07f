//! Raw bytes to stored bytes: a zstd frame for a bundle, or the raw bytes themselves.

use super::dictionary;
use crate::container::section::Codec;
use crate::container::tag::Tag;

/// Levels by the most raw bytes that take them: beyond, the next level costs more time than its bytes
/// are worth. Bundles of 70 real files, all together, and CPU time on one core (docs/decisions/0018):
///
/// | | level 12 | 13 | 14 | 15 | 17 | 19 |
/// |---|---|---|---|---|---|---|
/// | tables up to 32 KiB | 206 KB, 0.1 s | 208, 0.1 | 203, 0.1 | 199, 0.2 | 198, 0.6 | 197, 1.2 |
/// | small levels | 358 KB, 0.1 s | 356, 0.1 | 348, 0.1 | 345, 0.3 | 343, 0.6 | 342, 1.0 |
/// | shaders, 50 to 68 KB | 1,259 KB, 0.3 s | 1,234, 0.5 | 1,198, 0.7 | 1,198, 0.8 | 1,188, 0.9 | 1,176, 2.2 |
/// | levels up to 64 KiB | 508 KB, 0.2 s | 506, 0.2 | 481, 0.2 | 475, 0.3 | 472, 1.1 | 471, 2.0 |
/// | levels up to 256 KiB | 1,398 KB, 0.7 s | 1,374, 0.7 | 1,318, 1.1 | 1,303, 1.3 | 1,278, 3.5 | 1,262, 4.4 |
/// | outlines above 32 KiB | 753 KB, 0.1 s | 724, 0.1 | 722, 0.2 | 721, 0.2 | 717, 0.3 | 717, 0.6 |
/// | larger levels | 4,650 KB, 2 s | 4,696, 5 | | 4,595, 14 | 4,103, 14 | |
const LEVELS: [(usize, i32); 4] = [
    (32 << 10, 15),
    (96 << 10, 14),
    (256 << 10, 13),
    (usize::MAX, 12),
];

/// Raw bytes of a bundle as stored: a zstd frame, or themselves when that is no shorter. A shader,
/// whose section `tag` begins the bundle, refers to a dictionary.
///
/// # Errors
/// When zstd has no memory.
pub(crate) fn pack(tag: Tag, raw: &[u8]) -> std::io::Result<(Codec, Vec<u8>)> {
    if tag == Tag::SHDR
        && let Some(stored) = dictionary::pack(raw)?
    {
        return Ok((Codec::Dictionary, stored));
    }
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
