//! What packing makes of a file.

use crate::texels::TexelPages;

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
