//! The specialised shader made at bake time.

use crate::container::issue::{self, Issues};
use crate::container::layout::SHADER_HEAD_BYTES;
use crate::container::tag::Tag;

/// Stored in `SHDR`. The key in `SPEC` is the truth, this is a convenience: readers compare
/// hashes and regenerate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaderBlob {
    /// [`crate::SHADER_ABI`] it was made for.
    pub abi: u32,
    /// WGSL text of the fragment: `fn vtex_sample(uv: vec2f, footprint: vec4f) -> vec4f`.
    pub wgsl_fragment: String,
    /// SPIR-V words of the standalone batch kernel.
    pub batch_spirv: Vec<u32>,
}

impl ShaderBlob {
    /// The section's raw bytes; `None` when a length does not fit 32 bits.
    pub(crate) fn encode(&self) -> Option<Vec<u8>> {
        let text = self.wgsl_fragment.as_bytes();
        let text_bytes = u32::try_from(text.len()).ok()?;
        let word_count = u32::try_from(self.batch_spirv.len()).ok()?;
        let mut bytes = Vec::new();
        for word in [self.abi, text_bytes, word_count, 0] {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(text);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        for word in &self.batch_spirv {
            bytes.extend(word.to_le_bytes());
        }
        Some(bytes)
    }

    /// Reads a section's raw bytes, noting what is wrong with them.
    pub(crate) fn decode(bytes: &[u8], issues: &mut Issues) -> Option<Self> {
        let Some((head, body)) = bytes.split_first_chunk::<SHADER_HEAD_BYTES>() else {
            let length = bytes.len();
            let message = format_args!("{length} bytes are less than its head");
            issues.add(issue::SHADER_LENGTH, Tag::SHDR, 0, message);
            return None;
        };
        let [abi, text_bytes, word_count, reserved] = words(head);
        // In 64 bits: the lengths of a damaged head may add up to more than 32.
        let padded_bytes = u64::from(text_bytes).next_multiple_of(4);
        let expected = padded_bytes + 4 * u64::from(word_count);
        if body.len() as u64 != expected {
            let message = format_args!("{} bytes behind its head, not {expected}", body.len());
            issues.add(issue::SHADER_LENGTH, Tag::SHDR, 4, message);
            return None;
        }
        // Both are at most the length of `body`.
        let (text, spirv) = body.split_at(usize::try_from(padded_bytes).ok()?);
        let (text, padding) = text.split_at(usize::try_from(text_bytes).ok()?);
        if reserved != 0 || padding.iter().any(|&byte| byte != 0) {
            issues.add(
                issue::SHADER_RESERVED,
                Tag::SHDR,
                12,
                format_args!("not zero"),
            );
        }
        let Ok(text) = str::from_utf8(text) else {
            let offset = SHADER_HEAD_BYTES as u64;
            issues.add(
                issue::SHADER_TEXT,
                Tag::SHDR,
                offset,
                format_args!("not UTF-8"),
            );
            return None;
        };
        Some(Self {
            abi,
            wgsl_fragment: text.to_owned(),
            batch_spirv: spirv
                .as_chunks()
                .0
                .iter()
                .map(|&word| u32::from_le_bytes(word))
                .collect(),
        })
    }
}

fn words(head: &[u8; SHADER_HEAD_BYTES]) -> [u32; SHADER_HEAD_BYTES / 4] {
    let (words, _) = head.as_chunks::<4>();
    std::array::from_fn(|index| u32::from_le_bytes(words[index]))
}
