//! Stored bytes to raw bytes, into memory of just their length.

use bytemuck::Pod;

use super::frame::Frame;
use crate::container::issue::{self, IssueKind};
use crate::container::section::{Codec, SectionInfo};

/// Why a section's bytes could not be had.
pub(crate) type Refusal = (IssueKind, String);

/// Unpacks a section into memory of just its raw length.
pub(crate) fn unpack(section: &SectionInfo, stored: &[u8], raw: &mut [u8]) -> Result<(), Refusal> {
    match section.codec {
        // The directory holds raw sections to equal lengths.
        Codec::Raw => raw.copy_from_slice(stored),
        Codec::Zstd => unpack_frame(stored, raw).map_err(|message| (issue::FRAME, message))?,
        Codec::Unknown(number) => return Err((issue::CODEC, format!("codec {number}"))),
    }
    if *blake3::hash(raw).as_bytes() != section.hash {
        let message = "the raw bytes are not those that were written";
        return Err((issue::HASH, message.to_owned()));
    }
    Ok(())
}

/// Both decoders see only what [`Frame::parse`] lets through, and their own words are dropped: so
/// a file has the same issues with either.
fn unpack_frame(stored: &[u8], raw: &mut [u8]) -> Result<(), String> {
    let frame = Frame::parse(stored)?;
    if frame.content_bytes != Some(raw.len() as u64) {
        return Err(format!(
            "the frame does not say that it holds {} bytes",
            raw.len()
        ));
    }
    #[cfg(feature = "zstd")]
    let decoded = zstd_decoder::decode(&frame, raw);
    #[cfg(not(feature = "zstd"))]
    let decoded = ruzstd_decoder::decode(&frame, raw);
    decoded.ok_or_else(|| "the blocks of the frame do not hold its content".to_owned())
}

/// The C library.
#[cfg(feature = "zstd")]
mod zstd_decoder {
    use super::Frame;

    /// Fills `raw`; `None` unless the frame holds just as many bytes.
    pub(super) fn decode(frame: &Frame<'_>, raw: &mut [u8]) -> Option<()> {
        let decoded = zstd::bulk::decompress_to_buffer(frame.bytes, raw);
        (decoded.ok()? == raw.len()).then_some(())
    }
}

/// The decoder in Rust, for targets without a C compiler.
#[cfg(all(feature = "ruzstd", any(test, not(feature = "zstd"))))]
mod ruzstd_decoder {
    use std::io::Read;

    use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

    use super::Frame;

    /// Magic number and a descriptor that says: one segment, eight bytes of content size.
    const HEAD: [u8; 5] = [0x28, 0xB5, 0x2F, 0xFD, 0xE0];

    /// Fills `raw`; `None` unless the frame holds just as many bytes.
    ///
    /// The decoder is given the blocks behind a head of our own, of a single segment, whatever the
    /// frame's own head says:
    /// - The window is then the content. A match may reach back to the first byte, as it may for
    ///   the C library, which decodes into the one piece of memory and does not look at the window.
    /// - The decoder's buffer offers bytes before the last block only when it holds more than its
    ///   window: that is how a frame that holds more than it says is found after one block too
    ///   many, and memory stays below twice the content, whatever window the frame asks for.
    pub(super) fn decode(frame: &Frame<'_>, raw: &mut [u8]) -> Option<()> {
        let length = (raw.len() as u64).to_le_bytes();
        let mut source = HEAD.chain(length.as_slice()).chain(frame.blocks);
        let mut decoder = FrameDecoder::new();
        // The caller's limits allow the raw length; the decoder's own, 100 MiB, is not asked.
        decoder.set_max_window_size(u64::MAX);
        decoder.init(&mut source).ok()?;
        let one = || BlockDecodingStrategy::UptoBlocks(1);
        while !decoder.decode_blocks(&mut source, one()).ok()? {
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
    let mut elements = Vec::new();
    elements.try_reserve_exact(count).map_err(|_| refuse())?;
    elements.resize(count, T::zeroed());
    Ok(elements)
}
