//! The shell of a zstd frame (RFC 8878 section 3.1.1), walked without unpacking a block.
//!
//! Decoders differ in what they take beyond a plain frame: several frames in a row, skippable
//! ones, dictionaries, windows, blocks larger than blocks may be. So none of them is asked.

/// First bytes of a frame.
const MAGIC: [u8; 4] = [0x28, 0xB5, 0x2F, 0xFD];
/// Most bytes of a block, packed or not. Less where the window is smaller.
pub(super) const MAX_BLOCK_BYTES: u64 = 128 << 10;
/// The largest exponent of a window, 1 to almost 2 GiB: what the C library takes on 32 bits.
const MAX_WINDOW_EXPONENT: u8 = 20;
/// Bytes of an XXH64's low half.
const CHECKSUM_BYTES: usize = 4;

/// One whole frame and nothing behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Frame<'a> {
    /// All of it.
    pub(super) bytes: &'a [u8],
    /// Raw bytes that its head promises, if it does.
    pub(super) content_bytes: Option<u64>,
    /// From the first block's head to the last block's end.
    pub(super) blocks: &'a [u8],
    /// Most bytes of a block, packed or not.
    pub(super) max_block_bytes: u64,
    /// Low half of the XXH64 of the raw bytes, where the frame ends with one.
    pub(super) checksum: Option<u32>,
}

impl<'a> Frame<'a> {
    /// Walks the frame; the error is a sentence.
    pub(super) fn parse(bytes: &'a [u8]) -> Result<Self, String> {
        let not_whole = || "not a whole frame".to_owned();
        let mut rest = Bytes(bytes);
        let head = Head::take(&mut rest).ok_or_else(not_whole)?;
        if head.dictionary != 0 {
            return Err("the frame asks for a dictionary".to_owned());
        }
        let body = rest.0;
        while !head.take_block(&mut rest).ok_or_else(not_whole)? {}
        let blocks = &body[..body.len() - rest.0.len()];
        let checksum = match head.has_checksum {
            true => Some(rest.number(CHECKSUM_BYTES).ok_or_else(not_whole)?),
            false => None,
        };
        if !rest.0.is_empty() {
            let length = bytes.len() - rest.0.len();
            return Err(format!("the frame ends after {length} bytes"));
        }
        Ok(Self {
            bytes,
            content_bytes: head.content_bytes,
            max_block_bytes: head.max_block_bytes,
            blocks,
            // Four bytes: it fits.
            checksum: checksum.and_then(|number| u32::try_from(number).ok()),
        })
    }
}

/// What a frame says before its blocks.
struct Head {
    content_bytes: Option<u64>,
    max_block_bytes: u64,
    dictionary: u64,
    has_checksum: bool,
}

impl Head {
    /// | bits of the descriptor | |
    /// |---|---|
    /// | 7..6 | size of the content size: 0 (1 in a single segment), 2, 4, 8 bytes |
    /// | 5 | single segment: the window is the content, and its byte is left out |
    /// | 4 | unused |
    /// | 3 | reserved, zero |
    /// | 2 | a checksum follows the blocks |
    /// | 1..0 | size of the dictionary's number: 0, 1, 2, 4 bytes |
    fn take(bytes: &mut Bytes<'_>) -> Option<Self> {
        if bytes.take(MAGIC.len())? != MAGIC {
            return None;
        }
        let descriptor = bytes.byte()?;
        if descriptor & 1 << 3 != 0 {
            return None;
        }
        // The order of what follows the descriptor: window, dictionary, content size.
        let single_segment = descriptor & 1 << 5 != 0;
        let window = match single_segment {
            true => None,
            false => Some(window_bytes(bytes.byte()?)?),
        };
        let dictionary = bytes.number([0, 1, 2, 4][usize::from(descriptor & 3)])?;
        let content_bytes = match descriptor >> 6 {
            0 if single_segment => Some(bytes.number(1)?),
            0 => None,
            // Two bytes begin where one ends.
            1 => Some(bytes.number(2)? + 256),
            2 => Some(bytes.number(4)?),
            _ => Some(bytes.number(8)?),
        };
        Some(Self {
            content_bytes,
            max_block_bytes: window.or(content_bytes)?.min(MAX_BLOCK_BYTES),
            dictionary,
            has_checksum: descriptor & 1 << 2 != 0,
        })
    }

    /// Passes over a block; whether it was the last one. The head of a block is 24 bits: last, kind
    /// (two bits), size.
    fn take_block(&self, bytes: &mut Bytes<'_>) -> Option<bool> {
        let head = bytes.number(3)?;
        let size = head >> 3;
        let stored = match head >> 1 & 3 {
            // As it is, or packed.
            0 | 2 => size,
            // One byte, again and again.
            1 => 1,
            _ => return None,
        };
        if size > self.max_block_bytes {
            return None;
        }
        let block = bytes.take(usize::try_from(stored).ok()?)?;
        let packed = head >> 1 & 3 == 2;
        let sound = !packed || self.is_sound_block(Bytes(block))?;
        sound.then_some(head & 1 != 0)
    }

    /// Whether the heads of a packed block's two parts say nothing that only some decoders take:
    /// more literals than a block may hold, and bits that are reserved.
    fn is_sound_block(&self, mut block: Bytes<'_>) -> Option<bool> {
        let (literals, stored) = take_literals_head(&mut block)?;
        block.take(stored)?;
        let sequences = match block.byte()? {
            byte @ 0..=127 => u64::from(byte),
            byte @ 128..=254 => u64::from(byte - 128) << 8 | block.number(1)?,
            255 => block.number(2)? + 0x7F00,
        };
        let is_end = block.0.is_empty();
        let modes = if sequences == 0 { 0 } else { block.byte()? };
        Some(literals <= self.max_block_bytes && modes & 3 == 0 && (sequences > 0 || is_end))
    }
}

/// Takes the head of a block's literals: how many there are, and the bytes that they take behind it.
///
/// Bits 1..0 are the kind: 0 as they are, 1 one byte again and again, 2 and 3 packed. Bits 3..2, of
/// the first two kinds only bit 2 where that is zero, say how wide the numbers are that follow.
fn take_literals_head(block: &mut Bytes<'_>) -> Option<(u64, usize)> {
    let first = *block.0.first()?;
    let kind = first & 3;
    let width = first >> 2 & 3;
    let (literals, stored) = if kind < 2 {
        let literals = match width {
            0 | 2 => block.number(1)? >> 3,
            1 => block.number(2)? >> 4,
            _ => block.number(3)? >> 4,
        };
        (literals, if kind == 0 { literals } else { 1 })
    } else {
        let (bytes, bits) = match width {
            0 | 1 => (3, 10),
            2 => (4, 14),
            _ => (5, 18),
        };
        let numbers = block.number(bytes)? >> 4;
        let mask = (1 << bits) - 1;
        (numbers & mask, numbers >> bits & mask)
    };
    Some((literals, usize::try_from(stored).ok()?))
}

/// Five bits of exponent above three of mantissa.
fn window_bytes(byte: u8) -> Option<u64> {
    let exponent = byte >> 3;
    let base = 1_u64 << (10 + exponent);
    (exponent <= MAX_WINDOW_EXPONENT).then_some(base + base / 8 * u64::from(byte & 7))
}

/// Takes bytes from the front.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn byte(&mut self) -> Option<u8> {
        self.take(1)?.first().copied()
    }

    /// A little-endian number of at most eight bytes.
    fn number(&mut self, count: usize) -> Option<u64> {
        let bytes = self.take(count)?.iter().rev();
        Some(bytes.fold(0, |number, &byte| number << 8 | u64::from(byte)))
    }
}
