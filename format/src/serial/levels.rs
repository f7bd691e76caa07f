//! The `MIPS` sections of a file: which levels each holds, and their order.

use std::ops::Range;

use crate::records::image::{Image, ImageRecord};

/// Levels of at most this many texels along their longer side share a section, and an image's last
/// level is one of them whatever its size. They are worth less than the entries of sections of their
/// own (docs/decisions/0018).
const SMALL_SIDE: u32 = 64;

/// Levels of one image in one section, where the highest comes first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct MipSection {
    /// Index of the image.
    pub(super) image: usize,
    /// More than one for small levels only.
    pub(super) levels: Range<u32>,
}

impl MipSection {
    /// The levels as the section holds them.
    pub(super) fn stored_levels(&self) -> impl Iterator<Item = u32> + use<> {
        self.levels.clone().rev()
    }

    /// Bytes of all levels, for an image of this size.
    pub(super) fn bytes(&self, size: [u32; 2]) -> u64 {
        self.stored_levels()
            .map(|level| Image::level_bytes(size, level))
            .sum()
    }
}

/// The sections of images with these records, in file order: the small levels of each that has texels
/// of its own, then the highest level of any, images ascending within a level.
pub(super) fn mip_sections(records: &[ImageRecord]) -> Vec<MipSection> {
    let own = records.iter().enumerate();
    let own: Vec<_> = own
        .filter(|(index, record)| record.texels_of as usize == *index)
        .map(|(index, record)| (index, first_small(record), record.level_count))
        .collect();
    let small = own.iter().map(|&(image, first, count)| MipSection {
        image,
        levels: first..count,
    });
    let highest = own.iter().map(|&(_, first, _)| first).max().unwrap_or(0);
    let large = (0..highest).rev().flat_map(|level| {
        let large = own.iter().filter(move |&&(_, first, _)| level < first);
        large.map(move |&(image, ..)| MipSection {
            image,
            levels: level..level + 1,
        })
    });
    small.chain(large).collect()
}

/// The first level that shares a section with those above it.
fn first_small(record: &ImageRecord) -> u32 {
    let small = |level: &u32| {
        let [width, height] = Image::level_size(record.size, *level);
        width.max(height) <= SMALL_SIDE
    };
    let last = record.level_count.saturating_sub(1);
    (0..last).find(small).unwrap_or(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(size: [u32; 2], level_count: u32, texels_of: u32) -> ImageRecord {
        ImageRecord {
            rect_uv: [0.0, 0.0, 1.0, 1.0],
            size,
            level_count,
            texels_of,
        }
    }

    fn found(records: &[ImageRecord]) -> Vec<(usize, Range<u32>)> {
        let sections = mip_sections(records).into_iter();
        sections
            .map(|section| (section.image, section.levels))
            .collect()
    }

    #[test]
    fn small_levels_come_first_and_share_a_section() {
        let records = [
            record([200, 3], 9, 0),
            record([64, 64], 7, 1),
            record([65, 100], 8, 2),
        ];
        let expected = [
            (0, 2..9),
            (1, 0..7),
            (2, 1..8),
            (0, 1..2),
            (0, 0..1),
            (2, 0..1),
        ];
        assert_eq!(found(&records), expected);
        let small = &mip_sections(&records)[0];
        assert_eq!(small.bytes([200, 3]), 4 * (50 + 25 + 13 + 7 + 4 + 2 + 1));
        assert!(small.stored_levels().eq([8, 7, 6, 5, 4, 3, 2]));
        assert_eq!(mip_sections(&[]), []);
    }

    #[test]
    fn a_short_chain_begins_with_its_last_level() {
        let records = [record([900, 500], 3, 0), record([800, 70], 1, 1)];
        let expected = [(0, 2..3), (1, 0..1), (0, 1..2), (0, 0..1)];
        assert_eq!(found(&records), expected);
    }

    #[test]
    fn shared_texels_are_stored_once() {
        let size = [100, 90];
        let records = [record(size, 8, 0), record(size, 8, 0), record(size, 8, 2)];
        let expected = [(0, 1..8), (2, 1..8), (0, 0..1), (2, 0..1)];
        assert_eq!(found(&records), expected);
    }
}
