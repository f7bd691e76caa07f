//! Random textures: every feature a packed texture can have, without a baker.

use std::sync::Arc;

use vtex_format::{
    AddressMode, CURVE_LINE_WORDS, CURVE_QUAD_WORDS, CellWord, CurveHeader, CurveLattice,
    DistanceOutline, Entry, EntryKind, Features, Gradient, GradientShape, GradientStop, Grid,
    Image, MAX_BLEND_DEPTH, Meta, PaintRecord, SHALLOW_BLEND_DEPTH, SamplerSettings, SpecKey,
    Spread, VtexFile,
};

use crate::clips_and_groups::{self, Wants};
use crate::random::Random;

const DISTANCE_RANGE_TEXELS: f32 = 4.0;
const PAINTS: u32 = 12;
/// Those of them that are solid where some are gradients.
const SOLIDS: u32 = 4;
const TILES: u32 = 40;
const RECORDS: u32 = 40;
/// Rectangles, sizes and least alphas of patches. The last one is opaque.
const PATCHES: [([f32; 4], [u32; 2], u8); 3] = [
    ([0.1, 0.2, 0.75, 0.9], [17, 30], 0),
    ([0.4, -0.3, 1.4, 0.6], [64, 64], 0),
    ([0.2, 0.3, 0.7, 1.2], [20, 12], 255),
];

/// A texture made of what `features` (bits of [`Features`]) names, else random from `seed`.
///
/// Neighbouring cells need not join: only the evaluators read it, no eye.
///
/// # Panics
/// Never: what it encodes is small.
pub fn random_texture(seed: u64, features: u32) -> VtexFile {
    let mut random = Random::new(seed);
    let r = &mut random;
    let has = |feature| features & feature != 0;
    let grid = random_grid(r);
    let sampler = random_settings(r, features);
    let paint = |_| random_paint(r, has(Features::TRANSLUCENT));
    let paints = (0..PAINTS).map(paint).collect();
    let meta = Meta {
        distance_range_texels: DISTANCE_RANGE_TEXELS,
        sampler,
        ..Meta::new(grid.cell_from_uv_scale, grid)
    };
    let mut file = VtexFile {
        paints,
        cells: Vec::new(),
        ..VtexFile::blank(meta)
    };
    if has(Features::GRADIENTS) {
        for paint in &mut file.paints[SOLIDS as usize..] {
            let gradient = random_gradient(r, has(Features::TRANSLUCENT));
            *paint = gradient.store(&mut file.gradients);
        }
    }
    let mut records = Vec::new();
    if has(Features::MIPS) {
        file.spec.features |= Features::MIPS;
        file.images
            .push(random_image(r, [0.0, 0.0, 1.0, 1.0], [61, 33], 0));
    }
    if has(Features::IMAGES) {
        for (rect_uv, size, least_alpha) in PATCHES {
            file.images
                .push(random_image(r, rect_uv, size, least_alpha));
        }
    }
    if has(Features::CURVES) {
        file.meta.curve_lattice = CurveLattice::new(r.between(0.1, 1.0));
        records = (0..RECORDS)
            .map(|_| push_random_record(r, &mut file))
            .collect();
    }
    if has(Features::MSDF) {
        let side = file.meta.grid.texels_per_cell + 1;
        file.tiles = (0..TILES).flat_map(|_| random_tile(r, side)).collect();
    }
    let [columns, rows] = file.meta.grid.size_cells;
    for _ in 0..columns * rows {
        let cell = random_cell(r, &mut file, features, &records);
        file.cells.push(cell.encode().expect("small indices"));
    }
    file.spec = SpecKey::for_file(&file);
    file
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a handful of cells"
)]
fn random_grid(r: &mut Random) -> Grid {
    let scale = [r.between(5.0, 20.0), r.between(5.0, 20.0)];
    let offset = [r.unit(), r.unit()];
    Grid {
        size_cells: [0, 1].map(|i| (scale[i] + offset[i]).ceil() as u32),
        cell_from_uv_scale: scale,
        cell_from_uv_offset: offset,
        texels_per_cell: [1, 4, 8, 11][r.below(4) as usize],
    }
}

fn random_settings(r: &mut Random, features: u32) -> SamplerSettings {
    let has = |feature| features & feature != 0;
    let mut settings = SamplerSettings {
        address: [(); 2].map(|()| match has(Features::MAPPING) {
            true => AddressMode::ALL[r.below(4) as usize],
            false => AddressMode::Clamp,
        }),
        smoothing: r.between(0.02, 0.3),
        mask: has(Features::MASK),
        outline: has(Features::OUTLINE).then(|| DistanceOutline {
            width_texels: r.between(0.2, 1.2),
            paint: r.below(if has(Features::GRADIENTS) {
                SOLIDS
            } else {
                PAINTS
            }),
        }),
        ..SamplerSettings::default()
    };
    if has(Features::MAPPING) && r.below(2) == 0 {
        settings.texture_matrix = [(); 6].map(|()| r.between(-1.5, 1.5));
    }
    settings
}

fn random_paint(r: &mut Random, translucent: bool) -> PaintRecord {
    let alpha = if translucent && r.below(2) == 0 {
        r.between(0.05, 0.95)
    } else {
        1.0
    };
    PaintRecord::solid([r.unit(), r.unit(), r.unit(), alpha])
}

/// Of any shape and spread, of one stop or a hundred; opaque unless `translucent`.
///
/// Not so steep that a rounding shows: no two stops lie much closer together than others, unless at
/// one offset, and `t` does not grow without bound.
#[expect(clippy::cast_precision_loss, reason = "a hundred stops")]
fn random_gradient(r: &mut Random, translucent: bool) -> Gradient {
    let shape = match r.below(3) {
        0 => GradientShape::Linear {
            t_from_uv: [(); 3].map(|()| r.between(-3.0, 3.0)),
        },
        kind => {
            let [distance, focal_radius] = random_circles(r, kind == 2, translucent);
            GradientShape::Radial {
                circle_from_uv: [(); 6].map(|()| r.between(-2.0, 2.0)),
                distance,
                focal_radius,
            }
        }
    };
    let count = [1, 2, 2, 3, 4, 5, 8, 9, 17, 100][r.below(10) as usize];
    let offset = |i: u32| (i as f32 + r.between(0.25, 0.75)) / count as f32;
    let mut offsets: Vec<f32> = (0..count).map(offset).collect();
    if count > 4 {
        offsets[2] = offsets[1];
    }
    let stop = |offset| GradientStop {
        offset,
        color: random_paint(r, translucent).color,
    };
    let stops = offsets.into_iter().map(stop).collect();
    Gradient {
        shape,
        spread: [Spread::Pad, Spread::Reflect, Spread::Repeat][r.below(3) as usize],
        stops,
    }
}

/// Distance and focal radius, not near those of which `t` is the quotient of two small numbers.
fn random_circles(r: &mut Random, apart: bool, translucent: bool) -> [f32; 2] {
    loop {
        let far = if translucent { 2.0 } else { 0.6 };
        let distance = if apart { r.between(0.0, far) } else { 0.0 };
        let focal_radius = [0.0, r.between(0.0, 0.4)][r.below(2) as usize];
        let rest = 1.0 - focal_radius;
        if (distance * distance - rest * rest).abs() > 0.1 {
            return [distance, focal_radius];
        }
    }
}

fn random_byte(r: &mut Random) -> u8 {
    r.bits().to_le_bytes()[0]
}

/// Rounded to a byte; `value` in \[0, 1\] after clamping.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped"
)]
fn byte(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// A tile of three random edges, one a channel, as an MSDF has them.
#[expect(clippy::cast_precision_loss, reason = "a handful of texels")]
fn random_tile(r: &mut Random, side: u32) -> Vec<u8> {
    let edges = [(); 3].map(|()| {
        let angle = r.between(0.0, std::f32::consts::TAU);
        let middle = side as f32 * 0.5;
        let offset = r.between(-middle, middle);
        (
            angle.cos(),
            angle.sin(),
            middle * (angle.cos() + angle.sin()) + offset,
        )
    });
    let mut texels = Vec::new();
    for y in 0..side {
        for x in 0..side {
            for (nx, ny, at) in edges {
                let distance = nx * x as f32 + ny * y as f32 - at;
                texels.push(byte(distance / DISTANCE_RANGE_TEXELS + 0.5));
            }
            texels.push(255);
        }
    }
    texels
}

/// Appends a record of random closed contours of lines and quadratics; returns its place.
///
/// # Panics
/// Never: the contours are short.
fn push_random_record(r: &mut Random, file: &mut VtexFile) -> u32 {
    // Lines and quadratics, those that run up, those that run down.
    let mut by_direction = [const { Vec::<u32>::new() }; 4];
    for _ in 0..=r.below(3) {
        let corners: Vec<[u32; 2]> = (0..3 + r.below(6))
            .map(|_| [(); 2].map(|()| r.below(1 << 16)))
            .collect();
        for (&from, &to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let down = to[1] > from[1];
            let [a, b] = if down { [from, to] } else { [to, from] };
            let word = |[x, y]: [u32; 2]| x | y << 16;
            if r.below(2) == 0 {
                by_direction[usize::from(down)].extend([word(a), word(b)]);
            } else {
                // Between the ends, so that both coordinates are monotone.
                let between = |i: usize| {
                    let [low, high] = [a[i].min(b[i]), a[i].max(b[i])];
                    low + (r.below(high - low + 1))
                };
                let control = [0, 1].map(between);
                by_direction[2 + usize::from(down)].extend([word(a), word(control), word(b)]);
            }
        }
    }
    let steps: Vec<u32> = (0..r.below(3))
        .map(|_| r.below(1 << 16) | (r.below(2) * 2).wrapping_sub(1) << 16)
        .collect();
    let count = |words: usize| u32::try_from(words).expect("short contours");
    let header = CurveHeader {
        line_count: count(by_direction[0].len() + by_direction[1].len()) / CURVE_LINE_WORDS,
        down_line_count: count(by_direction[1].len()) / CURVE_LINE_WORDS,
        quad_count: count(by_direction[2].len() + by_direction[3].len()) / CURVE_QUAD_WORDS,
        down_quad_count: count(by_direction[3].len()) / CURVE_QUAD_WORDS,
        step_count: count(steps.len()),
        even_odd: r.below(2) == 0,
        base_winding: [0, 0, 1, -1][r.below(4) as usize],
    };
    let place = count(file.curves.len());
    file.curves.extend(header.encode().expect("short contours"));
    let [up_lines, down_lines, up_quads, down_quads] = by_direction;
    let parts = [steps, down_lines, up_lines, down_quads, up_quads];
    file.curves.extend(parts.concat());
    place
}

/// Premultiplied noise with a full chain of its own noise: levels need not be averages here.
fn random_image(r: &mut Random, rect_uv: [f32; 4], size: [u32; 2], least_alpha: u8) -> Image {
    let mips = (0..Image::level_count(size)).map(|level| {
        let [width, height] = Image::level_size(size, level);
        let texel = |_| {
            let alpha = random_byte(r).max(least_alpha);
            let mut color = || random_byte(r).min(alpha);
            [color(), color(), color(), alpha]
        };
        (0..width * height).flat_map(texel).collect()
    });
    Image {
        rect_uv,
        size,
        mips: Arc::new(mips.collect()),
    }
}

fn random_cell(r: &mut Random, file: &mut VtexFile, features: u32, records: &[u32]) -> CellWord {
    match r.below(6) {
        0 => return CellWord::Empty,
        1 => {
            return CellWord::Paint {
                paint: r.below(PAINTS),
            };
        }
        _ if features & Features::LISTS == 0 => return CellWord::Empty,
        _ => {}
    }
    let offset_words = u32::try_from(file.entries.len()).expect("a small file");
    let grouped = features & (Features::CLIPS | Features::GROUPS) != 0;
    let entries = if grouped && r.below(4) > 0 {
        grouped_list(r, file, features, records)
    } else {
        plain_list(r, file, features, records)
    };
    for entry in entries {
        file.entries.extend(entry.encode().expect("small indices"));
    }
    CellWord::List { offset_words }
}

fn plain_list(r: &mut Random, file: &VtexFile, features: u32, records: &[u32]) -> Vec<Entry> {
    // Some lists are long: they test the loops' bounds.
    let length = if r.below(100) == 0 {
        60
    } else {
        1 + r.below(7)
    };
    (1..=length)
        .map(|i| random_entry(r, file, features, records, i == length))
        .collect()
}

/// A tree of clips and groups, in which entries of any kind draw.
fn grouped_list(r: &mut Random, file: &VtexFile, features: u32, records: &[u32]) -> Vec<Entry> {
    let wants = Wants {
        clips: features & Features::CLIPS != 0,
        groups: features & Features::GROUPS != 0,
        blends: features & Features::BLENDS != 0,
    };
    let depth = if features & Features::DEEP_GROUPS != 0 {
        MAX_BLEND_DEPTH
    } else {
        SHALLOW_BLEND_DEPTH
    };
    let mut entries = clips_and_groups::random_list(r, wants, records, depth);
    for entry in &mut entries {
        if entry.kind.draws() {
            *entry = random_entry(r, file, features, records, false);
        }
    }
    if let Some(last) = entries.last_mut() {
        last.last = true;
    }
    entries
}

fn random_entry(
    r: &mut Random,
    file: &VtexFile,
    features: u32,
    records: &[u32],
    last: bool,
) -> Entry {
    let has = |feature| features & feature != 0;
    let grouped = has(Features::CLIPS) || has(Features::GROUPS);
    let kinds = [
        (
            EntryKind::Full,
            !has(Features::MSDF) && !has(Features::CURVES) || last || grouped && r.below(4) == 0,
        ),
        (EntryKind::Image, has(Features::IMAGES)),
        (EntryKind::Msdf, has(Features::MSDF)),
        (EntryKind::Msdf, has(Features::MSDF)),
        (EntryKind::Curves, has(Features::CURVES)),
        (EntryKind::Curves, has(Features::CURVES)),
    ];
    let possible: Vec<EntryKind> = kinds
        .iter()
        .filter(|(_, possible)| *possible)
        .map(|(kind, _)| *kind)
        .collect();
    let kind = possible[r.below(u32::try_from(possible.len()).expect("six")) as usize];
    let patches = u32::try_from(file.images.len()).expect("four");
    let first_patch = u32::from(has(Features::MIPS));
    let index = match kind {
        EntryKind::Image => first_patch + r.below(patches - first_patch),
        _ => r.below(PAINTS),
    };
    let opaque = match kind {
        // The last patch is opaque; a file need not say so.
        EntryKind::Image => index + 1 == patches && r.below(2) == 0,
        _ => file.paints[index as usize].is_opaque(),
    };
    Entry {
        kind,
        last,
        opaque,
        index,
        data: match kind {
            EntryKind::Msdf => r.below(TILES),
            EntryKind::Curves => records[r.below(RECORDS) as usize],
            _ => 0,
        },
    }
}
