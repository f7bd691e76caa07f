//! Stored bytes to raw bytes, into memory of just their length.

use bytemuck::Pod;

use super::dictionary;
use super::zstd_frame::Frame;
use crate::container::issue::{self, IssueKind};
use crate::container::section::{BundleInfo, Codec};

/// Why a bundle's or a section's bytes could not be read.
pub(crate) type Refusal = (IssueKind, String);

/// Unpacks a bundle into memory of just its raw length.
///
/// A frame with a bad shell is [`issue::FRAME`]. Blocks that do not unpack and blocks that unpack to
/// other bytes are both [`issue::HASH`]: decoders differ in the damage they notice, and so a file has
/// the same issues with either.
pub(crate) fn unpack(bundle: &BundleInfo, stored: &[u8], raw: &mut [u8]) -> Result<(), Refusal> {
    let unpacked = match bundle.codec {
        // The directory has seen that both lengths are equal.
        Codec::Raw => {
            raw.copy_from_slice(stored);
            Some(())
        }
        Codec::Zstd => {
            let frame = Frame::parse(stored).map_err(|message| (issue::FRAME, message))?;
            decode_frame(&frame, &[], raw)?
        }
        Codec::Dictionary => {
            let (dictionary, frame) = with_dictionary(stored)?;
            decode_frame(&frame, dictionary, raw)?
        }
        Codec::Unknown(number) => return Err((issue::CODEC, format!("codec {number}"))),
    };
    let hash = unpacked.map(|()| blake3::hash(raw));
    if hash.is_none_or(|hash| !hash.as_bytes().starts_with(&bundle.hash)) {
        let message = "the raw bytes are not those that were written";
        return Err((issue::HASH, message.to_owned()));
    }
    Ok(())
}

/// The dictionary and the frame of a bundle.
fn with_dictionary(stored: &[u8]) -> Result<(&'static [u8], Frame<'_>), Refusal> {
    let malformed = |message: String| (issue::FRAME, message);
    let Some((&id, frame)) = stored.split_first_chunk::<{ dictionary::ID_BYTES }>() else {
        return Err(malformed("no dictionary is named".to_owned()));
    };
    let frame = Frame::parse(frame).map_err(malformed)?;
    // The decoder in Rust unpacks the dictionary too, so it has no checksum of the content alone.
    if frame.checksum.is_some() {
        return Err(malformed("the frame has a checksum".to_owned()));
    }
    let unknown = || {
        let hex: String = id.iter().map(|byte| format!("{byte:02x}")).collect();
        (issue::DICTIONARY, format!("dictionary {hex}"))
    };
    let content = dictionary::find(id).ok_or_else(unknown)?;
    Ok((content, frame))
}

/// `None` when the blocks do not unpack to the content.
fn decode_frame(
    frame: &Frame<'_>,
    dictionary: &[u8],
    raw: &mut [u8],
) -> Result<Option<()>, Refusal> {
    // Decoders differ in what they make of another length, so none of them sees one.
    if frame.content_bytes != Some(raw.len() as u64) {
        let bytes = raw.len();
        let message = format!("the frame does not say that it holds {bytes} bytes");
        return Err((issue::FRAME, message));
    }
    #[cfg(feature = "zstd")]
    let decoded = zstd_decoder::decode(frame, dictionary, raw);
    #[cfg(not(feature = "zstd"))]
    let decoded = ruzstd_decoder::decode(frame, dictionary, raw);
    Ok(decoded)
}

/// The C library.
#[cfg(any(test, feature = "zstd"))]
mod zstd_decoder {
    use super::Frame;

    /// Fills `raw`; `None` unless the frame holds just as many bytes.
    pub(super) fn decode(frame: &Frame<'_>, dictionary: &[u8], raw: &mut [u8]) -> Option<()> {
        let mut decoder = zstd::bulk::Decompressor::with_dictionary(dictionary).ok()?;
        let decoded = decoder.decompress_to_buffer(frame.bytes, raw);
        (decoded.ok()? == raw.len()).then_some(())
    }
}

/// The decoder in Rust, for targets without a C compiler.
#[cfg(any(test, not(feature = "zstd")))]
pub(super) mod ruzstd_decoder {
    use std::io::{self, Read};

    use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

    use super::Frame;
    use crate::packing::zstd_frame::MAX_BLOCK_BYTES;

    /// Magic number and a descriptor that says: one segment, its size, which
    /// is the window, in eight bytes.
    const HEAD: [u8; 5] = [0x28, 0xB5, 0x2F, 0xFD, 0xE0];

    /// Fills `raw`; `None` unless the frame holds just as many bytes.
    ///
    /// The decoder is given the blocks behind a head of our own, whose window is the whole content
    /// whatever the frame's head says. A match may then reach back to the first byte, as it may for
    /// the C library, which decodes into the one piece of memory and looks at no window. The C
    /// library refuses blocks larger than a small window; here they pass, and the hash decides.
    ///
    /// The dictionary goes before the blocks, as blocks of bytes as they are: matches reach it, and
    /// such blocks change no state.
    pub(crate) fn decode(frame: &Frame<'_>, dictionary: &[u8], raw: &mut [u8]) -> Option<()> {
        let unpacked = dictionary.len().checked_add(raw.len())?;
        let window_bytes = (unpacked as u64).to_le_bytes();
        let before = blocks(dictionary);
        let mut source = HEAD.chain(window_bytes.as_slice());
        let mut decoder = FrameDecoder::new();
        // The caller's limits allow the raw length; the decoder's own, 100 MiB, is not asked.
        decoder.set_max_window_size(u64::MAX);
        decoder.init(&mut source).ok()?;
        let mut source = before.chain(frame.blocks);
        let one = || BlockDecodingStrategy::UptoBlocks(1);
        while !decoder.decode_blocks(&mut source, one()).ok()? {
            // What lies beyond the window can be collected. A frame that holds more than it says
            // is found within one block too many.
            if decoder.can_collect() > 0 {
                return None;
            }
        }
        if decoder.can_collect() != unpacked {
            return None;
        }
        let mut first = decoder.by_ref().take(dictionary.len() as u64);
        io::copy(&mut first, &mut io::sink()).ok()?;
        decoder.read_exact(raw).ok()?;
        let agrees = |expected| decoder.get_calculated_checksum() == Some(expected);
        frame.checksum.is_none_or(agrees).then_some(())
    }

    /// Blocks of bytes as they are, none of them the last. The head of a block is 24 bits: last, kind
    /// (two bits), size.
    fn blocks(bytes: &[u8]) -> impl Read {
        let most = usize::try_from(MAX_BLOCK_BYTES).unwrap_or(usize::MAX);
        let mut blocks = Vec::with_capacity(bytes.len() + 3 * bytes.len().div_ceil(most));
        for block in bytes.chunks(most) {
            blocks.extend_from_slice(&(block.len() << 3).to_le_bytes()[..3]);
            blocks.extend_from_slice(block);
        }
        io::Cursor::new(blocks)
    }
}

/// Zeroed elements of `bytes` in all, in one piece. The caller has checked `bytes` against its
/// budgets; what the machine does not have is refused where `vec!` would abort.
pub(crate) fn allocate<T: Pod>(bytes: u64) -> Result<Vec<T>, Refusal> {
    let size = size_of::<T>() as u64;
    if !bytes.is_multiple_of(size) {
        let message = format!("{bytes} bytes are no whole number of {size}-byte records");
        return Err((issue::RECORD_LENGTH, message));
    }
    let refuse = || (issue::MEMORY, format!("{bytes} bytes"));
    let count = usize::try_from(bytes / size).map_err(|_| refuse())?;
    let mut memory: Vec<T> = Vec::new();
    memory.try_reserve_exact(count).map_err(|_| refuse())?;
    drop(memory);
    // Asked for anew: so the system gives memory that is zero already, and no page of it is written
    // twice.
    Ok(vec![T::zeroed(); count])
}

#[cfg(test)]
#[path = "unpack_tests.rs"]
mod tests;
