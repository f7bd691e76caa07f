//! Stored bytes to raw bytes, into memory of just their length.

use bytemuck::Pod;

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
            decode_frame(&frame, raw)?
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

/// `None` when the blocks do not unpack to the content.
fn decode_frame(frame: &Frame<'_>, raw: &mut [u8]) -> Result<Option<()>, Refusal> {
    // Decoders differ in what they make of another length, so none of them sees one.
    if frame.content_bytes != Some(raw.len() as u64) {
        let bytes = raw.len();
        let message = format!("the frame does not say that it holds {bytes} bytes");
        return Err((issue::FRAME, message));
    }
    #[cfg(feature = "zstd")]
    let decoded = zstd_decoder::decode(frame, raw);
    #[cfg(not(feature = "zstd"))]
    let decoded = ruzstd_decoder::decode(frame, raw);
    Ok(decoded)
}

/// The C library.
#[cfg(any(test, feature = "zstd"))]
mod zstd_decoder {
    use super::Frame;

    /// Fills `raw`; `None` unless the frame holds just as many bytes.
    pub(super) fn decode(frame: &Frame<'_>, raw: &mut [u8]) -> Option<()> {
        let decoded = zstd::bulk::decompress_to_buffer(frame.bytes, raw);
        (decoded.ok()? == raw.len()).then_some(())
    }
}

/// The decoder in Rust, for targets without a C compiler.
#[cfg(any(test, not(feature = "zstd")))]
mod ruzstd_decoder {
    use std::io::Read;

    use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

    use super::Frame;

    /// Magic number and a descriptor that says: one segment, its size, which
    /// is the window, in eight bytes.
    const HEAD: [u8; 5] = [0x28, 0xB5, 0x2F, 0xFD, 0xE0];

    /// Fills `raw`; `None` unless the frame holds just as many bytes.
    ///
    /// The decoder is given the blocks behind a head of our own, whose window is the whole content
    /// whatever the frame's head says. A match may then reach back to the first byte, as it may for
    /// the C library, which decodes into the one piece of memory and looks at no window. The C
    /// library refuses blocks larger than a small window; here they pass, and the hash decides.
    pub(super) fn decode(frame: &Frame<'_>, raw: &mut [u8]) -> Option<()> {
        let window = raw.len() as u64;
        let window_bytes = window.to_le_bytes();
        let mut source = HEAD.chain(window_bytes.as_slice()).chain(frame.blocks);
        let mut decoder = FrameDecoder::new();
        // The caller's limits allow the raw length; the decoder's own, 100 MiB, is not asked.
        decoder.set_max_window_size(u64::MAX);
        decoder.init(&mut source).ok()?;
        let one = || BlockDecodingStrategy::UptoBlocks(1);
        while !decoder.decode_blocks(&mut source, one()).ok()? {
            // What lies beyond the window can be collected. A frame that holds more than it says
            // is found within one block too many.
            if decoder.can_collect() > 0 {
                return None;
            }
        }
        if decoder.can_collect() != raw.len() {
            return None;
        }
        decoder.read_exact(raw).ok()?;
        let agrees = |expected| decoder.get_calculated_checksum() == Some(expected);
        frame.checksum.is_none_or(agrees).then_some(())
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
