//! The `MIPS` sections of a file: which levels each holds, and their order.

use std::ops::Range;

use crate::records::image::Image;

/// Levels of at most this many texels along their longer side share a section. They are worth less
/// than the entries of sections of their own (docs/decisions/0018).
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

/// The sections of images with these sizes, in file order: the small levels of each, then the highest
/// level of any, images ascending within a level.
pub(super) fn mip_sections(sizes: &[[u32; 2]]) -> Vec<MipSection> {
    let first_small = |size: &[u32; 2]| {
        let small = |level: &u32| size[0].max(size[1]) >> level <= SMALL_SIDE;
        // The last level has one texel.
        (0..Image::level_count(*size)).find(small).unwrap_or(0)
    };
    let small = sizes.iter().enumerate().map(|(image, size)| MipSection {
        image,
        levels: first_small(size)..Image::level_count(*size),
    });
    let highest = sizes.iter().map(first_small).max().unwrap_or(0);
    let large = (0..highest).rev().flat_map(|level| {
        let images = sizes.iter().enumerate();
        let large = images.filter(move |(_, size)| level < first_small(size));
        large.map(move |(image, _)| MipSection {
            image,
            levels: level..level + 1,
        })
    });
    small.chain(large).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_levels_come_first_and_share_a_section() {
        let sections = mip_sections(&[[200, 3], [64, 64], [65, 100]]);
        let found: Vec<_> = sections
            .iter()
            .map(|section| (section.image, section.levels.clone()))
            .collect();
        let expected = [
            (0, 2..8),
            (1, 0..7),
            (2, 1..7),
            (0, 1..2),
            (0, 0..1),
            (2, 0..1),
        ];
        assert_eq!(found, expected);
        assert_eq!(sections[0].bytes([200, 3]), 4 * (50 + 25 + 12 + 6 + 3 + 1));
        assert!(sections[0].stored_levels().eq([7, 6, 5, 4, 3, 2]));
        assert_eq!(mip_sections(&[]), []);
    }
}
