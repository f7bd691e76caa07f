//! Valid files made in code: one by hand that has every section, and arbitrary ones.

use std::sync::Arc;

use crate::gradients::{any_gradient, small_gradients};
use arbtest::arbitrary::{Result, Unstructured};
use bytemuck::Zeroable;
use vtex_format::{
    AddressMode, COVERAGE_CURVES, COVERAGE_IMAGE, COVERAGE_MSDF, CellWord, CurveHeader,
    CurveLattice, DistanceOutline, Entry, EntryKind, Features, Finding, Grid, Image, LayerRecord,
    Meta, MsdfError, PaintRecord, Preparation, Provenance, RecordParts, SHADER_ABI,
    SamplerSettings, ShaderBlob, ShapeRecord, ShapeReport, SpecKey, StoredOutline, StoredOutlines,
    StoredSegment, VtexFile, Warning, WarningCode,
};

/// A 2 x 2 grid with every kind of cell and entry, two layers, two images and every section.
pub(crate) fn small() -> VtexFile {
    let entry = |kind, last, index, data| Entry {
        kind,
        last,
        opaque: false,
        index,
        data,
    };
    let full = Entry {
        opaque: true,
        ..entry(EntryKind::Full, true, 0, 0)
    };
    let entries = [
        entry(EntryKind::Msdf, false, 1, 0),
        entry(EntryKind::Image, false, 1, 0),
        full,
        entry(EntryKind::Msdf, false, 1, 2),
        entry(EntryKind::Curves, true, 1, 3),
    ];
    let cells = [
        CellWord::Empty,
        CellWord::Paint { paint: 3 },
        CellWord::List { offset_words: 0 },
        CellWord::List { offset_words: 6 },
    ];
    let mut gradients = Vec::new();
    let [linear, radial] = small_gradients().map(|gradient| gradient.store(&mut gradients));
    let meta = Meta {
        curve_lattice: CurveLattice::new(0.125),
        ..meta([2, 2], 2)
    };
    let file = VtexFile {
        spec: SpecKey {
            features: Features::MIPS,
        },
        shader: ShaderBlob {
            abi: SHADER_ABI,
            wgsl_fragment: "fn vtex_sample() {}".to_owned(),
            batch_spirv: vec![0x0723_0203, 7],
        },
        paints: vec![
            PaintRecord::solid([1.0, 0.5, 0.0, 1.0]),
            PaintRecord::solid([0.0, 0.5, 1.0, 0.25]),
            linear,
            radial,
        ],
        gradients,
        shapes: vec![
            shape(COVERAGE_MSDF, 0, 1),
            shape(COVERAGE_MSDF, 1, 1),
            shape(COVERAGE_IMAGE, 1, 0),
            shape(COVERAGE_CURVES, 0, 1),
        ],
        layers: vec![layer(0, 2, 2), layer(2, 1, 1)],
        cells: cells.map(|cell| cell.encode().unwrap()).to_vec(),
        entries: entries
            .iter()
            .flat_map(|entry| entry.encode().unwrap())
            .collect(),
        // A record of 3 words, then one of 6.
        curves: [record(1, 0, 0), record(0, 2, 0)].concat(),
        fine: vec![SHADER_ABI, 0, 7],
        tiles: tiles(3 * 9),
        images: vec![
            image([0.0, 0.0, 1.0, 1.0], [70, 1]),
            image([0.25, 0.0, 0.5, 1.0], [1, 2]),
        ],
        provenance: Some(provenance(4)),
        ..VtexFile::blank(meta)
    };
    with_key(file)
}

/// As [`small`], but its records are cut from two outlines: a square with a rounded corner and a
/// triangle that is even-odd.
pub(crate) fn outlined() -> VtexFile {
    let mut file = small();
    let lattice = file.meta.curve_lattice.unwrap();
    let side = lattice.units_per_cell.cast_signed();
    let line = |from, to| StoredSegment {
        from,
        control: None,
        to,
    };
    let (a, b) = (side / 4, side + side / 2);
    let stored = StoredOutlines {
        flatness_units: 0.5,
        outlines: vec![
            StoredOutline {
                even_odd: false,
                segments: vec![
                    line([a, a], [b, a]),
                    StoredSegment {
                        from: [b, a],
                        control: Some([b, b]),
                        to: [a, b],
                    },
                    line([a, b], [a, a]),
                ],
            },
            StoredOutline {
                even_odd: true,
                segments: vec![
                    line([-a, -a], [2 * b, 7]),
                    line([2 * b, 7], [7, 2 * b]),
                    line([7, 2 * b], [-a, -a]),
                ],
            },
        ],
        records: vec![record_parts(3, &[0]), record_parts(3, &[1])],
    };
    file.curves = stored.records(&file.meta.grid, lattice).unwrap();
    let header = CurveHeader::decode([file.curves[0], file.curves[1]]).unwrap();
    file.entries[9] = header.record_words();
    file.outlines = Some(stored);
    with_key(file)
}

pub(crate) fn record_parts(cell: u32, outlines: &[u32]) -> RecordParts {
    RecordParts {
        cell,
        outlines: outlines.to_vec(),
    }
}

/// The file with the key its content asks for.
pub(crate) fn with_key(mut file: VtexFile) -> VtexFile {
    file.spec = SpecKey::for_file(&file);
    file
}

fn meta(size_cells: [u32; 2], texels_per_cell: u32) -> Meta {
    let [columns, rows] = size_cells.map(|cells| cells as f32);
    Meta {
        canvas_size: [32.0 * (columns - 0.5), 32.0 * (rows - 0.5)],
        grid: Grid {
            size_cells,
            cell_from_uv_scale: [columns - 0.5, rows - 0.5],
            cell_from_uv_offset: [0.25, 0.5],
            texels_per_cell,
        },
        distance_range_texels: 4.0,
        max_zoom: 64.0,
        sampler: SamplerSettings {
            address: [AddressMode::Repeat, AddressMode::Border],
            outline: Some(DistanceOutline {
                width_texels: 1.5,
                paint: 0,
            }),
            ..SamplerSettings::default()
        },
        curve_lattice: None,
    }
}

fn shape(coverage: u32, layer_or_image: u32, paint: u32) -> ShapeRecord {
    ShapeRecord {
        coverage,
        layer_or_image,
        paint,
        bounds_uv: [-0.5, 0.0, 0.5, 1.5],
        segment_count: 4,
        ..ShapeRecord::zeroed()
    }
}

fn layer(tile_first: u32, tile_count: u32, shape_count: u32) -> LayerRecord {
    LayerRecord {
        tile_first,
        tile_count,
        shape_count,
        reserved: 0,
    }
}

/// A curve record of any segments, one of its lines running down.
fn record(step_count: u32, line_count: u32, quad_count: u32) -> Vec<u32> {
    let header = CurveHeader {
        line_count,
        down_line_count: line_count.min(1),
        quad_count,
        down_quad_count: 0,
        step_count,
        even_odd: line_count.is_multiple_of(2),
        base_winding: -1,
    };
    let mut words = header.encode().unwrap().to_vec();
    words.extend((2..header.record_words()).map(|i| i * 0x0123_4567));
    words
}

/// Texels of any colour whose alpha is 255.
fn tiles(texel_count: usize) -> Vec<u8> {
    let texels = (0..texel_count).map(|i| [i as u8, (i * 7) as u8, (i / 3) as u8, 255]);
    texels.flatten().collect()
}

fn image(rect_uv: [f32; 4], size: [u32; 2]) -> Image {
    let level = |level| {
        let [width, height] = Image::level_size(size, level);
        (0..4 * width * height)
            .map(|i| (i * 13 + level) as u8)
            .collect()
    };
    Image {
        rect_uv,
        size,
        mips: Arc::new((0..Image::level_count(size)).map(level).collect()),
    }
}

fn provenance(shape_count: usize) -> Provenance {
    let report = ShapeReport {
        element: "path1".to_owned(),
        source: "fill".to_owned(),
        preparation: Preparation::Simplified,
        finding: Finding::ThinFeature,
        size_texels: 31,
        msdf_error: Some(MsdfError {
            wrong_share: 0.25,
            p99_px: 1.5,
        }),
    };
    Provenance {
        source_hash: [7; 32],
        tool: "sample 1".to_owned(),
        options: vec![
            ("mode".to_owned(), "auto".to_owned()),
            ("size".to_owned(), "5".to_owned()),
        ],
        shapes: vec![report; shape_count],
        warnings: vec![Warning {
            code: WarningCode::RasterPatch,
            feature: "filter".to_owned(),
            element: "g2".to_owned(),
            message: "drawn as a raster image".to_owned(),
            area: 0.125,
        }],
    }
}

/// The area of the first warning.
pub(crate) fn area(file: &mut VtexFile) -> &mut f32 {
    &mut file.provenance.as_mut().unwrap().warnings[0].area
}

/// An arbitrary valid file.
pub(crate) fn arbitrary(u: &mut Unstructured<'_>) -> Result<VtexFile> {
    let size = [u.int_in_range(1..=9)?, u.int_in_range(1..=9)?];
    let mut meta = meta(size, u.int_in_range(1..=9)?);
    meta.sampler.mask = u.arbitrary()?;
    if u.arbitrary()? {
        meta.sampler.texture_matrix[4] = 0.5;
    }
    let paint_count = u.int_in_range(1..=5)?;
    let mut gradients = Vec::new();
    let paints = (0..paint_count)
        .map(|_| paint(u, &mut gradients))
        .collect::<Result<Vec<_>>>()?;
    if paints[0].is_gradient() || u.arbitrary()? {
        meta.sampler.outline = None;
    }
    let image_count = u.int_in_range(0..=3)?;
    let images = (0..image_count)
        .map(|_| any_image(u))
        .collect::<Result<Vec<_>>>()?;
    let layers = any_layers(u)?;
    let tile_count: u32 = layers.iter().map(|layer| layer.tile_count).sum();
    let (records, stored) = if u.arbitrary()? {
        let (records, stored) = any_outlines(u, &meta.grid)?;
        (records, Some(stored))
    } else {
        (any_records(u)?, None)
    };
    if !records.is_empty() {
        meta.curve_lattice = CurveLattice::new(0.25);
    }
    let tables = Tables {
        image_count: images.len() as u32,
        tile_count,
        records: &records,
    };
    let entries = any_entries(u, &paints, &tables)?;
    let entry_count = entries.len() as u32 / 2;
    let cells = (0..size[0] * size[1]).map(|_| cell(u, &paints, entry_count));
    let cells = cells.collect::<Result<Vec<_>>>()?;
    let texels_per_tile = (meta.grid.texels_per_cell + 1).pow(2);
    let mips = !images.is_empty() && images[0].rect_uv == [0.0, 0.0, 1.0, 1.0] && u.arbitrary()?;
    Ok(with_key(VtexFile {
        spec: SpecKey {
            features: if mips { Features::MIPS } else { 0 },
        },
        shader: ShaderBlob {
            abi: u.arbitrary()?,
            wgsl_fragment: u.arbitrary()?,
            batch_spirv: u.arbitrary()?,
        },
        shapes: any_shapes(&layers),
        tiles: tiles((tile_count * texels_per_tile) as usize),
        curves: records.concat(),
        outlines: stored,
        fine: (0..u.int_in_range(0..=5)?).collect(),
        provenance: None,
        meta,
        paints,
        gradients,
        cells,
        layers,
        entries,
        images,
    }))
}

fn paint(u: &mut Unstructured<'_>, gradients: &mut Vec<f32>) -> Result<PaintRecord> {
    if u.ratio(1, 3)? {
        return Ok(any_gradient(u)?.store(gradients));
    }
    let channel = |byte: u8| f32::from(byte) / 255.0;
    let [r, g, b] = u.arbitrary::<[u8; 3]>()?.map(channel);
    let alpha = if u.arbitrary()? { 1.0 } else { 0.5 };
    Ok(PaintRecord::solid([r, g, b, alpha]))
}

fn any_image(u: &mut Unstructured<'_>) -> Result<Image> {
    let rect = *u.choose(&[[0.0, 0.0, 1.0, 1.0], [-1.0, 0.5, 0.0, 0.75]])?;
    Ok(image(
        rect,
        [u.int_in_range(1..=90)?, u.int_in_range(1..=40)?],
    ))
}

fn any_layers(u: &mut Unstructured<'_>) -> Result<Vec<LayerRecord>> {
    let mut tile_first = 0;
    let mut layers = Vec::new();
    for _ in 0..u.int_in_range(0..=4)? {
        let tile_count = u.int_in_range(0..=3)?;
        layers.push(layer(tile_first, tile_count, u.int_in_range(0..=3)?));
        tile_first += tile_count;
    }
    Ok(layers)
}

fn any_shapes(layers: &[LayerRecord]) -> Vec<ShapeRecord> {
    let members = (0..).zip(layers).flat_map(|(index, layer)| {
        (0..layer.shape_count).map(move |_| shape(COVERAGE_MSDF, index, 0))
    });
    members.collect()
}

fn any_records(u: &mut Unstructured<'_>) -> Result<Vec<Vec<u32>>> {
    (0..u.int_in_range(0..=3)?).map(|_| any_record(u)).collect()
}

/// Arbitrary outlines of any extent, and the records that they make.
fn any_outlines(u: &mut Unstructured<'_>, grid: &Grid) -> Result<(Vec<Vec<u32>>, StoredOutlines)> {
    let outlines = (0..u.int_in_range(1..=3)?).map(|_| any_outline(u));
    let outlines = outlines.collect::<Result<Vec<_>>>()?;
    let lattice = CurveLattice::new(0.25).unwrap();
    let cells = grid.size_cells[0] * grid.size_cells[1];
    let mut stored = StoredOutlines {
        flatness_units: f32::from(u.int_in_range(0..=8_u8)?) / 4.0,
        ..StoredOutlines::default()
    };
    let mut records = Vec::new();
    for _ in 0..u.int_in_range(1..=4)? {
        let mut record = record_parts(u.int_in_range(0..=cells - 1)?, &[]);
        for _ in 0..u.int_in_range(1..=2)? {
            record.outlines.push(u.choose_index(outlines.len())? as u32);
        }
        let one = StoredOutlines {
            outlines: outlines.clone(),
            records: vec![record.clone()],
            ..stored
        };
        records.push(one.records(grid, lattice).unwrap());
        stored.records.push(record);
    }
    stored.outlines = outlines;
    Ok((records, stored))
}

/// A chain of segments, now and then broken or closed; coordinates small or as large as they go.
fn any_outline(u: &mut Unstructured<'_>) -> Result<StoredOutline> {
    let bits = u.int_in_range(4..=31)?;
    let point = |u: &mut Unstructured<'_>| -> Result<[i32; 2]> {
        Ok(u.arbitrary::<[i32; 2]>()?.map(|x| x >> (32 - bits)))
    };
    let mut from = point(u)?;
    let start = from;
    let mut segments = Vec::new();
    for _ in 0..u.int_in_range(1..=12)? {
        if u.ratio(1, 8)? {
            from = point(u)?;
        }
        let to = if u.ratio(1, 8)? { start } else { point(u)? };
        let share = i64::from(u.int_in_range(0..=8_u8)?);
        let between = [0, 1].map(|axis: usize| {
            let (a, b) = (i64::from(from[axis]), i64::from(to[axis]));
            (a + (b - a) * share / 8) as i32
        });
        let control = u.arbitrary::<bool>()?.then_some([between[0], to[1]]);
        segments.push(StoredSegment { from, control, to });
        from = to;
    }
    Ok(StoredOutline {
        even_odd: u.arbitrary()?,
        segments,
    })
}

fn any_record(u: &mut Unstructured<'_>) -> Result<Vec<u32>> {
    let count = |u: &mut Unstructured<'_>| u.int_in_range(0..=4);
    Ok(record(count(u)?, count(u)?, count(u)?))
}

/// What entries may name.
struct Tables<'a> {
    image_count: u32,
    tile_count: u32,
    records: &'a [Vec<u32>],
}

fn any_entries(
    u: &mut Unstructured<'_>,
    paints: &[PaintRecord],
    tables: &Tables<'_>,
) -> Result<Vec<u32>> {
    let count = u.int_in_range(0..=12)?;
    let mut words = Vec::new();
    for place in 1..=count {
        let paint = u.choose_index(paints.len())?;
        let mut entry = Entry {
            kind: EntryKind::Full,
            last: place == count || u.arbitrary()?,
            opaque: paints[paint].is_opaque() && u.arbitrary()?,
            index: paint as u32,
            data: 0,
        };
        if tables.tile_count > 0 && u.arbitrary()? {
            entry.kind = EntryKind::Msdf;
            entry.data = u.int_in_range(0..=tables.tile_count - 1)?;
        } else if !tables.records.is_empty() && u.arbitrary()? {
            let place = u.choose_index(tables.records.len())?;
            entry.kind = EntryKind::Curves;
            entry.data = tables.records[..place].concat().len() as u32;
        } else if tables.image_count > 0 && u.arbitrary()? {
            entry.kind = EntryKind::Image;
            entry.opaque = false;
            entry.index = u.int_in_range(0..=tables.image_count - 1)?;
        }
        words.extend(entry.encode().unwrap());
    }
    Ok(words)
}

fn cell(u: &mut Unstructured<'_>, paints: &[PaintRecord], entry_count: u32) -> Result<u32> {
    let word = match u.int_in_range(0..=2)? {
        1 => CellWord::Paint {
            paint: u.choose_index(paints.len())? as u32,
        },
        2 if entry_count > 0 => CellWord::List {
            offset_words: 2 * u.int_in_range(0..=entry_count - 1)?,
        },
        _ => CellWord::Empty,
    };
    Ok(word.encode().unwrap())
}
