//! The one seam to bincode: fixed-width little-endian integers, every byte consumed, and only the
//! encoding that we would write ourselves.
//!
//! bincode's limit bounds neither zero-sized elements nor recursion, so no type here has either.
//! Borrowed decoding checks a string's length against the slice before it allocates.

use bincode::config::{Configuration, Fixint, LittleEndian};
use serde::{Serialize, de::DeserializeOwned};

const CONFIG: Configuration<LittleEndian, Fixint> =
    bincode::config::standard().with_fixed_int_encoding();

/// Decodes a whole slice; the error is a sentence.
pub(crate) fn decode<T: Serialize + DeserializeOwned>(bytes: &[u8]) -> Result<T, String> {
    let (value, used) = bincode::serde::borrow_decode_from_slice::<T, _>(bytes, CONFIG)
        .map_err(|error| error.to_string())?;
    if used != bytes.len() {
        return Err(format!("{} bytes left over", bytes.len() - used));
    }
    if encode(&value) != bytes {
        return Err("not the canonical encoding".to_owned());
    }
    Ok(value)
}

/// Encodes a value of ours.
pub(crate) fn encode<T: Serialize>(value: &T) -> Vec<u8> {
    bincode::serde::encode_to_vec(value, CONFIG)
        .expect("writing plain structs to a Vec has no way to fail")
}
