//! What packing makes of a file.

use crate::layout::{header, image};
use crate::texels::{Place, TexelPages};

/// A texture as evaluators read it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Packed {
    /// Laid out as [`header`](crate::layout::header) says, with every offset relative to the first.
    /// Their number is a multiple of four, as is to be the index of the first in a larger buffer.
    pub words: Vec<u32>,
    /// The texels of its images.
    pub texels: TexelPages,
}

impl Packed {
    /// Bytes of the words on a GPU.
    pub fn word_bytes(&self) -> usize {
        size_of_val(&*self.words)
    }

    /// Bytes of words and texels on a GPU.
    pub fn bytes(&self) -> usize {
        self.word_bytes() + self.texels.bytes().len()
    }

    /// As [`Packed::bytes`], if the texels were compressed to BC7. No loader does that yet.
    pub fn bytes_bc(&self) -> usize {
        self.word_bytes() + self.texels.bytes_bc()
    }

    /// Whether there is more on its pages than the one texel that a texture without images binds.
    pub fn has_images(&self) -> bool {
        self.images().next().is_some()
    }

    /// Writes into the image records that the texture's page `i` lies at `places[i]` among the pages of
    /// a set: what was at its left and upper end comes to lie there. To be called once. Pages for which
    /// there is no place stay where they are.
    pub fn move_pages(&mut self, places: &[Place]) {
        let records: Vec<usize> = self.images().collect();
        for record in records {
            let last = self.words[record + image::LAST_LEVEL as usize] as usize;
            let levels = self.words[record + image::LEVELS as usize..].iter_mut();
            for word in levels.take(last + 1) {
                let level = place_of(*word);
                if let Some(moved) = places.get(level.page as usize) {
                    *word = place_word(Place {
                        page: moved.page,
                        corner: [0, 1].map(|axis| level.corner[axis] + moved.corner[axis]),
                    });
                }
            }
        }
    }

    /// The first word of each image record: nothing lies behind them.
    fn images(&self) -> impl Iterator<Item = usize> {
        let first = self.words.get(header::IMAGES as usize);
        let first = first.map_or(self.words.len(), |&word| word as usize);
        let record = image::WORDS as usize;
        (first..self.words.len().saturating_sub(record - 1)).step_by(record)
    }
}

/// Several textures as evaluators read them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PackedSet {
    /// The words of all of them, one texture after the other.
    pub words: Vec<u32>,
    /// The first word of each.
    pub first_words: Vec<u32>,
    /// The texels of all images.
    pub texels: TexelPages,
}

impl PackedSet {
    /// The words of the texture `index` alone; none where there is no such texture.
    pub fn of(&self, index: usize) -> &[u32] {
        let first = self.first_words.get(index).map(|&word| word as usize);
        let next = self.first_words.get(index + 1).map(|&word| word as usize);
        let words = first.unwrap_or(self.words.len())..next.unwrap_or(self.words.len());
        self.words.get(words).unwrap_or(&[])
    }
}

/// The word of a level's place.
pub(crate) fn place_word(place: Place) -> u32 {
    let [x, y] = place.corner;
    x | y << image::Y_SHIFT | place.page << image::PAGE_SHIFT
}

fn place_of(word: u32) -> Place {
    Place {
        page: word >> image::PAGE_SHIFT,
        corner: [word, word >> image::Y_SHIFT].map(|at| at & image::X_MASK),
    }
}
