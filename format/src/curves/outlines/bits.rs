//! Vectors of small integers. A byte holds the sizes of both coordinates, which packs well. The
//! digits below the leading ones are noise and are stored as they are.

/// Half a byte holds a smaller size. This one says that six bits before the digits hold the size.
const ESCAPE: u32 = 15;
const ESCAPE_BITS: u32 = 6;

/// Writes bits, lowest first.
#[derive(Debug, Default)]
pub(super) struct BitWriter {
    bytes: Vec<u8>,
    /// Bits of the last byte that are taken; 0 when it is full.
    used: u32,
}

impl BitWriter {
    fn put(&mut self, value: u64, count: u32) {
        for bit in 0..count {
            if self.used == 0 {
                self.bytes.push(0);
            }
            if let Some(last) = self.bytes.last_mut() {
                *last |= u8::from(value >> bit & 1 != 0) << self.used;
            }
            self.used = (self.used + 1) % 8;
        }
    }

    /// Writes the digits of a vector; returns the byte of its sizes.
    pub(super) fn vector(&mut self, vector: [i64; 2]) -> u8 {
        let mut byte = 0;
        for (axis, number) in vector.map(zigzag).into_iter().enumerate() {
            let size = u64::BITS - number.leading_zeros();
            // Six bits suffice: sums of a few 32-bit coordinates have fewer than 40 digits.
            if size >= ESCAPE {
                self.put(u64::from(size), ESCAPE_BITS);
            }
            // The leading one is known from the size.
            self.put(number, size.saturating_sub(1));
            byte |= size.min(ESCAPE) << (4 * axis);
        }
        u8::try_from(byte).unwrap_or(u8::MAX)
    }

    pub(super) fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}

/// Reads what [`BitWriter`] writes.
#[derive(Debug)]
pub(super) struct BitReader<'a> {
    bytes: &'a [u8],
    next: usize,
}

impl<'a> BitReader<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, next: 0 }
    }

    /// `None` past the end.
    fn take(&mut self, count: u32) -> Option<u64> {
        let (mut value, mut taken) = (0, 0);
        while taken < count {
            let byte = self.bytes.get(self.next / 8)?;
            let skipped = u32::try_from(self.next % 8).ok()?;
            let here = (8 - skipped).min(count - taken);
            let bits = u64::from(byte >> skipped) & ((1 << here) - 1);
            value |= bits << taken;
            taken += here;
            self.next += here as usize;
        }
        Some(value)
    }

    /// The vector whose sizes are `byte`; `None` past the end.
    pub(super) fn vector(&mut self, byte: u8) -> Option<[i64; 2]> {
        let mut axis = |half: u8| {
            let size = match u32::from(half & 15) {
                ESCAPE => u32::try_from(self.take(ESCAPE_BITS)?).ok()?,
                size => size,
            };
            let number = match size {
                0 => 0,
                size => 1 << (size - 1) | self.take(size - 1)?,
            };
            Some(unzigzag(number))
        };
        Some([axis(byte)?, axis(byte >> 4)?])
    }

    /// Whether no more than the rest of the last byte is left, and that is zero.
    pub(super) fn is_at_end(&self) -> bool {
        let rest = self.bytes.get(self.next.div_ceil(8)..);
        let last = self.next % 8;
        let padding = match last {
            0 => 0,
            used => self.bytes.get(self.next / 8).map_or(0, |byte| byte >> used),
        };
        rest.is_some_and(<[u8]>::is_empty) && padding == 0
    }
}

/// 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
pub(super) fn zigzag(number: i64) -> u64 {
    ((number << 1) ^ (number >> 63)).cast_unsigned()
}

/// The inverse of [`zigzag`].
pub(super) fn unzigzag(number: u64) -> i64 {
    (number >> 1).cast_signed() ^ -((number & 1).cast_signed())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_round_trip() {
        let numbers = [
            0,
            1,
            -1,
            127,
            -128,
            8_191,
            -8_192,
            8_192,
            1 << 33,
            -(1 << 33),
        ];
        let mut writer = BitWriter::default();
        let vectors: Vec<[i64; 2]> = numbers
            .iter()
            .flat_map(|&x| numbers.map(|y| [x, y]))
            .collect();
        let sizes: Vec<u8> = vectors.iter().map(|&v| writer.vector(v)).collect();
        let bytes = writer.into_bytes();
        let mut reader = BitReader::new(&bytes);
        for (vector, size) in vectors.iter().zip(sizes) {
            assert_eq!(reader.vector(size), Some(*vector));
        }
        assert!(reader.is_at_end(), "every bit is read");
        assert_eq!(reader.vector(0xFF), None, "nothing is read past the end");
    }

    #[test]
    fn zigzag_alternates() {
        assert_eq!([0, -1, 1, -2, 2].map(zigzag), [0, 1, 2, 3, 4]);
        assert_eq!(unzigzag(zigzag(i64::MIN)), i64::MIN);
    }
}
