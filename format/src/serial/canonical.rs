//! The one seam to bincode: fixed-width little-endian integers, every byte consumed, and only the
//! encoding that we would write ourselves.
//!
//! bincode trusts the length of a string and allocates that much, unless a limit forbids it. The
//! limit is a constant of the type, so it is the next power of 16 above the length of the input. It
//! bounds neither zero-sized elements nor recursion: no type here has either.

use bincode::config::{Configuration, Fixint, LittleEndian};
use serde::{Serialize, de::DeserializeOwned};

const CONFIG: Configuration<LittleEndian, Fixint> =
    bincode::config::standard().with_fixed_int_encoding();

/// Decodes a whole slice; the error is a sentence.
pub(crate) fn decode<T: Serialize + DeserializeOwned>(bytes: &[u8]) -> Result<T, String> {
    let (value, used) = match bytes.len() {
        0..=0x1000 => decode_within::<T, 0x1000>(bytes)?,
        0x1001..=0x1_0000 => decode_within::<T, 0x1_0000>(bytes)?,
        0x1_0001..=0x10_0000 => decode_within::<T, 0x10_0000>(bytes)?,
        0x10_0001..=0x100_0000 => decode_within::<T, 0x100_0000>(bytes)?,
        0x100_0001..=0x1000_0000 => decode_within::<T, 0x1000_0000>(bytes)?,
        more => return Err(format!("{more} bytes are more than 256 MiB")),
    };
    if used != bytes.len() {
        return Err(format!("{} bytes left over", bytes.len() - used));
    }
    // One value, one encoding: a file that is read and written again keeps its bytes.
    if encode(&value) != bytes {
        return Err("not the canonical encoding".to_owned());
    }
    Ok(value)
}

fn decode_within<T: DeserializeOwned, const LIMIT: usize>(
    bytes: &[u8],
) -> Result<(T, usize), String> {
    bincode::serde::decode_from_slice(bytes, CONFIG.with_limit::<LIMIT>())
        .map_err(|error| error.to_string())
}

/// Encodes a value of ours.
pub(crate) fn encode<T: Serialize>(value: &T) -> Vec<u8> {
    bincode::serde::encode_to_vec(value, CONFIG)
        .expect("writing plain structs to a Vec has no way to fail")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_string_is_not_allocated_on_its_word() {
        let bytes = u64::MAX.to_le_bytes();
        assert!(decode::<String>(&bytes).is_err());
        let bytes = (1_u64 << 40).to_le_bytes();
        assert!(decode::<(String, u32)>(&bytes).is_err());
    }

    #[test]
    fn an_input_may_fill_its_limit() {
        for length in [0x1000, 0x1001, 0x1_0000, 0x1_0001] {
            let text = "x".repeat(length - 8);
            let bytes = encode(&text);
            assert_eq!(bytes.len(), length);
            assert_eq!(decode::<String>(&bytes), Ok(text));
        }
    }

    #[test]
    fn every_byte_counts() {
        assert_eq!(decode::<bool>(&[1]), Ok(true));
        assert!(decode::<bool>(&[2]).is_err());
        assert_eq!(decode::<bool>(&[1, 0]), Err("1 bytes left over".to_owned()));
        assert!(decode::<bool>(&[]).is_err());
    }
}
