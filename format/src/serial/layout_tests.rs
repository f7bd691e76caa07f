//! What is stored in a file, frozen under the format's version: where fields lie, the fields of
//! records, and the bytes of fixed values of everything that is encoded field by field.

use std::fmt::Write as _;
use std::path::Path;

use vtex_testing::Frozen;

use super::canonical;
use crate::container::header::Header;
use crate::container::layout::{self, VERSION_MAJOR, VERSION_MINOR};
use crate::container::section::{BundleEntry, SectionEntry};
use crate::container::tag::Tag;
use crate::curves::outlines::stream;
use crate::records::image::ImageRecord;
use crate::{
    AddressMode, BlendMode, CellWord, Codec, CurveHeader, CurveLattice, DistanceOutline, Entry,
    EntryKind, Finding, Gradient, GradientShape, GradientStop, Grid, LayerRecord, MaskKind, Meta,
    MsdfError, PaintRecord, Preparation, Provenance, RecordParts, SHADER_ABI, SamplerSettings,
    ShaderBlob, ShapeRecord, ShapeReport, SpecKey, Spread, StoredOutline, StoredOutlines,
    StoredSegment, Warning, WarningCode,
};

/// Lines of a record: its size, then offset, name and type of each field. Does not compile when a
/// field is left out or has another type.
macro_rules! record {
    ($record:ident { $($field:ident: $type:ty),* $(,)? }) => {{
        let _ = |$record { $($field),* }: $record| { $(let _: $type = $field;)* };
        let mut text = format!("{} {} bytes\n", stringify!($record), size_of::<$record>());
        $(
            let (offset, name) = (std::mem::offset_of!($record, $field), stringify!($field));
            let _ = writeln!(text, "  {offset} {name} {}", stringify!($type));
        )*
        text
    }};
}

/// Lines of constants: name and value.
macro_rules! constants {
    ($title:literal $module:ident { $($name:ident),* $(,)? }) => {{
        let mut text = concat!($title, "\n").to_owned();
        $(let _ = writeln!(text, "  {} {}", layout::$module::$name, stringify!($name));)*
        text
    }};
}

/// A line of each variant's number.
macro_rules! numbers {
    ($enum:ident { $($variant:ident),* $(,)? }) => {{
        // Does not compile when a variant is left out.
        let _ = |value: $enum| match value { $($enum::$variant => {})* };
        let mut text = concat!(stringify!($enum), "\n").to_owned();
        $(let _ = writeln!(text, "  {} {}", $enum::$variant as u32, stringify!($variant));)*
        text
    }};
}

#[test]
fn the_wire_layout_changes_only_with_the_version() {
    let text = [offsets(), records(), enumerations(), values()].concat();
    Frozen {
        folder: &Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/layout"),
        constant: "VERSION_MAJOR.VERSION_MINOR (format/src/container/layout.rs) with SHADER_ABI \
                   (format/src/file/spec.rs), which is that of SPEC",
        version: &format!("{VERSION_MAJOR}.{VERSION_MINOR}, ABI {SHADER_ABI}"),
        text: &text,
    }
    .check();
}

fn offsets() -> String {
    [
        constants!("header" header {
            MAGIC, MAJOR, MINOR, SECTION_COUNT, FILE_BYTES, CHECKSUM, BYTES,
        }),
        constants!("section entry" entry { TAG, FLAGS, RAW_BYTES, BYTES }),
        constants!("bundle in a section entry" bundle { CODEC, STORED_BYTES, HASH, BYTES }),
    ]
    .concat()
}

fn records() -> String {
    [
        record!(PaintRecord {
            kind: u32,
            flags: u32,
            data_first: u32,
            data_count: u32,
            color: [f32; 4],
        }),
        record!(ShapeRecord {
            coverage: u32,
            fill_rule: u32,
            layer_or_image: u32,
            paint: u32,
            bounds_uv: [f32; 4],
            segment_count: u32,
            reserved: u32,
        }),
        record!(LayerRecord {
            tile_first: u32,
            tile_count: u32,
            shape_count: u32,
            reserved: u32,
        }),
        record!(ImageRecord {
            rect_uv: [f32; 4],
            size: [u32; 2],
            level_count: u32,
            texels_of: u32,
        }),
    ]
    .concat()
}

fn enumerations() -> String {
    [
        numbers!(AddressMode {
            Clamp,
            Repeat,
            Mirror,
            Border
        }),
        numbers!(EntryKind {
            Full,
            Msdf,
            Curves,
            Image,
            Branch,
            Open,
            Close,
            Mask
        }),
        numbers!(MaskKind {
            Luminance,
            Alpha,
            LinearLuminance
        }),
        numbers!(BlendMode {
            Normal,
            Multiply,
            Screen,
            Overlay,
            Darken,
            Lighten,
            ColorDodge,
            ColorBurn,
            HardLight,
            SoftLight,
            Difference,
            Exclusion,
            Hue,
            Saturation,
            Color,
            Luminosity,
            PlusLighter,
        }),
        numbers!(Spread {
            Pad,
            Reflect,
            Repeat
        }),
        numbers!(Preparation {
            AsDrawn,
            Simplified,
            SecondMethod,
            Failed
        }),
        numbers!(Finding {
            None,
            Cost,
            Quantisation,
            Hairline,
            Cusp,
            ThinFeature,
            Displaced,
            Overlaps,
            TooManySegments,
        }),
        numbers!(WarningCode {
            RasterPatch,
            MissingFont,
            ImageNotLoaded,
            PathFallback,
            MergeOverlap,
            EmptyDrawing,
            Reduced,
            GpuBytes,
        }),
    ]
    .concat()
}

/// Fixed values as they are stored; numbers differ, so that swapped fields show.
fn values() -> String {
    let mut text = String::new();
    let mut add = |name: &str, bytes: &[u8]| {
        let hex = |line: &[u8]| {
            line.iter()
                .map(|byte| format!("{byte:02x}"))
                .collect::<String>()
        };
        let lines: Vec<String> = bytes.chunks(32).map(hex).collect();
        let _ = writeln!(text, "{name}\n  {}", lines.join("\n  "));
    };
    add("header", &header().encode());
    add(
        "section entry",
        &SectionEntry::new(Tag::META, 0x1413_1211, true).encode(),
    );
    add("bundle in a section entry", &bundle().encode());
    add("META", &canonical::encode(&meta(None)));
    add(
        "META, outline",
        &canonical::encode(&meta(CurveLattice::new(0.25))),
    );
    let features = 0x0403_0201;
    add("SPEC", &words(&SpecKey { features }.encode()));
    add("PROV", &canonical::encode(&provenance()));
    add("SHDR", &shader().encode().expect("short"));
    let t_from_uv = [1.0, 2.0, 3.0];
    add(
        "linear gradient",
        &gradient(GradientShape::Linear { t_from_uv }),
    );
    let radial = GradientShape::Radial {
        circle_from_uv: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
        distance: 0.375,
        focal_radius: 0.0625,
    };
    add("radial gradient", &gradient(radial));
    add("cells", &words(&cells()));
    add("list entries", &words(&entries()));
    add(
        "curve record",
        &words(&curve_header().encode().expect("fits")),
    );
    add("stored outlines", &stream::encode(&stored_outlines(), &[]));
    text
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

fn header() -> Header {
    Header {
        checksum: std::array::from_fn(|i| 0xA0 + u8::try_from(i).expect("16 bytes")),
        ..Header::new(7, 0x0102_0304_0506)
    }
}

fn bundle() -> BundleEntry {
    BundleEntry {
        codec: Codec::Zstd,
        stored_bytes: 0x2423_2221,
        hash: std::array::from_fn(|i| 0xB0 + u8::try_from(i).expect("16 bytes")),
    }
}

/// With an outline where there is a lattice.
fn meta(curve_lattice: Option<CurveLattice>) -> Meta {
    Meta {
        canvas_size: [1.5, 2.5],
        grid: Grid {
            size_cells: [3, 4],
            cell_from_uv_scale: [5.5, 6.5],
            cell_from_uv_offset: [0.25, 0.5],
            texels_per_cell: 7,
        },
        distance_range_texels: 8.5,
        max_zoom: 9.5,
        sampler: SamplerSettings {
            texture_matrix: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
            address: [AddressMode::Mirror, AddressMode::Border],
            smoothing: 0.125,
            mask: true,
            outline: curve_lattice.map(|_| DistanceOutline {
                width_texels: 1.25,
                paint: 10,
            }),
        },
        curve_lattice,
    }
}

fn provenance() -> Provenance {
    Provenance {
        source_hash: [0xC0; 32],
        tool: "tool".to_owned(),
        options: vec![("name".to_owned(), "value".to_owned())],
        shapes: vec![ShapeReport {
            element: "element".to_owned(),
            source: "fill".to_owned(),
            preparation: Preparation::SecondMethod,
            finding: Finding::Cusp,
            size_texels: 300,
            msdf_error: Some(MsdfError {
                wrong_share: 0.25,
                p99_px: 0.5,
            }),
        }],
        warnings: vec![Warning {
            code: WarningCode::PathFallback,
            feature: "feature".to_owned(),
            element: "id".to_owned(),
            message: "message".to_owned(),
            area: 0.75,
        }],
    }
}

fn shader() -> ShaderBlob {
    ShaderBlob {
        abi: 0x21,
        wgsl_fragment: "wgsl!".to_owned(),
        batch_spirv: vec![0x0723_0203, 0x22],
    }
}

fn cells() -> [u32; 3] {
    let cells = [
        CellWord::Empty,
        CellWord::Paint { paint: 5 },
        CellWord::List { offset_words: 6 },
    ];
    cells.map(|cell| cell.encode().expect("fits"))
}

fn entries() -> Vec<u32> {
    let entry = |kind, last, opaque| Entry {
        kind,
        last,
        opaque,
        index: 5,
        data: 0x31,
    };
    let entries = [
        entry(EntryKind::Msdf, false, false),
        entry(EntryKind::Curves, false, true),
        entry(EntryKind::Branch, true, false),
    ];
    let words = |entry: Entry| entry.encode().expect("fits");
    entries.into_iter().flat_map(words).collect()
}

fn curve_header() -> CurveHeader {
    CurveHeader {
        line_count: 5,
        down_line_count: 2,
        quad_count: 7,
        down_quad_count: 3,
        step_count: 4,
        even_odd: true,
        base_winding: -2,
    }
}

fn stored_outlines() -> StoredOutlines {
    let line = |from, to| StoredSegment {
        from,
        control: None,
        to,
    };
    let curve = StoredSegment {
        control: Some([900, 40]),
        ..line([700, 30], [950, 500])
    };
    StoredOutlines {
        flatness_units: 0.5,
        outlines: vec![StoredOutline {
            even_odd: true,
            segments: vec![line([0, 0], [700, 30]), curve, line([950, 500], [0, 0])],
        }],
        records: vec![RecordParts {
            cell: 3,
            outlines: vec![0],
        }],
    }
}

/// The record of a paint, and its numbers.
fn gradient(shape: GradientShape) -> Vec<u8> {
    let stop = |offset: f32| GradientStop {
        offset,
        color: [offset, 0.25, 0.5, 0.75],
    };
    let gradient = Gradient {
        shape,
        spread: Spread::Reflect,
        stops: vec![stop(0.125), stop(0.875)],
    };
    let mut numbers = vec![0.0];
    let record = gradient.store(&mut numbers);
    let mut bytes = bytemuck::bytes_of(&record).to_vec();
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    bytes
}
