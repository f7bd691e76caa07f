//! A file as the words that evaluators read.

use std::collections::BTreeMap;
use std::sync::Arc;

use vtex_format::{
    AddressMode, Features, Gradient, GradientShape, PaintRecord, SHADER_ABI, SamplerSettings,
    SpecKey, VtexFile,
};

use crate::cores::map_all;
use crate::cpu::{color, to_f32, to_u32};
use crate::fine;
use crate::layout::{FilterMode, FootprintSamples, OFFSET_END, gradient, header, image, paint};
use crate::packed::{Packed, PackedSet, place_word};
use crate::spec::spec_key;
use crate::subdivide::{Grid, subdivide};
use crate::texels::{Level, MAX_PAGE_SIDE, Place, TexelPages, levels_of};

/// Evaluators read four words at a time.
const GROUP_WORDS: usize = 4;

/// What a caller sets or overrides when a texture is loaded.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PackOptions {
    /// How lookups filter.
    pub filter: FilterMode,
    /// Address modes along u and v instead of the file's.
    pub address: Option<[AddressMode; 2]>,
    /// Texture matrix instead of the file's, as [`SamplerSettings::texture_matrix`].
    pub texture_matrix: Option<[f32; 6]>,
    /// Half width S of \[SFG22\] eq. 1 instead of the file's, in (0, 0.5].
    pub smoothing: Option<f32>,
    /// How often the file's cells are halved where they show edges, at most 6, instead of what the
    /// cost model finds best for each of them (docs/decisions/0019).
    pub halvings: Option<u32>,
    /// How many samples a footprint has, where `filter` is [`FilterMode::Footprint`].
    pub samples: FootprintSamples,
}

impl PackOptions {
    /// The file's settings with the overrides in place.
    pub(crate) fn applied_to(&self, stored: &SamplerSettings) -> SamplerSettings {
        SamplerSettings {
            texture_matrix: self.texture_matrix.unwrap_or(stored.texture_matrix),
            address: self.address.unwrap_or(stored.address),
            smoothing: self.smoothing.unwrap_or(stored.smoothing),
            mask: stored.mask,
            outline: stored.outline,
        }
    }
}

/// A texture's words and texels.
///
/// They go with the text of [`spec_key`] of the same file and options. `file` is to be one that the
/// format's validator finds nothing in; another gives a wrong picture, never a panic.
pub fn pack(file: &VtexFile, options: &PackOptions) -> Packed {
    pack_in_pages(file, options, MAX_PAGE_SIDE)
}

/// As [`pack`], for a set of many: a page has at most `page_side` texels a side, more only where a level
/// of an image has. [`Packed::move_pages`] says where the pages come to lie.
pub fn pack_in_pages(file: &VtexFile, options: &PackOptions, page_side: u32) -> Packed {
    let words = texture_words(file, options);
    let set = joined(std::iter::once((file, words)), page_side);
    Packed {
        words: set.words,
        texels: set.texels,
    }
}

/// Textures that share their words and texels, each as [`pack`] has it. The text is that of all their
/// features.
///
/// Several are packed at once, on as many threads as the machine has cores.
pub fn pack_set<'a>(
    textures: impl IntoIterator<Item = (&'a VtexFile, &'a PackOptions)>,
) -> PackedSet {
    let textures: Vec<_> = textures.into_iter().collect();
    let words = map_all(&textures, 0, |(file, options)| texture_words(file, options));
    let files = textures.into_iter().map(|(file, _)| file);
    joined(files.zip(words), MAX_PAGE_SIDE)
}

/// Puts textures' words one behind the other, and the texels of their images into pages.
fn joined<'a>(
    textures: impl Iterator<Item = (&'a VtexFile, Vec<u32>)>,
    page_side: u32,
) -> PackedSet {
    let mut words = Vec::new();
    let mut first_words = Vec::new();
    let mut images = Vec::new();
    let mut levels = Vec::new();
    for (file, texture) in textures {
        first_words.push(word_index(words.len()));
        images.extend(image_levels(&mut levels, words.len(), &texture, file));
        // One texture alone is not copied.
        match words.is_empty() {
            true => words = texture,
            false => words.extend(texture),
        }
    }
    let (texels, places) = TexelPages::filled(&levels, page_side);
    for image in images {
        place_levels(&mut words, &image, &places);
    }
    PackedSet {
        words,
        first_words,
        texels,
    }
}

/// A file that was read to be looked up and for nothing else.
#[cfg(feature = "decode")]
#[derive(Clone, Debug)]
pub struct Loaded {
    /// What evaluators read, as [`pack`] makes it.
    pub packed: Packed,
    /// As [`spec_key`] gives it.
    pub key: SpecKey,
    /// Canvas, grid and sampler settings of the file.
    pub meta: vtex_format::Meta,
    /// The shader that the file carries.
    pub shader: vtex_format::ShaderBlob,
}

/// Reads and packs a file. Where it carries its fine cells for these options (`vtex bake --profile load`)
/// it need not decode and cut its outlines: that takes a fraction of the time of
/// [`VtexFile::parse`](vtex_format::VtexFile::parse) and [`pack`]. The result is the same.
///
/// # Errors
/// As [`VtexFile::parse_unless`](vtex_format::VtexFile::parse_unless).
#[cfg(feature = "decode")]
pub fn load(
    bytes: &[u8],
    limits: &vtex_format::Limits,
    options: &PackOptions,
) -> Result<Loaded, vtex_format::ReadError> {
    load_in_pages(bytes, limits, options, MAX_PAGE_SIDE)
}

/// As [`load`], with pages as [`pack_in_pages`] has them.
///
/// # Errors
/// As [`VtexFile::parse_unless`](vtex_format::VtexFile::parse_unless).
#[cfg(feature = "decode")]
pub fn load_in_pages(
    bytes: &[u8],
    limits: &vtex_format::Limits,
    options: &PackOptions,
    page_side: u32,
) -> Result<Loaded, vtex_format::ReadError> {
    let mut grid = None;
    let file = VtexFile::parse_unless(bytes, limits, &mut |file| {
        grid = stored_grid(file, options);
        grid.is_some()
    })?;
    let words = match grid {
        Some(grid) => words_of(&file, options, &grid, fine::commands(&file)),
        None => texture_words(&file, options),
    };
    let set = joined(std::iter::once((&file, words)), page_side);
    Ok(Loaded {
        packed: Packed {
            words: set.words,
            texels: set.texels,
        },
        key: spec_key(&file, options),
        meta: file.meta,
        shader: file.shader,
    })
}

/// A texture's words, in which the images' texels have no place yet.
fn texture_words(file: &VtexFile, options: &PackOptions) -> Vec<u32> {
    if let Some(grid) = stored_grid(file, options) {
        return words_of(file, options, &grid, fine::commands(file));
    }
    let made = subdivide(file, options.filter, options.halvings);
    words_of(file, options, &made.grid, made.commands.as_flattened())
}

/// The cells that the file carries, where they are those that these options ask for.
fn stored_grid(file: &VtexFile, options: &PackOptions) -> Option<Grid> {
    if file.fine.is_empty() || options.halvings.is_some() {
        return None;
    }
    fine::grid(file, options.filter, spec_key(file, options).features)
}

fn words_of(file: &VtexFile, options: &PackOptions, grid: &Grid, commands: &[u32]) -> Vec<u32> {
    let key = spec_key(file, options);
    let mut words = header_words(file, options, &key);
    let [right, bottom] = file.meta.grid.size_cells.map(last_place);
    let columns = to_f32(word_index(grid.size[0]));
    let base = [right, bottom, grid.base_per_cell(), columns].map(f32::to_bits);
    words[header::BASE as usize..][..4].copy_from_slice(&base);
    words.reserve(grid.words.len() + commands.len() + file.tiles.len() / 4);
    match options.filter {
        FilterMode::Footprint => section(&mut words, header::CELLS, &grid.words),
        FilterMode::Point | FilterMode::Paper => {
            section(&mut words, header::CELLS, &grid.narrowed());
        }
    }
    section(&mut words, header::COMMANDS, commands);
    paint_section(&mut words, file);
    let texels = file.tiles.chunks_exact(4);
    let tiles: Vec<u32> = texels
        .map(|t| u32::from_le_bytes([t[0], t[1], t[2], t[3]]))
        .collect();
    section(&mut words, header::TILES, &tiles);
    image_words(&mut words, file);
    words.resize(words.len().next_multiple_of(GROUP_WORDS), 0);
    words
}

/// The last place along an axis of so many cells.
fn last_place(cells: u32) -> f32 {
    to_f32(cells.max(1)).next_down()
}

fn header_words(file: &VtexFile, options: &PackOptions, key: &SpecKey) -> Vec<u32> {
    let sampler = options.applied_to(&file.meta.sampler);
    let grid = &file.meta.grid;
    let mut words = vec![0; header::WORDS as usize];
    let mut put = |at: u32, values: &[u32]| {
        words[at as usize..][..values.len()].copy_from_slice(values);
    };
    put(header::ABI, &[SHADER_ABI]);
    let samples = (options.samples as u32).ilog2() << header::SAMPLES_SHIFT;
    put(header::FEATURES, &[key.features | samples]);
    put(header::FILTER, &[options.filter as u32]);
    put(header::ADDRESS_U, &sampler.address.map(|mode| mode as u32));
    put(
        header::DISTANCE_RANGE,
        &[file.meta.distance_range_texels, sampler.smoothing].map(f32::to_bits),
    );
    put(
        header::TEXTURE_MATRIX,
        &sampler.texture_matrix.map(f32::to_bits),
    );
    if let (Some(outline), true) = (sampler.outline, key.features & Features::OUTLINE != 0) {
        put(header::OUTLINE_WIDTH, &[outline.width_texels.to_bits()]);
        put(header::OUTLINE_PAINT, &[outline.paint]);
    }
    let [scale, offset] = [grid.cell_from_uv_scale, grid.cell_from_uv_offset];
    let cell_from_uv = [scale[0], scale[1], offset[0], offset[1]];
    put(header::CELL_FROM_UV, &cell_from_uv.map(f32::to_bits));
    if let Some(lattice) = file.meta.curve_lattice {
        let units = [lattice.units_per_cell, lattice.margin_units];
        put(
            header::CURVE_UNITS,
            &units.map(|units| to_f32(units).to_bits()),
        );
    }
    put(header::TEXELS_PER_CELL, &[grid.texels_per_cell]);
    if let (Some(canvas), true) = (file.images.first(), key.features & Features::MIPS != 0) {
        // Texels need not be square, cells are.
        let [x, y] = [0, 1].map(|axis| to_f32(canvas.size[axis]) / scale[axis]);
        let texels = (x * y).sqrt();
        put(header::MIP_TEXELS_PER_CELL, &[texels.to_bits()]);
    }
    words
}

/// Appends a section at the next group of four words and writes its first word into the header.
fn section(words: &mut Vec<u32>, header_word: u32, values: &[u32]) {
    words.resize(words.len().next_multiple_of(GROUP_WORDS), 0);
    words[header_word as usize] = word_index(words.len());
    words.extend_from_slice(values);
}

/// A texture beyond 2^32 words fits no GPU; its offsets saturate and lookups read zeros.
fn word_index(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX)
}

/// Paints, then the gradients that they name.
fn paint_section(words: &mut Vec<u32>, file: &VtexFile) {
    let first = words.len().next_multiple_of(GROUP_WORDS);
    let gradients_first = first + file.paints.len() * paint::WORDS as usize;
    let mut gradients = Vec::new();
    let mut paints = Vec::with_capacity(gradients_first - first);
    for record in &file.paints {
        let stored = Gradient::of(record, &file.gradients);
        paints.extend(match stored {
            Some(stored) => {
                let first = word_index(gradients_first + gradients.len());
                gradient_words(&mut gradients, &stored);
                [first, paint::GRADIENT, 0, 0]
            }
            None => solid_words(record),
        });
    }
    section(words, header::PAINTS, &paints);
    words.extend(gradients);
}

fn solid_words(paint: &PaintRecord) -> [u32; 4] {
    let [r, g, b, a] = paint.color;
    let linear = color::decode([r, g, b]).map(|c| c * a);
    let [linear, straight] =
        [[linear[0], linear[1], linear[2], a], paint.color].map(|c| c.map(share));
    [
        linear[0] | linear[1] << 16,
        linear[2] | linear[3] << 16,
        straight[0] | straight[1] << 16,
        straight[2] | straight[3] << 16,
    ]
}

/// Of [`paint::UNIT`].
fn share(channel: f32) -> u32 {
    to_u32((channel.clamp(0.0, 1.0) * to_f32(paint::UNIT)).round())
}

#[expect(clippy::cast_possible_truncation, reason = "evaluators work in f32")]
fn gradient_words(words: &mut Vec<u32>, stored: &Gradient) {
    let spread = (stored.spread as u32) << gradient::SPREAD_MASK.trailing_zeros();
    let about = word_index(stored.stops.len()) | spread;
    match stored.shape {
        GradientShape::Linear { t_from_uv } => {
            words.extend(t_from_uv.map(f32::to_bits));
            words.push(about | gradient::LINEAR);
        }
        GradientShape::Radial {
            circle_from_uv: [a, b, c, d, e, f],
            distance,
            focal_radius,
        } => {
            let round = distance <= 0.0 && focal_radius <= 0.0;
            let kind = if round {
                gradient::ROUND
            } else {
                gradient::CIRCLES
            };
            words.extend([a, c, e].map(f32::to_bits));
            words.push(about | kind);
            let leading = stored.shape.leading() as f32;
            words.extend([b, d, f, leading].map(f32::to_bits));
            words.extend([distance, focal_radius, 0.0, 0.0].map(f32::to_bits));
        }
    }
    words.extend(stored.stops.iter().map(|stop| stop.offset.to_bits()));
    words.resize(
        words.len().next_multiple_of(GROUP_WORDS),
        OFFSET_END.to_bits(),
    );
    words.extend(
        stored
            .stops
            .iter()
            .flat_map(|stop| stop.color.map(f32::to_bits)),
    );
}

/// The records, in which the levels have no place yet.
fn image_words(words: &mut Vec<u32>, file: &VtexFile) {
    let records = file.images.iter().flat_map(|stored| {
        let mut record = [0; image::WORDS as usize];
        let rect = stored.rect_uv.map(f32::to_bits);
        record[image::RECT_UV as usize..][..4].copy_from_slice(&rect);
        let (left_out, levels) = levels_of(stored, [false; 2]);
        let part = 0.5_f32.powi(left_out.cast_signed());
        let size = stored.size.map(|side| (part * to_f32(side)).to_bits());
        record[image::SIZE as usize..][..2].copy_from_slice(&size);
        let last = levels.len().saturating_sub(1);
        record[image::LAST_LEVEL as usize] = word_index(last);
        record
    });
    let records: Vec<u32> = records.collect();
    section(words, header::IMAGES, &records);
    if let Some(about) = records.get(image::SIZE as usize..image::SIZE as usize + 3) {
        words[header::MIP_SIZE as usize..][..3].copy_from_slice(about);
    }
}

/// An image whose levels have no place yet.
struct Unplaced {
    /// Word of the place of its first level.
    places: usize,
    /// Its levels among all.
    levels: std::ops::Range<usize>,
}

/// Appends the levels of the images of a texture, whose words come to lie at `first`.
fn image_levels<'a>(
    levels: &mut Vec<Level<'a>>,
    first: usize,
    texture: &[u32],
    file: &'a VtexFile,
) -> Vec<Unplaced> {
    let word = |at: u32| texture[at as usize];
    let records = first + word(header::IMAGES) as usize;
    let address = [word(header::ADDRESS_U), word(header::ADDRESS_U + 1)];
    let repeats = address.map(|mode| mode == AddressMode::Repeat as u32);
    let has_canvas = word(header::FEATURES) & Features::MIPS != 0;
    // Texels that images share are packed once.
    let mut packed = BTreeMap::new();
    let images = file.images.iter().enumerate().map(|(index, stored)| {
        let is_canvas = index == 0 && has_canvas;
        let wraps = if is_canvas { repeats } else { [false; 2] };
        let texels = (Arc::as_ptr(&stored.mips), wraps);
        let own = packed.entry(texels).or_insert_with(|| {
            let (_, own) = levels_of(stored, wraps);
            let from = levels.len();
            levels.extend(own);
            from..levels.len()
        });
        Unplaced {
            places: records + index * image::WORDS as usize + image::LEVELS as usize,
            levels: own.clone(),
        }
    });
    images.collect()
}

fn place_levels(words: &mut [u32], unplaced: &Unplaced, places: &[Place]) {
    let words = words[unplaced.places..].iter_mut();
    for (word, place) in words.zip(&places[unplaced.levels.clone()]) {
        *word = place_word(*place);
    }
}
