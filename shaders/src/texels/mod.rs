//! Texels of images in pages, as the layers of one texture array hold them.
//!
//! Every mip level of an image is a rectangle of its own, with a border of one texel around it, so
//! that a bilinear lookup at its sides finds what the address mode asks for (docs/decisions/0020).

mod arrange;
mod bc7;
mod skyline;

use std::collections::BTreeSet;
use std::sync::Arc;

use vtex_format::{Image, MAX_MIPS};

pub use arrange::Place;
use arrange::{Arrangement, arrange};

/// Bytes of a texel.
const TEXEL_BYTES: usize = 4;
/// Texels along a side of a block of BC7. The rooms of levels are whole blocks, so that no block shows two.
const BLOCK_SIDE: u32 = 4;
/// Texels around a level on each side.
const BORDER: u32 = 1;
/// Texels along a page at most: what every WebGPU device has. A level that is larger is left out.
pub const MAX_PAGE_SIDE: u32 = 8192;

/// Pages of one size with the texels of one or more textures. A texel is RGBA8: linear light,
/// premultiplied, then sRGB-encoded; alpha as it is. So the format with sRGB decoding filters it
/// correctly.
#[derive(Clone, Debug, PartialEq)]
pub struct TexelPages {
    size: [u32; 2],
    bytes: Vec<u8>,
}

/// A level of an image, on its way into a page.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level<'a> {
    /// Row by row.
    pub(crate) texels: &'a [u8],
    pub(crate) size: [u32; 2],
    /// Axes along which the border shows the other side; along others it repeats the last texel.
    pub(crate) wraps: [bool; 2],
}

impl Level<'_> {
    /// The texel along an axis that shows at `index`, counted from the border.
    fn shown(&self, index: u32, axis: usize) -> usize {
        let side = self.size[axis];
        let inside = if self.wraps[axis] {
            (index + side - BORDER) % side
        } else {
            index.saturating_sub(BORDER).min(side - 1)
        };
        inside as usize
    }
}

impl Default for TexelPages {
    /// One page of empty texels.
    fn default() -> Self {
        Self::new([BLOCK_SIDE; 2], 1)
    }
}

impl TexelPages {
    fn new(size: [u32; 2], count: usize) -> Self {
        let texels = size[0] as usize * size[1] as usize;
        Self {
            size,
            bytes: vec![0; TEXEL_BYTES * texels * count],
        }
    }

    /// Pages with `levels`, and where the first texel of each lies. A page has at most `page_side` texels
    /// a side, more only where a level has.
    pub(crate) fn filled(levels: &[Level<'_>], page_side: u32) -> (Self, Vec<Place>) {
        let arranged = arrange(&rooms(levels), page_side);
        let mut pages = Self::new(page_size(&arranged), arranged.count);
        let inside = |place: Place| Place {
            corner: place.corner.map(|side| side + BORDER),
            ..place
        };
        let places: Vec<Place> = arranged.places.into_iter().map(inside).collect();
        for (level, place) in levels.iter().zip(&places) {
            pages.fill(level, place);
        }
        (pages, places)
    }

    /// Texels along a page, along x and y, in whole blocks.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Number of pages, at least one.
    pub fn count(&self) -> u32 {
        let count = self.bytes.len() / self.page_bytes();
        u32::try_from(count).unwrap_or(u32::MAX)
    }

    /// The texels, page by page and row by row, four bytes each.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Bytes that the pages take in BC7: a byte a texel.
    pub fn bytes_bc(&self) -> usize {
        self.bytes.len() / TEXEL_BYTES
    }

    /// The pages in BC7: blocks of 4 x 4 texels row by row, 16 bytes each. They are made anew at each call, 25
    /// to 50 million texels a second on one core. Of one texture's edges and gradients they keep 45 to 50 dB;
    /// what is opaque or empty stays exactly so.
    pub fn blocks(&self) -> Vec<u8> {
        let [width, height] = self.size;
        let mut blocks = Vec::with_capacity(self.bytes_bc());
        for page in 0..self.count() {
            for top in (0..height).step_by(BLOCK_SIDE as usize) {
                for left in (0..width).step_by(BLOCK_SIDE as usize) {
                    let mut texels = [[0; TEXEL_BYTES]; 16];
                    for (texel, at) in texels.iter_mut().zip(0..) {
                        *texel = self.texel(page, left + at % BLOCK_SIDE, top + at / BLOCK_SIDE);
                    }
                    blocks.extend(bc7::block(&texels));
                }
            }
        }
        blocks
    }

    fn page_bytes(&self) -> usize {
        TEXEL_BYTES * self.size[0] as usize * self.size[1] as usize
    }

    /// Copies a level and its border.
    fn fill(&mut self, level: &Level<'_>, place: &Place) {
        let [width, height] = room(level);
        let row_bytes = TEXEL_BYTES * level.size[0] as usize;
        for y in 0..height {
            let from = row_bytes * level.shown(y, 1);
            let Some(row) = level.texels.get(from..from + row_bytes) else {
                return;
            };
            let [left, top] = place.corner.map(|side| side - BORDER);
            let mut put = |x: u32, texels: &[u8]| {
                let at = self.offset(place.page, left + x, top + y);
                self.bytes[at..at + texels.len()].copy_from_slice(texels);
            };
            put(BORDER, row);
            for x in (0..BORDER).chain(BORDER + level.size[0]..width) {
                let from = TEXEL_BYTES * level.shown(x, 0);
                put(x, &row[from..from + TEXEL_BYTES]);
            }
        }
    }

    /// Byte of a texel; places beyond the far sides of the page are their last texels.
    fn offset(&self, page: u32, x: u32, y: u32) -> usize {
        let [x, y] = [x.min(self.size[0] - 1), y.min(self.size[1] - 1)].map(|at| at as usize);
        let texel = y * self.size[0] as usize + x;
        (page as usize)
            .saturating_mul(self.page_bytes())
            .saturating_add(TEXEL_BYTES * texel)
    }

    /// A texel as it is stored; places beyond the far sides of a page are its last texels. Nothing for a
    /// page that is not there.
    pub(crate) fn texel(&self, page: u32, x: u32, y: u32) -> [u8; TEXEL_BYTES] {
        let from = self.offset(page, x, y);
        let found = self.bytes.get(from..).and_then(<[u8]>::first_chunk);
        found.copied().unwrap_or_default()
    }
}

/// Sides of levels with their borders.
fn rooms(levels: &[Level<'_>]) -> Vec<[u32; 2]> {
    levels.iter().map(room).collect()
}

/// The border at the far sides is as wide as whole blocks take.
fn room(level: &Level<'_>) -> [u32; 2] {
    let whole = |side: u32| (side + 2 * BORDER).next_multiple_of(BLOCK_SIDE);
    level.size.map(whole)
}

fn page_size(arranged: &Arrangement) -> [u32; 2] {
    arranged.page.map(|side| side.next_multiple_of(BLOCK_SIDE))
}

/// Bytes of the pages with the texels of `images`, as packing a texture with them makes them. Texels
/// that images share count once. Nothing is copied.
pub fn page_bytes<'a>(images: impl IntoIterator<Item = &'a Image>) -> usize {
    let mut known = BTreeSet::new();
    let own = images
        .into_iter()
        .filter(|image| known.insert(Arc::as_ptr(&image.mips)));
    let levels: Vec<Level<'a>> = own
        .flat_map(|image| levels_of(image, [false; 2]).1)
        .collect();
    let arranged = arrange(&rooms(&levels), MAX_PAGE_SIDE);
    let [width, height] = page_size(&arranged).map(|side| side as usize);
    TEXEL_BYTES * width * height * arranged.count
}

/// Levels of `image` that fit a page, the finest first, with the index of the first.
pub(crate) fn levels_of(image: &Image, wraps: [bool; 2]) -> (u32, Vec<Level<'_>>) {
    let sized = (0..MAX_MIPS)
        .zip(image.mips.iter())
        .map(|(level, texels)| Level {
            texels,
            size: Image::level_size(image.size, level),
            wraps,
        });
    let too_large = |level: &Level<'_>| level.size.iter().any(|&s| s > MAX_PAGE_SIDE - 2 * BORDER);
    let levels: Vec<Level<'_>> = sized.skip_while(too_large).collect();
    let left_out = image.mips.len().min(MAX_MIPS as usize) - levels.len();
    (u32::try_from(left_out).unwrap_or(u32::MAX), levels)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(size: [u32; 2], texels: &[u8], wraps: [bool; 2]) -> Level<'_> {
        Level {
            texels,
            size,
            wraps,
        }
    }

    /// Bytes count up from `first`.
    fn counted(first: u8, texels: u8) -> Vec<u8> {
        (first..first + 4 * texels).collect()
    }

    #[test]
    fn a_border_repeats_the_edge_or_shows_the_other_side() {
        let texels = counted(0, 6);
        for wraps in [[false; 2], [true, false], [false, true], [true; 2]] {
            let (pages, places) =
                TexelPages::filled(&[level([3, 2], &texels, wraps)], MAX_PAGE_SIDE);
            assert_eq!((pages.size(), pages.count()), ([8, 4], 1));
            assert_eq!(places[0].corner, [1, 1]);
            let columns = if wraps[0] {
                [2, 0, 1, 2, 0, 1, 2, 0]
            } else {
                [0, 0, 1, 2, 2, 2, 2, 2]
            };
            let rows = if wraps[1] { [1, 0, 1, 0] } else { [0, 0, 1, 1] };
            let shown = rows.map(|row| columns.map(|column| 4 * (3 * row + column)));
            let reds = pages.bytes().chunks_exact(4).map(|texel| texel[0]);
            assert!(reds.eq(shown.into_iter().flatten()), "{wraps:?}");
        }
    }

    #[test]
    fn bytes_of_pages_are_known_without_them() {
        let image = |size: [u32; 2]| Image {
            rect_uv: [0.0, 0.0, 1.0, 1.0],
            size,
            mips: Arc::new(
                (0..Image::level_count(size))
                    .map(|level| Image::level_size(size, level))
                    .map(|[width, height]| vec![0; (4 * width * height) as usize])
                    .collect(),
            ),
        };
        assert_eq!(page_bytes(&[]), 64);
        let mut images = vec![image([64, 32]), image([7, 5])];
        images.push(images[1].clone());
        let own = &images[..2];
        let levels: Vec<_> = own
            .iter()
            .flat_map(|i| levels_of(i, [false; 2]).1)
            .collect();
        let (pages, _) = TexelPages::filled(&levels, MAX_PAGE_SIDE);
        assert_eq!(page_bytes(&images), pages.bytes().len());
    }

    #[test]
    fn levels_too_large_for_a_page_are_left_out() {
        let size = [4 * MAX_PAGE_SIDE, 1];
        let count = Image::level_count(size);
        let image = Image {
            rect_uv: [0.0, 0.0, 1.0, 1.0],
            size,
            mips: Arc::new(vec![Vec::new(); count as usize]),
        };
        let (first, levels) = levels_of(&image, [false; 2]);
        assert_eq!(first, 3, "8192 texels have no room for a border");
        assert_eq!(levels.len(), count as usize - 3);
        assert_eq!(levels[0].size, [MAX_PAGE_SIDE / 2, 1]);
    }
}
