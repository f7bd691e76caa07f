//! Twin of `vtex/texture.wgsl`, with `settings.rs`: its words. Words past the end are zero.

use super::Sampler;

pub(super) fn word_of(words: &[u32], index: u32) -> u32 {
    words.get(index as usize).copied().unwrap_or(0)
}

impl Sampler<'_> {
    pub(super) fn word(&self, index: u32) -> u32 {
        word_of(self.words, index)
    }

    /// `N` words from `first`, all zero when one of them lies past the end.
    pub(super) fn words<const N: usize>(&self, first: u32) -> [u32; N] {
        let found = self
            .words
            .get(first as usize..)
            .and_then(<[u32]>::first_chunk);
        found.copied().unwrap_or([0; N])
    }

    /// Whether nothing but zeros comes from `index` on: no walk over words goes on there.
    pub(super) fn is_past(&self, index: u32) -> bool {
        index as usize >= self.words.len()
    }

    pub(super) fn word_float(&self, index: u32) -> f32 {
        f32::from_bits(self.word(index))
    }

    pub(super) fn word_float4(&self, first: u32) -> [f32; 4] {
        self.words(first).map(f32::from_bits)
    }
}
