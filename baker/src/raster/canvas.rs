//! The canvas image: mips of the whole canvas, averaged from lookups in the finished cells.
//!
//! A rasteriser composites coverage as alpha, and where opaque shapes abut the background then
//! shows through. A mean of exact point lookups cannot show what none of them returns.

use std::sync::Arc;

use rayon::prelude::*;
use vtex_format::{AddressMode, Image, MAX_MIPS, PaintRecord, VtexFile};
use vtex_shaders::{FilterMode, PackOptions, cpu::Sampler, pack};

use crate::{
    config::Mode,
    number::floor_u32,
    raster::{
        mips::{self, LinearImage},
        palette, texel,
    },
};

/// The canvas in uv.
const WHOLE: [f32; 4] = [0.0, 0.0, 1.0, 1.0];
/// How often cells are halved for these lookups. A fine cell is then about one texel wide; dividing
/// further costs more than so few lookups save. For 2, 3 and 4 the bake of the Tiger takes 0.28,
/// 0.26 and 0.29 s of CPU time.
const HALVINGS: u32 = 3;
/// Segments that all fine cells may hold together. Drawings with more are halved less often.
const MAX_SEGMENTS: f64 = 1e7;
/// Segments that all lookups together may test, which takes a second or two. Drawings with more get
/// fewer lookups in a texel.
const MAX_WALKED: f64 = 3e8;
/// Number n of lookups in a texel that has more than one colour, and a generator g. Lookup i lies
/// at `((i + 1/2) / n, (g i mod n + 1/2) / n)` of the texel, a rank-1 lattice: no two share a row
/// or a column. The nearest of 32 are 5.7/32 apart; the best possible lattice would have 6.1/32.
const LOOKUPS: [(u16, u16); 3] = [(32, 7), (16, 7), (8, 3)];

/// How much work goes into the mips of one drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Effort {
    halvings: u32,
    /// One of [`LOOKUPS`].
    lookups: (u16, u16),
}

impl Effort {
    /// As much as the drawing's segments allow. A segment takes at most three words of the file,
    /// and a halving about doubles the number of cells that hold it.
    fn of(file: &VtexFile, size: [u32; 2]) -> Self {
        let segments = file.curves.len() as f64 / 3.0;
        let fits = |halvings: &u32| segments * f64::from(1_u32 << halvings) <= MAX_SEGMENTS;
        // As many halvings as fit the budget, then as many lookups as fit theirs.
        let halvings = (0..=HALVINGS).rev().find(fits).unwrap_or(0);
        let cells = file.cells.len().max(1) as f64 * f64::from(1_u32 << halvings);
        let walked = segments / cells * f64::from(size[0]) * f64::from(size[1]);
        let fits = |lookups: &&(u16, u16)| walked * f64::from(lookups.0) <= MAX_WALKED;
        let lookups = LOOKUPS
            .iter()
            .find(fits)
            .unwrap_or(&LOOKUPS[LOOKUPS.len() - 1]);
        Self {
            halvings,
            lookups: *lookups,
        }
    }
}

/// Size of the canvas image if its longer side has about `longer_side` texels. Both sides are powers
/// of two, as textures of levels want them: the nearest, so a texel is at most 1.42 times as long as
/// wide where the canvas has room for more than one.
pub(crate) fn canvas_texels(canvas_size: [f64; 2], longer_side: u32) -> [u32; 2] {
    let scale = nearest_power(f64::from(longer_side)) / canvas_size[0].max(canvas_size[1]);
    canvas_size.map(|side| floor_u32(nearest_power(side * scale)))
}

/// The nearest power of two by ratio, at least 1.
fn nearest_power(value: f64) -> f64 {
    value.max(1.0).log2().round().exp2()
}

/// A placeholder for image 0 in a file that gets its mips last.
pub(crate) fn no_mips() -> Image {
    Image {
        rect_uv: [0.0; 4],
        size: [0; 2],
        mips: Arc::default(),
    }
}

/// Bytes of the packed words that the lookups read, and how often they halve cells less than
/// [`HALVINGS`] times.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LookedUp {
    pub(crate) word_bytes: usize,
    pub(crate) fewer_halvings: u32,
}

/// Puts the mips into image 0 of `file`, which is [`no_mips`] so far. Level 0 has `size` texels. What
/// lookups read for them, if there were any.
pub(crate) fn add_mips(file: &mut VtexFile, size: [u32; 2], mode: Mode) -> Option<LookedUp> {
    let (mips, read) = match file.images.as_slice() {
        // Averaging the raster itself is exact and faster than lookups in it.
        [_, raster] if mode == Mode::Raster => (raster_mips(raster, size), None),
        _ => {
            let (mips, read) = cell_mips(file, size);
            (mips, Some(read))
        }
    };
    if let Some(canvas) = file.images.first_mut() {
        *canvas = mips;
    }
    read
}

/// The mips of a canvas that is one raster.
fn raster_mips(raster: &Image, size: [u32; 2]) -> Image {
    let stored = raster.mips.first().map_or(&[][..], Vec::as_slice);
    let texels = stored.as_chunks::<4>().0.par_iter();
    let finest = LinearImage {
        size: raster.size,
        texels: texels
            .map(|&texel| texel::linear_from_stored(texel))
            .collect(),
    };
    mips::chain(finest.reduced(size), WHOLE, MAX_MIPS)
}

/// The mips of what the cells show.
fn cell_mips(file: &mut VtexFile, size: [u32; 2]) -> (Image, LookedUp) {
    // With `--mask` lookups return alpha alone, but mips hold the whole picture.
    let mask = std::mem::take(&mut file.meta.sampler.mask);
    let (finest, read) = looked_up(file, size);
    let mut image = mips::chain(finest, WHOLE, MAX_MIPS);
    file.meta.sampler.mask = mask;
    // Merging colours would turn gradients into bands, and images may hold gradients too.
    let gradients = file.paints.iter().any(PaintRecord::is_gradient);
    if file.images.len() == 1 && !gradients {
        Arc::make_mut(&mut image.mips)
            .par_iter_mut()
            .for_each(|level| palette::join_near_colors(level));
    }
    (image, read)
}

/// What the cells show, in linear light, on `size` texels.
pub(crate) fn picture(file: &VtexFile, size: [u32; 2]) -> LinearImage {
    looked_up(file, size).0
}

fn looked_up(file: &VtexFile, size: [u32; 2]) -> (LinearImage, LookedUp) {
    let effort = Effort::of(file, size);
    // The canvas itself, without the texture matrix and address mode that place it on a surface.
    let options = PackOptions {
        filter: FilterMode::Point,
        address: Some([AddressMode::Clamp; 2]),
        texture_matrix: Some([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
        halvings: Some(effort.halvings),
        ..PackOptions::default()
    };
    let packed = pack(file, &options);
    let texels = Texels::new(Sampler::new(&packed), size, effort.lookups);
    let picture = LinearImage {
        size,
        texels: (0..size[1])
            .into_par_iter()
            .flat_map_iter(|y| texels.row(y))
            .collect(),
    };
    let read = LookedUp {
        word_bytes: packed.word_bytes(),
        fewer_halvings: HALVINGS - effort.halvings,
    };
    (picture, read)
}

/// The texels of the canvas and how they are sampled.
struct Texels<'a> {
    sampler: Sampler<'a>,
    size: [u32; 2],
    /// Side of a lookup's footprint in texels. Only images use it.
    footprint_texels: f32,
    /// Where in a texel lookups lie.
    places: Vec<[f32; 2]>,
}

impl<'a> Texels<'a> {
    fn new(sampler: Sampler<'a>, size: [u32; 2], (count, generator): (u16, u16)) -> Self {
        let place = |step: u16| (f32::from(step % count) + 0.5) / f32::from(count);
        let places = (0..count).map(|i| [place(i), place(generator * i)]);
        Self {
            sampler,
            size,
            // The distance between lookups.
            footprint_texels: f32::from(count).sqrt().recip(),
            places: places.collect(),
        }
    }

    fn row(&self, y: u32) -> impl Iterator<Item = [f32; 4]> {
        (0..self.size[0]).map(move |x| self.mean([x, y]))
    }

    /// Mean colour of a texel: linear light, premultiplied.
    fn mean(&self, texel: [u32; 2]) -> [f32; 4] {
        let uv = |t: [f32; 2]| [0, 1].map(|i| (texel[i] as f32 + t[i]) / self.size[i] as f32);
        // Most texels have one colour, which one look at the fine cell tells.
        if let Some(color) = self.sampler.uniform_color(uv([0.0; 2]), uv([1.0; 2])) {
            return color;
        }
        let [width, height] = self.size.map(|side| self.footprint_texels / side as f32);
        let mut sum = [0.0; 4];
        for &place in &self.places {
            let color = self.sampler.sample(uv(place), [width, 0.0, 0.0, height]);
            for (sum, channel) in sum.iter_mut().zip(color) {
                *sum += channel;
            }
        }
        sum.map(|sum| sum / self.places.len() as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BakeConfig, Resources, bake, testing::Random};

    #[test]
    fn the_canvas_image_has_powers_of_two() {
        let cases = [
            ([100.0, 100.0], 256, [256, 256]),
            ([3.0, 2.0], 256, [256, 128]),
            ([1.0, 1.4], 256, [256, 256]),
            ([1.0, 1.42], 256, [128, 256]),
            ([1.0, 1e6], 256, [1, 256]),
            ([7.0, 7.0], 300, [256, 256]),
            ([7.0, 7.0], 1, [1, 1]),
        ];
        for (canvas, longer_side, expected) in cases {
            assert_eq!(canvas_texels(canvas, longer_side), expected, "{canvas:?}");
        }
    }

    #[test]
    fn a_uniform_box_has_one_colour() {
        let svg = br##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">
            <path d="M10 20H90V45H10z" fill="#a03"/><circle cx="50" cy="60" r="31" fill="#28b"/>
            <path d="M5 95C40 5 60 99 95 9L70 90z" fill="#fd0" fill-opacity=".6"/></svg>"##;
        let file = bake(svg, &BakeConfig::default(), &Resources::default()).unwrap();
        let packed = pack(&file, &PackOptions::default());
        let sampler = Sampler::new(&packed);
        let mut random = Random(7);
        let mut uniform = 0;
        for _ in 0..20_000 {
            let mut at = |low: f64, high: f64| crate::number::to_f32(random.within(low, high));
            let low = [at(0.0, 0.97), at(0.0, 0.97)];
            let high = [low[0] + at(0.0, 0.03), low[1] + at(0.0, 0.03)];
            let Some(color) = sampler.uniform_color(low, high) else {
                continue;
            };
            uniform += 1;
            for _ in 0..32 {
                let uv = [0, 1].map(|i| at(low[i].into(), high[i].into()));
                assert_eq!(sampler.sample(uv, [0.0; 4]), color, "{uv:?}");
            }
        }
        // Edges are 5 canvas sides long, boxes 0.015 of one.
        assert!((14_000..19_500).contains(&uniform), "{uniform}");
    }
}
