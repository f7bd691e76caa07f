//! Records of 32-bit words between this machine and the file, which is little-endian.

use std::borrow::Cow;

use bytemuck::Pod;

/// Records of 32-bit words as this machine has them; nothing to do on a little-endian one.
pub(crate) fn words_from_little_endian<T: Pod>(records: &mut [T]) {
    for word in bytemuck::cast_slice_mut::<T, u32>(records) {
        *word = u32::from_le(*word);
    }
}

/// Records of 32-bit words as little-endian bytes.
pub(crate) fn words_to_little_endian<T: Pod>(records: &[T]) -> Cow<'_, [u8]> {
    // Sections can be large: nothing is copied where memory is like the file.
    if cfg!(target_endian = "little") {
        return Cow::Borrowed(bytemuck::cast_slice(records));
    }
    let words = bytemuck::cast_slice::<T, u32>(records);
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}
