//! A texture file in the manner of KTX2: an index of levels, each level a zstd frame of its own.

use anyhow::{Context as _, Result};

/// As KTX2: each level has an offset, a stored length and a raw length of eight bytes each.
const INDEX_BYTES: usize = 24;
const COUNT_BYTES: usize = 8;

/// Packs levels, the smallest first.
pub(crate) fn write(levels: &[Vec<u8>], effort: i32) -> Result<Vec<u8>> {
    let mut file = vec![0; COUNT_BYTES + INDEX_BYTES * levels.len()];
    file[..COUNT_BYTES].copy_from_slice(&(levels.len() as u64).to_le_bytes());
    for (level, raw) in levels.iter().enumerate().rev() {
        let stored = zstd::bulk::compress(raw, effort)?;
        let numbers = [file.len(), stored.len(), raw.len()].map(|n| n as u64);
        let index = numbers.map(u64::to_le_bytes);
        let at = COUNT_BYTES + INDEX_BYTES * level;
        file[at..at + INDEX_BYTES].copy_from_slice(index.as_flattened());
        file.extend(stored);
    }
    Ok(file)
}

/// The levels, the largest first: what an upload takes.
pub(crate) fn read(file: &[u8]) -> Result<Vec<Vec<u8>>> {
    let broken = "the texture file is broken";
    let number = |at: usize| -> Result<usize> {
        let bytes = file.get(at..at + 8).context(broken)?;
        Ok(usize::try_from(u64::from_le_bytes(bytes.try_into()?))?)
    };
    let mut decoder = zstd::bulk::Decompressor::new()?;
    let level = |level: usize| {
        let at = COUNT_BYTES + INDEX_BYTES * level;
        let [first, stored, raw] = [number(at)?, number(at + 8)?, number(at + 16)?];
        let frame = file.get(first..first + stored).context(broken)?;
        Ok(decoder.decompress(frame, raw)?)
    };
    (0..number(0)?).map(level).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_come_back() {
        let levels = vec![vec![7; 64], (0..16).collect::<Vec<u8>>(), vec![1]];
        let file = write(&levels, 3).unwrap();
        assert_eq!(read(&file).unwrap(), levels);
        assert!(read(&file[..40]).is_err());
    }
}
