//! For every issue there is, a file or a value that has it.
// tidy: long because it is one table of all issues.

use std::collections::BTreeSet;
use std::sync::Arc;

use vtex_format::{
    CurveLattice, DistanceOutline, Entry, EntryKind, Features, Grid, ISSUES, Image, Issue,
    LayerRecord, Limits, MsdfError, ReadError, SHADER_ABI, Tag, VtexFile, validate,
};

use crate::dictionaries::Base;
use crate::forge::{Forged, hash, put_together, seal, take_apart};
use crate::gradients::{GRADIENT_FILES, GRADIENT_VALUES};
use crate::grouped::{GROUPED_VALUES, grouped};
use crate::outlined::{OUTLINED_CASES, OUTLINED_VALUES};
use crate::sample;

/// A change to the sections of the sample, and the code of the issue it makes.
pub(crate) type FileCase = (u16, fn(&mut Vec<Forged>));
/// A change to the sample's bytes.
type ByteCase = (u16, fn(&mut Vec<u8>));
/// A change to the sample itself.
pub(crate) type ValueCase = (u16, fn(&mut VtexFile));

pub(crate) const META: usize = 0;
const SPEC: usize = 1;
const PROV: usize = 2;
const PANT: usize = 3;
const SHAP: usize = 5;
const IMAG: usize = 7;
const CELL: usize = 8;
const ENTR: usize = 9;
const CURV: usize = 10;
const SHDR: usize = 11;
const FINE: usize = 12;
const TILE: usize = 13;
const MIPS: usize = 14;

pub(crate) fn patch(section: &mut Forged, offset: usize, bytes: &[u8]) {
    let mut content = section.content();
    content[offset..offset + bytes.len()].copy_from_slice(bytes);
    section.refill(&content);
}

pub(crate) fn cut(section: &mut Forged, bytes: usize) {
    let content = section.content();
    section.refill(&content[..content.len() - bytes]);
}

fn pack(section: &mut Forged, bytes: &[u8]) {
    section.codec = 1;
    section.stored = zstd::bulk::compress(bytes, 3).unwrap();
}

/// As [`pack`], with a dictionary.
fn pack_with(section: &mut Forged, base: &Base, checksum: bool) {
    let content = section.content();
    section.codec = 2;
    section.stored = base.packed(&content, checksum);
}

const TABLE_CASES: &[FileCase] = &[
    (2001, |s| s[PROV].tag = *b"prov"),
    (2002, |s| s.push(Forged::raw(Tag(*b"NEWS"), b"1"))),
    (2003, |s| s[CELL].codec = 7),
    (2004, |s| s[PROV].flags = 1),
    (2004, |s| s[PROV].flags = 4),
    (2004, |s| s[META].share()),
    (2007, |s| s[CELL].stored_lie = Some(u32::MAX)),
    (2009, |s| {
        let last = s.last_mut().unwrap();
        last.stored_lie = Some(last.stored.len() as u32 - 1);
    }),
    (2011, |s| s[PANT].refill(&[])),
    (2011, |s| {
        s[PANT].refill(&[]);
        s[PANT].share();
    }),
    (2012, |s| s[CELL].raw_bytes += 1),
    (2012, |s| {
        s[CELL].stored_lie = Some(s[CELL].stored.len() as u32 - 1);
    }),
    (2012, |s| {
        s[ENTR].share();
        s[ENTR].raw_bytes += 1;
    }),
    (2013, |s| s.swap(PANT, SHAP)),
    (2013, |s| s.insert(PANT, s[PANT].clone())),
    (2014, |s| drop(s.remove(CELL))),
    (2014, |s| s.clear()),
    (2016, |s| s[ENTR].raw_bytes = u32::MAX),
    (2017, |s| s[CELL].codec = 1),
    (2017, |s| pack(&mut s[CELL], &[0; 20])),
    (2017, |s| {
        let content = s[CELL].content();
        pack(&mut s[CELL], &content);
        let frame = s[CELL].stored.clone();
        s[CELL].stored.extend(frame);
    }),
    (2017, |s| pack_with(&mut s[CELL], &Base::new(), true)),
    (2017, |s| {
        let base = Base::new();
        pack_with(&mut s[CELL], &base, false);
        s[CELL].stored.truncate(3);
    }),
    (2017, |s| {
        // A frame of more bytes than the section has.
        s[CELL].codec = 2;
        s[CELL].stored = Base::new().packed(&[7; 999], false);
    }),
    (2018, |s| s[TILE].hash[0] ^= 1),
    (2018, |s| {
        // Bytes that another dictionary gives.
        let mut other = Base::new();
        other.content.reverse();
        s[PROV].refill(&other.content[..400]);
        pack_with(&mut s[PROV], &other, false);
    }),
    (2021, |s| {
        s[FINE].refill(&[0; 40_000]);
        s[TILE].refill(&[0; 30_000]);
        s[TILE].share();
    }),
    (2023, |s| {
        let mut unknown = Base::new();
        unknown.id[0] ^= 1;
        pack_with(&mut s[CELL], &unknown, false);
    }),
];

const CONTENT_CASES: &[FileCase] = &[
    (3001, |s| s[META].refill(&[0; 2_000])),
    (3002, |s| s[PROV].refill(&[0; 20_000])),
    (3003, |s| s[SHDR].refill(&[0; 20_000])),
    (3004, |s| cut(&mut s[META], 1)),
    (3004, |s| patch(&mut s[META], 80, &[2])),
    (3004, |s| patch(&mut s[META], 68, &[4])),
    (3004, |s| s[PROV].refill(&[255; 200])),
    (3004, |s| patch(&mut s[PROV], 32, &u64::MAX.to_le_bytes())),
    (3004, |s| {
        let mut content = s[PROV].content();
        content.push(0);
        s[PROV].refill(&content);
    }),
    (3030, |s| cut(&mut s[SPEC], 4)),
    (3031, |s| patch(&mut s[SPEC], 0, &[1])),
    (3031, |s| {
        patch(&mut s[SPEC], 0, &(SHADER_ABI + 1).to_le_bytes());
    }),
    (3038, |s| patch(&mut s[SPEC], 8, &[1])),
    (3038, |s| patch(&mut s[SPEC], 31, &[1])),
    (3040, |s| s[SHDR].refill(&[0; 8])),
    (3040, |s| patch(&mut s[SHDR], 4, &u32::MAX.to_le_bytes())),
    (3040, |s| patch(&mut s[SHDR], 8, &u32::MAX.to_le_bytes())),
    (3041, |s| patch(&mut s[SHDR], 16, &[0xFF])),
    (3042, |s| patch(&mut s[SHDR], 12, &[1])),
    (3042, |s| patch(&mut s[SHDR], 16 + 19, &[1])),
    (4001, |s| cut(&mut s[PANT], 4)),
    (4001, |s| cut(&mut s[SHAP], 1)),
    (4001, |s| cut(&mut s[CURV], 1)),
    (3023, |s| drop(s.remove(CURV))),
    (5016, |s| cut(&mut s[CURV], 4)),
    (5001, |s| cut(&mut s[CELL], 4)),
    (5001, |s| patch(&mut s[META], 8, &[3])),
    (6004, |s| cut(&mut s[TILE], 27)),
    (6004, |s| cut(&mut s[TILE], 4)),
    (6004, |s| drop(s.remove(TILE))),
    (6004, |s| {
        let twice = [s[TILE].content(), vec![0; 27]].concat();
        s[TILE].refill(&twice);
    }),
    (6010, |s| patch(&mut s[IMAG], 16, &u32::MAX.to_le_bytes())),
    (6011, |s| patch(&mut s[IMAG], 24, &u32::MAX.to_le_bytes())),
    (6017, |s| patch(&mut s[IMAG], 28, &[1])),
    (6014, |s| drop(s.pop())),
    (6014, |s| s.push(s[MIPS + 2].clone())),
    (6015, |s| s.swap(MIPS, MIPS + 1)),
    (6015, |s| cut(&mut s[MIPS + 1], 4)),
    (6015, |s| cut(&mut s[MIPS + 2], 4)),
];

const VALUE_CASES: &[ValueCase] = &[
    (3010, |f| f.meta.canvas_size[0] = 0.0),
    (3010, |f| f.meta.canvas_size[1] = f32::NAN),
    (3011, |f| f.meta.grid.size_cells[0] = 0),
    (3011, |f| f.meta.grid.size_cells = [16_385, 2]),
    (3012, |f| f.meta.grid.cell_from_uv_scale[0] = f32::INFINITY),
    (3012, |f| f.meta.grid.cell_from_uv_offset[1] = -0.125),
    (3012, |f| f.meta.grid.cell_from_uv_offset[1] = 1.0),
    (3013, |f| f.meta.grid.cell_from_uv_scale = [1.8, 1.8]),
    (3014, |f| f.meta.grid.cell_from_uv_scale[0] = 1.4),
    (3015, |f| f.meta.grid.texels_per_cell = 0),
    (3015, |f| f.meta.grid.texels_per_cell = u32::MAX),
    (3016, |f| f.meta.distance_range_texels = 0.0),
    (3017, |f| f.meta.max_zoom = f32::NAN),
    (3018, |f| f.meta.sampler.texture_matrix[5] = f32::NAN),
    (3019, |f| f.meta.sampler.smoothing = 0.0),
    (3019, |f| f.meta.sampler.smoothing = 0.501),
    (3020, |f| outline(f).width_texels = 2.0),
    (3020, |f| outline(f).width_texels = f32::NAN),
    (3021, |f| outline(f).paint = 4),
    (3022, |f| lattice(f).units_per_cell = 0),
    (3022, |f| lattice(f).margin_units = 32_768),
    (3022, |f| lattice(f).margin_units = u32::MAX),
    (3023, |f| f.meta.curve_lattice = None),
    (3023, |f| f.curves.clear()),
    (3032, |f| f.spec.features |= 1 << 31),
    (3033, |f| f.spec.features &= !Features::MSDF),
    (3033, |f| f.spec.features &= !Features::TRANSLUCENT),
    (3033, |f| f.spec.features &= !Features::CURVES),
    (3033, |f| f.spec.features = 0),
    (3034, |f| f.spec.features |= Features::MASK),
    (3034, |f| f.meta.sampler.outline = None),
    (3050, |f| f.provenance.as_mut().unwrap().shapes.truncate(2)),
    (3051, |f| f.provenance.as_mut().unwrap().options.reverse()),
    (3052, |f| msdf_error(f).wrong_share = 1.5),
    (3052, |f| msdf_error(f).wrong_share = f32::NAN),
    (3052, |f| msdf_error(f).p99_px = -1.0),
    (3052, |f| msdf_error(f).p99_px = f32::INFINITY),
    (3053, |f| *sample::area(f) = f32::NAN),
    (3053, |f| *sample::area(f) = 1.01),
    (4002, |f| {
        f.layers = vec![layer(0, u32::MAX), layer(u32::MAX, 1)];
    }),
    (4003, |f| f.paints[0].kind = 3),
    (4004, |f| f.paints[0].data_count = 1),
    (4005, |f| f.paints[1].color[3] = 1.5),
    (4005, |f| f.paints[1].color[0] = f32::NAN),
    (4010, |f| f.shapes[0].coverage = 4),
    (4011, |f| f.shapes[0].fill_rule = 2),
    (4012, |f| f.shapes[2].layer_or_image = 2),
    (4012, |f| f.shapes[3].layer_or_image = 2),
    (4013, |f| f.shapes[2].paint = 1),
    (4013, |f| f.shapes[3].paint = 4),
    (4013, |f| f.shapes[0].paint = 4),
    (4014, |f| f.shapes[1].bounds_uv[2] = -1.0),
    (4015, |f| f.shapes[1].reserved = 1),
    (4020, |f| f.layers[1].tile_first = 1),
    (4021, |f| f.layers[1].shape_count = 2),
    (4022, |f| f.layers[0].reserved = 9),
    (5001, |f| f.cells.truncate(3)),
    (5002, |f| f.cells[0] = 3 << 30),
    (5002, |f| f.cells[0] = 1),
    (5003, |f| f.cells[1] = 1 << 30 | 4),
    (5004, |f| f.cells[2] = 2 << 30 | 1),
    (5004, |f| f.cells[2] = 2 << 30 | 10),
    (5005, |f| f.entries[8] &= !(1 << 27)),
    (5006, |f| {
        f.entries[9] = 0;
        f.curves[2] = 1 << 31;
    }),
    (5007, |f| {
        f.curves[2] = 0x7fff << 16;
        f.entries = [2 << 28 | 1 << 27 | 1, 0].repeat(300);
        f.cells = (0..300).map(|list| (2 << 30) | (2 * list)).collect();
    }),
    (5010, |f| f.entries.truncate(7)),
    (5011, |f| f.entries[0] |= 1 << 19),
    (5011, |f| f.entries[0] = 4 << 28),
    (5011, |f| f.entries[5] = 1),
    (5012, |f| f.entries[4] += 4),
    (5013, |f| f.entries[1] = 3),
    (5014, |f| f.entries[2] += 1),
    (5015, |f| f.entries[0] |= 1 << 26),
    (5015, |f| f.entries[2] |= 1 << 26),
    (5015, |f| f.entries[8] |= 1 << 26),
    (5016, |f| f.entries[9] = 8),
    (5016, |f| f.entries[9] = u32::MAX),
    (5016, |f| f.curves.truncate(8)),
    (5020, |f| f.curves[4] = 3),
    (6002, |f| f.tiles.truncate(26 * 4)),
    (6003, |f| f.tiles[7] = 254),
    (6010, |f| f.images[0].size[0] = 0),
    (6010, |f| f.images[0].size = [32_769, 1]),
    (6011, |f| levels(f, 0).truncate(2)),
    (6011, |f| levels(f, 1).clear()),
    (6012, |f| f.images[0].rect_uv[2] = 0.0),
    (6012, |f| f.images[1].rect_uv[0] = f32::NAN),
    (6015, |f| levels(f, 1)[0].truncate(7)),
    (6016, |f| f.images.swap(0, 1)),
];

fn msdf_error(file: &mut VtexFile) -> &mut MsdfError {
    let report = &mut file.provenance.as_mut().unwrap().shapes[1];
    report.msdf_error.as_mut().unwrap()
}

fn outline(file: &mut VtexFile) -> &mut DistanceOutline {
    file.meta.sampler.outline.as_mut().unwrap()
}

fn lattice(file: &mut VtexFile) -> &mut CurveLattice {
    file.meta.curve_lattice.as_mut().unwrap()
}

fn layer(tile_first: u32, tile_count: u32) -> LayerRecord {
    LayerRecord {
        tile_first,
        tile_count,
        shape_count: 0,
        reserved: 0,
    }
}

/// Small enough that no case may ask for much memory, but for the one about large bundles.
fn limits(code: u16) -> Limits {
    Limits {
        total_raw_bytes: if code == 2021 { 1 << 20 } else { 1 << 16 },
        meta_bytes: 1_000,
        shader_bytes: 10_000,
        provenance_bytes: 10_000,
    }
}

fn codes(issues: &[Issue]) -> BTreeSet<u16> {
    issues.iter().map(|issue| issue.code).collect()
}

#[test]
fn broken_files_have_the_issue() {
    let cases: Vec<FileCase> = [TABLE_CASES, CONTENT_CASES, GRADIENT_FILES].concat();
    check_files(&sample::small(), &cases);
    check_files(&sample::outlined(), OUTLINED_CASES);
}

fn check_files(file: &VtexFile, cases: &[FileCase]) {
    let sections = take_apart(&file.to_bytes().unwrap());
    let whole = put_together(&sections);
    let read = VtexFile::parse(&whole, &Limits::default());
    assert_eq!(read.as_ref(), Ok(file), "the forger is right");
    for (index, (code, change)) in cases.iter().enumerate() {
        let mut forged = sections.clone();
        change(&mut forged);
        let bytes = put_together(&forged);
        let limits = limits(*code);
        let found = validate(&bytes, &limits);
        assert!(
            codes(&found).contains(code),
            "case {index}: {code} is not in {found:#?}"
        );
        let error = VtexFile::parse(&bytes, &limits).unwrap_err();
        assert_eq!(Some(error.issue()), found.first(), "case {index}");
    }
}

#[test]
fn broken_values_have_the_issue_and_are_not_written() {
    check_values(&sample::small(), VALUE_CASES);
    check_values(&sample::small(), GRADIENT_VALUES);
    check_values(&sample::outlined(), OUTLINED_VALUES);
    check_values(&grouped(), GROUPED_VALUES);
}

fn check_values(sound: &VtexFile, cases: &[ValueCase]) {
    for (index, (code, change)) in cases.iter().enumerate() {
        let mut file = sound.clone();
        change(&mut file);
        let found = file.check();
        assert!(
            codes(&found).contains(code),
            "case {index}: {code} is not in {found:#?}"
        );
        assert!(file.to_bytes().is_err(), "case {index} is written");
    }
}

#[test]
fn broken_headers_have_the_issue() {
    let sound = sample::small().to_bytes().unwrap();
    let cases: [ByteCase; 9] = [
        (1001, |b| b.truncate(39)),
        (1001, Vec::clear),
        (1002, |b| b[0] = 0x09),
        (1003, |b| b[8] = 3),
        (1004, |b| b.truncate(400)),
        (1006, |b| {
            b[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
        }),
        (1006, |b| {
            b[12..16].copy_from_slice(&60_000_u32.to_le_bytes());
        }),
        (1007, |b| b[40] = b'X'),
        (1008, |b| b[8] = 1),
    ];
    for (code, change) in cases {
        let mut bytes = sound.clone();
        change(&mut bytes);
        let found = validate(&bytes, &Limits::default());
        assert_eq!(codes(&found), BTreeSet::from([code]), "{found:#?}");
    }
}

#[test]
fn every_issue_has_a_case() {
    let files = [TABLE_CASES, CONTENT_CASES, OUTLINED_CASES].concat();
    let files = files.iter().map(|case| case.0);
    let values = [
        VALUE_CASES,
        OUTLINED_VALUES,
        GRADIENT_VALUES,
        GROUPED_VALUES,
    ]
    .concat();
    let values = values.iter().map(|case| case.0);
    // Memory that a machine lacks, and a section of 4 GiB, have tests beside their checks; fine cells
    // have theirs where packing is.
    let others = [1001, 1002, 1003, 1004, 1006, 1007, 1008, 2019, 2022, 5040];
    let cases: BTreeSet<u16> = files.chain(values).chain(others).collect();
    let all: BTreeSet<u16> = ISSUES.iter().map(|kind| kind.code).collect();
    assert_eq!(cases, all);
}

#[test]
fn errors_say_who_is_at_fault() {
    let sections = take_apart(&sample::small().to_bytes().unwrap());
    let parse = |change: fn(&mut Vec<Forged>)| {
        let mut forged = sections.clone();
        change(&mut forged);
        VtexFile::parse(&put_together(&forged), &Limits::default()).unwrap_err()
    };
    let unsupported = parse(|s| s.push(Forged::raw(Tag(*b"NEWS"), b"1")));
    assert!(
        matches!(unsupported, ReadError::Unsupported { .. }),
        "{unsupported}"
    );
    let limits = parse(|s| {
        s[ENTR].codec = 1;
        s[ENTR].raw_bytes = u32::MAX;
    });
    assert!(matches!(limits, ReadError::Limits { .. }), "{limits}");
    let malformed = parse(|s| s[TILE].hash[0] ^= 1);
    assert!(
        matches!(malformed, ReadError::Malformed { .. }),
        "{malformed}"
    );
}

#[test]
fn unknown_optional_sections_are_skipped() {
    let mut sections = take_apart(&sample::small().to_bytes().unwrap());
    let mut news = Forged::raw(Tag(*b"NEWS"), b"of a later version");
    news.flags = 0;
    sections.insert(CELL, news.clone());
    // Its codec may be unknown and what it claims counts against no budget.
    news.codec = 9;
    news.raw_bytes = u32::MAX;
    sections.push(news);
    let bytes = put_together(&sections);
    let file = VtexFile::parse(&bytes, &Limits::default()).unwrap();
    assert_eq!(file, sample::small());
}

#[test]
fn sections_share_bundles_as_a_writer_likes() {
    let mut sections = take_apart(&sample::small().to_bytes().unwrap());
    let mut news = Forged::raw(Tag(*b"NEWS"), b"of a later version");
    news.flags = 0;
    sections.insert(CELL, news);
    for last in 1..sections.len() {
        sections[last].share();
        let file = VtexFile::parse(&put_together(&sections), &Limits::default());
        assert_eq!(file.as_ref(), Ok(&sample::small()), "0 to {last}");
    }
    // One bundle, one issue.
    let mut bytes = put_together(&sections);
    *bytes.last_mut().unwrap() ^= 1;
    assert_eq!(
        codes(&validate(&bytes, &Limits::default())),
        BTreeSet::from([2018])
    );
    assert_eq!(validate(&bytes, &Limits::default()).len(), 1);
}

#[test]
fn a_later_minor_version_is_read() {
    let mut bytes = sample::small().to_bytes().unwrap();
    bytes[10] = 9;
    seal(&mut bytes);
    assert!(VtexFile::parse(&bytes, &Limits::default()).is_ok());
}

#[test]
fn the_total_budget_is_exact() {
    let bytes = sample::small().to_bytes().unwrap();
    let total = take_apart(&bytes)
        .iter()
        .map(|section| u64::from(section.raw_bytes))
        .sum();
    let read = |total_raw_bytes| {
        let limits = Limits {
            total_raw_bytes,
            ..Limits::default()
        };
        VtexFile::parse(&bytes, &limits)
    };
    assert!(read(total).is_ok());
    assert_eq!(read(total - 1).unwrap_err().issue().code, 2016);
}

#[test]
fn a_bomb_is_refused_before_it_is_unpacked() {
    let zeros = vec![0; 64 << 20];
    let bomb = zstd::bulk::compress(&zeros, 3).unwrap();
    let mut sections = take_apart(&sample::small().to_bytes().unwrap());
    let place_bomb = |section: &mut Forged, raw_bytes: u32| {
        section.codec = 1;
        section.stored = bomb.clone();
        section.raw_bytes = raw_bytes;
        section.hash = hash(&zeros);
    };
    // As cells it is more than the grid has, as tiles more than the layers, in a small section
    // more than it says itself, as entries more than the caller's budget.
    for (place, raw_bytes, code) in [
        (CELL, 64 << 20, 5001),
        (TILE, 64 << 20, 6004),
        (CELL, 16, 2017),
        (ENTR, 64 << 20, 2016),
    ] {
        let sound = sections[place].clone();
        place_bomb(&mut sections[place], raw_bytes);
        let limits = Limits {
            total_raw_bytes: if code == 2016 { 1 << 20 } else { 1 << 30 },
            ..Limits::default()
        };
        let error = VtexFile::parse(&put_together(&sections), &limits).unwrap_err();
        assert_eq!(error.issue().code, code, "{error}");
        sections[place] = sound;
    }
}

/// The levels of an image, to break them.
fn levels(file: &mut VtexFile, image: usize) -> &mut Vec<Vec<u8>> {
    Arc::make_mut(&mut file.images[image].mips)
}

#[test]
fn at_most_256_issues_are_told() {
    let mut file = sample::small();
    file.meta.grid = Grid {
        size_cells: [100, 100],
        cell_from_uv_scale: [99.5, 99.5],
        ..file.meta.grid
    };
    file.cells = vec![3 << 30; 10_000];
    assert_eq!(file.check().len(), 256);
}

#[test]
fn an_opaque_image_may_be_called_so() {
    let mut file = sample::small();
    let opaque = |level| {
        let [width, height] = Image::level_size([1, 2], level);
        [1, 2, 3, 255].repeat((width * height) as usize)
    };
    file.images[1].mips = Arc::new(vec![opaque(0), opaque(1)]);
    let entry = Entry {
        kind: EntryKind::Image,
        last: false,
        opaque: true,
        index: 1,
        data: 0,
    };
    file.entries[2..4].copy_from_slice(&entry.encode().unwrap());
    assert_eq!(file.check(), []);
}

#[test]
fn lists_may_share_their_tails() {
    let mut file = sample::small();
    file.cells[0] = 2 << 30 | 2;
    file.cells[1] = 2 << 30 | 4;
    assert_eq!(file.check(), []);
}
