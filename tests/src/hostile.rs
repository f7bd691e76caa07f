//! `.vtex` files that are small and ask for much: time, or memory.
//!
//! They are made section by section, as docs/format.md lays them out, because the writer refuses some
//! of them and would need the memory that others ask for. All but `tests52` break no rule.

use std::io::Write as _;

use vtex_format::{
    CurveLattice, Features, Grid, RecordParts, SHADER_ABI, StoredOutline, StoredOutlines,
    StoredSegment,
};

/// A file.
#[derive(Debug)]
pub struct Hostile {
    /// Name without extension.
    pub name: &'static str,
    /// What it asks for.
    pub what: &'static str,
    make: fn() -> Vec<u8>,
}

impl Hostile {
    /// The bytes of the file.
    pub fn bytes(&self) -> Vec<u8> {
        (self.make)()
    }
}

/// All of them.
pub const HOSTILE: [Hostile; 6] = [
    Hostile {
        name: "full512",
        what: "512 x 512 cells name one list of 4,096 entries",
        make: full512,
    },
    Hostile {
        name: "z4",
        what: "4 x 4 cells name one list of eight records with 4,094 segments each",
        make: z4,
    },
    Hostile {
        name: "chain8192",
        what: "8,192 records of one outline with 2,046 segments",
        make: chain8192,
    },
    Hostile {
        name: "entr512",
        what: "512 MiB of entries",
        make: entr512,
    },
    Hostile {
        name: "img14k",
        what: "an image of 14,100 x 14,100 texels",
        make: img14k,
    },
    Hostile {
        name: "tests52",
        what: "2,704 lists that share one row of thousands of nested branches",
        make: tests52,
    },
];

/// The raw bytes of a section: some, then others again and again.
struct Content {
    tag: [u8; 4],
    start: Vec<u8>,
    pattern: Vec<u8>,
    count: usize,
}

fn section(tag: [u8; 4], bytes: Vec<u8>) -> Content {
    repeated(tag, bytes, &[], 0)
}

fn repeated(tag: [u8; 4], start: Vec<u8>, pattern: &[u8], count: usize) -> Content {
    Content {
        tag,
        start,
        pattern: pattern.to_vec(),
        count,
    }
}

fn bytes_of(words: impl IntoIterator<Item = u32>) -> Vec<u8> {
    words.into_iter().flat_map(u32::to_le_bytes).collect()
}

/// Bytes that a section's pattern is written in.
const RUN_BYTES: usize = 1 << 20;

impl Content {
    fn raw_bytes(&self) -> usize {
        self.start.len() + self.pattern.len() * self.count
    }

    /// The zstd frame and the hash, without the raw bytes in memory.
    fn pack(&self) -> (Vec<u8>, [u8; 16]) {
        let mut encoder = zstd::Encoder::new(Vec::new(), 3).expect("a level that zstd has");
        encoder
            .set_pledged_src_size(Some(self.raw_bytes() as u64))
            .expect("nothing is written yet");
        let mut hasher = blake3::Hasher::new();
        let mut write = |bytes: &[u8]| {
            hasher.update(bytes);
            encoder.write_all(bytes).expect("memory takes it");
        };
        write(&self.start);
        let mut left = self.count;
        let run = self.pattern.repeat(RUN_BYTES / self.pattern.len().max(1));
        while left > 0 {
            let length = run.len().min(left * self.pattern.len());
            write(&run[..length]);
            left -= length / self.pattern.len();
        }
        let frame = encoder.finish().expect("memory takes it");
        let hash = hasher.finalize();
        (frame, hash.as_bytes()[..16].try_into().expect("16 bytes"))
    }
}

/// Each section in a bundle of its own.
fn file(sections: &[Content]) -> Vec<u8> {
    let length = |bytes: usize| u32::try_from(bytes).expect("a length of 32 bits");
    let (mut table, mut payload) = (Vec::new(), Vec::new());
    for section in sections {
        let (frame, hash) = section.pack();
        let critical = section.tag != *b"SHDR";
        table.extend(section.tag);
        table.push(u8::from(critical));
        table.extend(length(section.raw_bytes()).to_le_bytes());
        table.push(1);
        table.extend(length(frame.len()).to_le_bytes());
        table.extend(hash);
        payload.extend(frame);
    }
    let mut head = b"\x89VTX\r\n\x1a\n\x02\0\0\0".to_vec();
    head.extend(length(sections.len()).to_le_bytes());
    head.extend(((40 + table.len() + payload.len()) as u64).to_le_bytes());
    head.extend([0; 16]);
    let checksum = blake3::hash(&[head.as_slice(), &table].concat());
    head[24..].copy_from_slice(&checksum.as_bytes()[..16]);
    [head, table, payload].concat()
}

/// Units along a cell and the margin.
const LATTICE: [u32; 2] = [52_428, 6_553];

/// `META` of a square grid, half a cell larger than the canvas of 32 units a cell.
fn meta(side: u32, curves: bool) -> Content {
    let cells = side as f32 - 0.5;
    let floats = |values: &[f32]| bytes_of(values.iter().map(|value| value.to_bits()));
    let mut bytes = floats(&[32.0 * cells, 32.0 * cells]);
    bytes.extend(bytes_of([side, side]));
    bytes.extend(floats(&[cells, cells, 0.25, 0.25]));
    bytes.extend(bytes_of([8]));
    bytes.extend(floats(&[4.0, 64.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]));
    bytes.extend([0; 8]);
    bytes.extend(floats(&[1.0 / 64.0]));
    // No mask, no distance outline.
    bytes.extend([0, 0, u8::from(curves)]);
    if curves {
        bytes.extend(bytes_of(LATTICE));
    }
    section(*b"META", bytes)
}

fn spec(features: u32) -> Content {
    section(*b"SPEC", bytes_of([SHADER_ABI, features, 0, 0, 0, 0, 0, 0]))
}

/// An opaque paint and a translucent one.
fn paints() -> Content {
    let color = |alpha: f32| [1.0, 0.5, 0.0, alpha].map(f32::to_bits);
    let solid = |alpha| [[0; 4], color(alpha)].concat();
    section(*b"PANT", bytes_of([solid(1.0), solid(0.5)].concat()))
}

/// A shader without text.
fn shader() -> Content {
    section(*b"SHDR", bytes_of([SHADER_ABI, 0, 0, 0]))
}

/// Cells of which each names the first list; as stored, the second and later ones count back over it.
fn cells(count: usize, list_words: u32) -> Content {
    let list = 2 << 30;
    let back = list | 0_u32.wrapping_sub(list_words) & ((list >> 1) - 1);
    repeated(*b"CELL", bytes_of([list]), &back.to_le_bytes(), count - 1)
}

/// Entries of the same record: as stored, the second and later ones count back over it.
fn entries(head: u32, last: u32, count: usize, record_words: u32) -> Content {
    let back = 0_u32.wrapping_sub(record_words);
    let middle = [head, back].repeat(count - 2);
    let words = [&[head, 0], middle.as_slice(), &[last, back]].concat();
    section(*b"ENTR", bytes_of(words))
}

const LAST: u32 = 1 << 27;
const CURVES: u32 = 2 << 28;
const BRANCH: u32 = 4 << 28;

fn full512() -> Vec<u8> {
    let entry = |last| [last | 1, 0];
    let list = [[entry(0); 4_095].as_flattened(), &entry(LAST)].concat();
    let features = Features::LISTS | Features::TRANSLUCENT;
    file(&[
        meta(512, false),
        spec(features),
        paints(),
        cells(512 * 512, 8_192),
        section(*b"ENTR", bytes_of(list)),
        shader(),
    ])
}

fn z4() -> Vec<u8> {
    let (most, down) = (2_047, 1_000);
    let end = u32::MAX;
    let record = [
        vec![most | most << 11, down | down << 11],
        [0, end].repeat(most as usize),
        [0, 0x8000_8000, end].repeat(most as usize),
    ]
    .concat();
    let words = u32::try_from(record.len()).expect("a short record");
    file(&[
        meta(4, true),
        spec(Features::LISTS | Features::CURVES | Features::TRANSLUCENT),
        paints(),
        cells(16, 16),
        entries(CURVES | 1, CURVES | LAST | 1, 8, words),
        section(*b"CURV", bytes_of(record)),
        shader(),
    ])
}

fn entr512() -> Vec<u8> {
    let steps = 511;
    let record = [steps << 22, 0].into_iter();
    let record = record.chain((0..steps).map(|y| 1 << 16 | y));
    let entry = bytes_of([CURVES | LAST, 0_u32.wrapping_sub(2 + steps)]);
    file(&[
        meta(1, true),
        spec(Features::LISTS | Features::CURVES),
        paints(),
        cells(1, 0),
        repeated(
            *b"ENTR",
            bytes_of([CURVES | LAST, 0]),
            &entry,
            (512 << 20) / entry.len() - 1,
        ),
        section(*b"CURV", bytes_of(record)),
        shader(),
    ])
}

fn img14k() -> Vec<u8> {
    let (side, levels) = (14_100_u32, 15);
    let level_bytes = |level: u32| 4 * (side.div_ceil(1 << level) as usize).pow(2);
    // Levels of at most 64 texels share a section.
    let small: usize = (8..levels).map(level_bytes).sum();
    let lengths = [small].into_iter().chain((0..8).rev().map(level_bytes));
    let rectangle = [0.0, 0.0, 1.0, 1.0].map(f32::to_bits);
    let record = [rectangle, [side, side, levels, 0]].concat();
    let mut sections = vec![
        meta(1, false),
        spec(Features::MIPS),
        paints(),
        section(*b"IMAG", bytes_of(record)),
        section(*b"CELL", bytes_of([0])),
        shader(),
    ];
    sections.extend(lengths.map(|bytes| repeated(*b"MIPS", Vec::new(), &[0], bytes)));
    file(&sections)
}

fn tests52() -> Vec<u8> {
    // Half of the branches pass over equally many entries, the others have one target.
    let (count, record_words) = (4_095_u32, 4);
    let head = |at: u32| match at {
        0..2_047 => BRANCH | 2_046,
        at if at < count - 1 => BRANCH | (count - 1 - at),
        _ => LAST,
    };
    let data = |at: u32| match at {
        0 => 0,
        at if at < count - 1 => 0_u32.wrapping_sub(record_words),
        _ => 0,
    };
    let words = (0..count).flat_map(|at| [head(at), data(at)]);
    let list = 2 << 30;
    // As stored, each list counts from the end of the list before it, and begins one entry later.
    let starts = (0..52 * 52).map(|cell: u32| match cell {
        0 => list,
        cell => list | (2 * cell).wrapping_sub(2 * count) & ((list >> 1) - 1),
    });
    file(&[
        meta(52, true),
        spec(Features::LISTS | Features::CURVES | Features::CLIPS),
        paints(),
        section(*b"CELL", bytes_of(starts)),
        section(*b"ENTR", bytes_of(words)),
        section(*b"CURV", bytes_of([1, 1, 5, 0xFFFF_0005])),
        shader(),
    ])
}

fn chain8192() -> Vec<u8> {
    file(&[
        meta(1, true),
        spec(Features::LISTS | Features::CURVES),
        paints(),
        cells(1, 0),
        section(*b"ENTR", bytes_of([CURVES | LAST, 0])),
        section(*b"OUTL", chain(8_192, 1_023)),
        shader(),
    ])
}

/// Outlines of `count` records of the same outline, a chain of pairs of lines: each pair down the
/// middle of the cell.
fn chain(count: u32, pairs: u32) -> Vec<u8> {
    let x = 26_214;
    let line = |from, to| StoredSegment {
        from: [x, from],
        control: None,
        to: [x, to],
    };
    let pair = [line(100, 26_214), line(26_214, 52_328)];
    let one = StoredOutlines {
        flatness_units: 0.5,
        outlines: vec![StoredOutline {
            even_odd: false,
            segments: pair.repeat(pairs as usize),
        }],
        records: vec![RecordParts {
            cell: 0,
            outlines: vec![0],
        }],
    };
    let lattice = CurveLattice {
        units_per_cell: LATTICE[0],
        margin_units: LATTICE[1],
    };
    let grid = Grid {
        cell_from_uv_scale: [0.5; 2],
        cell_from_uv_offset: [0.25; 2],
        ..Grid::new([1, 1], 8)
    };
    let record = one
        .records(&grid, lattice)
        .expect("an outline that can be cut");
    let record_words = u32::try_from(record.len()).expect("a short record");
    let record = bytes_of(record);
    let mut hasher = blake3::Hasher::new();
    for _ in 0..count {
        hasher.update(&record);
    }
    let mut bytes = bytes_of([
        count * record_words,
        2 * pairs,
        count,
        count,
        one.flatness_units.to_bits(),
    ]);
    bytes.extend(&hasher.finalize().as_bytes()[..16]);
    // The outline begins with a contour, the others have the second bit alone.
    bytes.extend([10, 0]);
    bytes.extend([2, 0].repeat(pairs as usize - 1));
    // In the order in which segments need them: a move before each pair, an end for each line.
    let (mut digits, mut moves) = (Vec::new(), Vec::new());
    let end = [0, 26_114];
    for pair in 0..pairs {
        let start = if pair == 0 {
            [x, 100]
        } else {
            [0, 100 - 52_328]
        };
        moves.push(vector(start, &mut digits));
        vector(end, &mut digits);
        vector(end, &mut digits);
    }
    bytes.extend(moves);
    bytes.extend(vec![vector(end, &mut Vec::new()); 2 * pairs as usize]);
    // Cell 0, one outline, outline 0.
    bytes.extend(vec![0; count as usize]);
    bytes.extend(vec![1; count as usize]);
    bytes.extend(vec![0; count as usize]);
    let byte = |bits: &[bool]| {
        let bits = bits.iter().rev();
        bits.fold(0, |byte, &bit| byte << 1 | u8::from(bit))
    };
    bytes.extend(digits.chunks(8).map(byte));
    bytes
}

/// The byte of a vector of `OUTL`: the sizes of its coordinates. The digits below their leading one go
/// to the string of bits, lowest first; a size of 15 or more stands there too.
fn vector(coordinates: [i32; 2], digits: &mut Vec<bool>) -> u8 {
    let mut put = |number: u32, count: u32| {
        digits.extend((0..count).map(|bit| number >> bit & 1 != 0));
    };
    let halves = coordinates.map(|coordinate| {
        let number = (coordinate << 1 ^ coordinate >> 31).cast_unsigned();
        let size = u32::BITS - number.leading_zeros();
        if size >= 15 {
            put(size, 6);
        }
        put(number, size.saturating_sub(1));
        u8::try_from(size.min(15)).expect("four bits")
    });
    halves[0] | halves[1] << 4
}
