//! Stored outlines to bytes and back: planes of like bytes one after the other, then the digits.

use super::bits::{BitReader, BitWriter, unzigzag, zigzag};
use super::{OutlineError, RecordParts, StoredOutline, StoredOutlines, StoredSegment};

/// Bits of a segment's kind.
const QUADRATIC: u8 = 1;
/// Its first end is not the last one of the segment before.
const MOVE: u8 = 2;
/// Its last end is the contour's first point.
const CLOSE: u8 = 4;
/// It is the first of an outline.
const OUTLINE: u8 = 8;
/// The outline that it begins is even-odd.
const EVEN_ODD: u8 = 16;

/// Words before the planes.
const HEAD_WORDS: usize = 5;
/// Leading bytes of the blake3 of the records, behind those words.
const CHECKSUM_BYTES: usize = 16;

/// What a stream says of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Head {
    /// Words of all records.
    pub(crate) words: u32,
    segments: u32,
    records: u32,
    parts: u32,
    flatness_units: f32,
    checksum: [u8; CHECKSUM_BYTES],
}

impl Head {
    /// Memory that reading takes, in bytes, before the words themselves.
    pub(crate) fn memory_bytes(&self) -> u64 {
        // Of the row that is cut: its segments, a number for each, and two steps.
        let rows = size_of::<crate::curves::cut::Segment>() as u64 + 20;
        // The head does not say how many outlines there are: at worst one a segment.
        let segment = size_of::<StoredSegment>() as u64 + size_of::<StoredOutline>() as u64;
        // Plus the record's cell and count, held while the planes are read.
        let record = size_of::<RecordParts>() as u64 + 16;
        u64::from(self.segments) * (segment + rows)
            + u64::from(self.records) * record
            + u64::from(self.parts) * 4
            + u64::from(self.words) * 4
    }

    /// Whether `words` are the records that the writer had.
    pub(crate) fn vouches_for(&self, words: &[u32]) -> bool {
        words.len() as u64 == u64::from(self.words) && checksum(words) == self.checksum
    }
}

fn checksum(words: &[u32]) -> [u8; CHECKSUM_BYTES] {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&crate::container::words::words_to_little_endian(words));
    let mut bytes = [0; CHECKSUM_BYTES];
    bytes.copy_from_slice(&hasher.finalize().as_bytes()[..CHECKSUM_BYTES]);
    bytes
}

/// The pen that both directions move alike: what is stored is how far it is from its prediction.
#[derive(Clone, Copy, Debug, Default)]
struct Pen {
    at: [i64; 2],
    /// First point of the contour.
    start: [i64; 2],
    /// From the last control point, or the last line's first end, to [`Pen::at`].
    tangent: [i64; 2],
}

impl Pen {
    fn begin(&mut self, at: [i64; 2]) {
        *self = Self {
            at,
            start: at,
            tangent: [0; 2],
        };
    }

    /// The way to a control point of which `major` is known along the tangent's longer axis:
    /// smooth outlines go on along the tangent.
    fn along_tangent(&self, axis: usize, major: i64) -> [i64; 2] {
        let [along, across] = [self.tangent[axis], self.tangent[1 - axis]];
        let minor = rounded_quotient(i128::from(major) * i128::from(across), along);
        let mut way = [major; 2];
        way[1 - axis] = minor;
        way
    }

    /// The axis along which the tangent is longer; `None` without a tangent.
    fn major_axis(&self) -> Option<usize> {
        let [x, y] = self.tangent.map(i64::unsigned_abs);
        (x != 0 || y != 0).then_some(usize::from(x < y))
    }

    /// How far the way to a control point is from its prediction.
    fn residual(&self, way: [i64; 2]) -> [i64; 2] {
        let Some(axis) = self.major_axis() else {
            return way;
        };
        let predicted = self.along_tangent(axis, way[axis]);
        let mut residual = [0; 2];
        residual[axis] = way[axis].wrapping_sub(self.tangent[axis]);
        residual[1 - axis] = way[1 - axis].wrapping_sub(predicted[1 - axis]);
        residual
    }

    /// The inverse of [`Pen::residual`].
    fn way(&self, residual: [i64; 2]) -> [i64; 2] {
        let Some(axis) = self.major_axis() else {
            return residual;
        };
        let major = residual[axis].wrapping_add(self.tangent[axis]);
        let mut way = self.along_tangent(axis, major);
        way[1 - axis] = way[1 - axis].wrapping_add(residual[1 - axis]);
        way
    }

    fn advance(&mut self, segment: &StoredSegment) {
        let corner = segment.control.unwrap_or(segment.from);
        self.at = wide(segment.to);
        self.tangent = minus(self.at, wide(corner));
        // The control point may lie on the end; then the curve arrives along its chord.
        if self.tangent == [0; 2] {
            self.tangent = minus(self.at, wide(segment.from));
        }
    }
}

/// `n / d` to the nearest integer, halves upwards; 0 for a quotient that no coordinate has.
fn rounded_quotient(n: i128, d: i64) -> i64 {
    let d = i128::from(d);
    let (n, d) = if d < 0 { (-n, -d) } else { (n, d) };
    let quotient = (2 * n + d).div_euclid((2 * d).max(1));
    i64::try_from(quotient).unwrap_or(0)
}

fn wide(point: [i32; 2]) -> [i64; 2] {
    point.map(i64::from)
}

fn minus(a: [i64; 2], b: [i64; 2]) -> [i64; 2] {
    [a[0].wrapping_sub(b[0]), a[1].wrapping_sub(b[1])]
}

fn plus(a: [i64; 2], b: [i64; 2]) -> [i64; 2] {
    // A damaged stream can name any number; `narrow` refuses what is no coordinate.
    [a[0].wrapping_add(b[0]), a[1].wrapping_add(b[1])]
}

/// A lattice point again; `None` for one that no outline has.
fn narrow(point: [i64; 2]) -> Option<[i32; 2]> {
    Some([i32::try_from(point[0]).ok()?, i32::try_from(point[1]).ok()?])
}

#[derive(Debug, Default)]
struct Planes {
    kinds: Vec<u8>,
    moves: Vec<u8>,
    controls: Vec<u8>,
    ends: Vec<u8>,
    digits: BitWriter,
}

impl Planes {
    fn segment(&mut self, pen: &mut Pen, segment: &StoredSegment, outline: u8) {
        let mut kind = outline;
        if outline != 0 || pen.at != wide(segment.from) {
            kind |= MOVE;
            let way = minus(wide(segment.from), pen.at);
            self.moves.push(self.digits.vector(way));
            pen.begin(wide(segment.from));
        }
        // The last segment of a contour ends at its start, which takes no vector.
        let closes = wide(segment.to) == pen.start;
        if closes {
            kind |= CLOSE;
        }
        let mut end = minus(wide(segment.to), pen.at);
        if let Some(control) = segment.control {
            kind |= QUADRATIC;
            let way = minus(wide(control), pen.at);
            self.controls.push(self.digits.vector(pen.residual(way)));
            // Halves of a smooth curve are about as long.
            end = minus(minus(end, way), way);
        }
        if !closes {
            self.ends.push(self.digits.vector(end));
        }
        self.kinds.push(kind);
        pen.advance(segment);
    }
}

/// The bytes of `OUTL`; `words` are the records made from `stored`.
pub(crate) fn encode(stored: &StoredOutlines, words: &[u32]) -> Vec<u8> {
    let mut planes = Planes::default();
    let mut pen = Pen::default();
    for outline in &stored.outlines {
        let rule = if outline.even_odd { EVEN_ODD } else { 0 };
        let mut first = OUTLINE | rule;
        for segment in &outline.segments {
            planes.segment(&mut pen, segment, std::mem::take(&mut first));
        }
    }
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let parts = stored.records.iter().map(|record| record.outlines.len());
    let head: [u32; HEAD_WORDS] = [
        count(words.len()),
        count(planes.kinds.len()),
        count(stored.records.len()),
        count(parts.sum()),
        stored.flatness_units.to_bits(),
    ];
    let mut bytes: Vec<u8> = head.iter().flat_map(|word| word.to_le_bytes()).collect();
    bytes.extend(checksum(words));
    for plane in [planes.kinds, planes.moves, planes.controls, planes.ends] {
        bytes.extend(plane);
    }
    bytes.extend(record_planes(&stored.records));
    bytes.extend(planes.digits.into_bytes());
    bytes
}

/// Steps from cell to cell, numbers of outlines, and steps from outline to outline.
fn record_planes(records: &[RecordParts]) -> Vec<u8> {
    let (mut cells, mut counts, mut outlines) = (Vec::new(), Vec::new(), Vec::new());
    let (mut cell, mut outline) = (0, 0);
    for record in records {
        put_varint(&mut cells, step(&mut cell, record.cell));
        put_varint(&mut counts, record.outlines.len() as u64);
        for &index in &record.outlines {
            put_varint(&mut outlines, step(&mut outline, index));
        }
    }
    [cells, counts, outlines].concat()
}

fn step(from: &mut u32, to: u32) -> u64 {
    let step = i64::from(to) - i64::from(*from);
    *from = to;
    zigzag(step)
}

/// Seven bits a byte, lowest first; the top bit says that more follow.
fn put_varint(bytes: &mut Vec<u8>, mut value: u64) {
    loop {
        let [low, ..] = value.to_le_bytes();
        value >>= 7;
        if value == 0 {
            bytes.push(low & 0x7F);
            return;
        }
        bytes.push(low | 0x80);
    }
}

/// Takes a stream from its front.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], OutlineError> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or(OutlineError::Stream)?;
        self.0 = rest;
        Ok(taken)
    }

    fn word(&mut self) -> Result<u32, OutlineError> {
        let bytes = self.take(4)?.try_into().map_err(|_| OutlineError::Stream)?;
        Ok(u32::from_le_bytes(bytes))
    }

    fn varint(&mut self) -> Result<u64, OutlineError> {
        let mut value = 0;
        // Five bytes hold the 33 bits of a difference.
        for shift in (0..35).step_by(7) {
            let (&byte, rest) = self.0.split_first().ok_or(OutlineError::Stream)?;
            self.0 = rest;
            value |= u64::from(byte & 0x7F) << shift;
            if byte & 0x80 == 0 {
                return Ok(value);
            }
        }
        Err(OutlineError::Stream)
    }

    /// The index that is one step further.
    fn step(&mut self, from: &mut u32) -> Result<u32, OutlineError> {
        let to = i64::from(*from) + unzigzag(self.varint()?);
        *from = u32::try_from(to).map_err(|_| OutlineError::Stream)?;
        Ok(*from)
    }
}

/// Reads the head alone, so that its numbers can be held against budgets.
pub(crate) fn decode_head(bytes: &[u8]) -> Result<Head, OutlineError> {
    let mut bytes = Bytes(bytes);
    let head = Head {
        words: bytes.word()?,
        segments: bytes.word()?,
        records: bytes.word()?,
        parts: bytes.word()?,
        flatness_units: f32::from_bits(bytes.word()?),
        checksum: bytes
            .take(CHECKSUM_BYTES)?
            .try_into()
            .map_err(|_| OutlineError::Stream)?,
    };
    let flat = head.flatness_units.is_finite() && head.flatness_units >= 0.0;
    flat.then_some(head).ok_or(OutlineError::Stream)
}

/// Reads a whole stream; what it holds of memory stands in its head.
pub(crate) fn decode(bytes: &[u8]) -> Result<StoredOutlines, OutlineError> {
    let head = decode_head(bytes)?;
    let mut bytes = Bytes(bytes);
    bytes.take(4 * HEAD_WORDS + CHECKSUM_BYTES)?;
    let kinds = bytes.take(head.segments as usize)?;
    // The kinds say how long the planes behind them are.
    let count = |has: fn(u8) -> bool| kinds.iter().filter(|&&kind| has(kind)).count();
    let moves = bytes.take(count(|kind| kind & MOVE != 0))?;
    let controls = bytes.take(count(|kind| kind & QUADRATIC != 0))?;
    let ends = bytes.take(count(|kind| kind & CLOSE == 0))?;
    let records = decode_records(&mut bytes, head)?;
    let mut reader = Reader {
        moves: moves.iter(),
        controls: controls.iter(),
        ends: ends.iter(),
        digits: BitReader::new(bytes.0),
        pen: Pen::default(),
    };
    let outlines = reader.outlines(kinds).ok_or(OutlineError::Stream)?;
    if !reader.digits.is_at_end() {
        return Err(OutlineError::Stream);
    }
    Ok(StoredOutlines {
        flatness_units: head.flatness_units,
        outlines,
        records,
    })
}

fn decode_records(bytes: &mut Bytes<'_>, head: Head) -> Result<Vec<RecordParts>, OutlineError> {
    // Every record takes two bytes and every part one, so the stream's length bounds them.
    let least = 2 * u64::from(head.records) + u64::from(head.parts);
    if least > bytes.0.len() as u64 {
        return Err(OutlineError::Stream);
    }
    let mut cell = 0;
    let cells: Vec<u32> = (0..head.records)
        .map(|_| bytes.step(&mut cell))
        .collect::<Result<_, _>>()?;
    let counts: Vec<u64> = (0..head.records)
        .map(|_| bytes.varint())
        .collect::<Result<_, _>>()?;
    let total = counts.iter().fold(0, |sum: u64, &n| sum.saturating_add(n));
    if total != u64::from(head.parts) {
        return Err(OutlineError::Stream);
    }
    let mut outline = 0;
    let record = |(cell, count)| {
        let outlines = (0..count).map(|_| bytes.step(&mut outline));
        let outlines = outlines.collect::<Result<_, _>>()?;
        Ok(RecordParts { cell, outlines })
    };
    cells.into_iter().zip(counts).map(record).collect()
}

/// Only an outline's first segment says so and names the rule, and it begins a contour.
fn is_kind(kind: u8) -> bool {
    let all = QUADRATIC | MOVE | CLOSE | OUTLINE | EVEN_ODD;
    let begins = kind & OUTLINE != 0;
    kind & !all == 0 && (!begins || kind & MOVE != 0) && (begins || kind & EVEN_ODD == 0)
}

struct Reader<'a> {
    moves: std::slice::Iter<'a, u8>,
    controls: std::slice::Iter<'a, u8>,
    ends: std::slice::Iter<'a, u8>,
    digits: BitReader<'a>,
    pen: Pen,
}

impl Reader<'_> {
    fn outlines(&mut self, kinds: &[u8]) -> Option<Vec<StoredOutline>> {
        let mut outlines: Vec<StoredOutline> = Vec::new();
        for &kind in kinds {
            if !is_kind(kind) {
                return None;
            }
            if kind & OUTLINE != 0 {
                outlines.push(StoredOutline {
                    even_odd: kind & EVEN_ODD != 0,
                    segments: Vec::new(),
                });
            }
            let segment = self.segment(kind)?;
            // Fails where the first segment begins no outline.
            outlines.last_mut()?.segments.push(segment);
        }
        Some(outlines)
    }

    fn segment(&mut self, kind: u8) -> Option<StoredSegment> {
        if kind & MOVE != 0 {
            let way = self.digits.vector(*self.moves.next()?)?;
            self.pen.begin(plus(self.pen.at, way));
        }
        let mut to = self.pen.at;
        let mut control = None;
        if kind & QUADRATIC != 0 {
            let way = self.digits.vector(*self.controls.next()?)?;
            let way = self.pen.way(way);
            let corner = plus(self.pen.at, way);
            control = Some(narrow(corner)?);
            to = plus(corner, way);
        }
        let to = if kind & CLOSE != 0 {
            self.pen.start
        } else {
            plus(to, self.digits.vector(*self.ends.next()?)?)
        };
        let segment = StoredSegment {
            from: narrow(self.pen.at)?,
            control,
            to: narrow(to)?,
        };
        self.pen.advance(&segment);
        Some(segment)
    }
}
