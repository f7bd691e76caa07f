//! Mip chains by exact area averages.

use std::sync::Arc;

use rayon::prelude::*;
use vtex_format::Image;

use crate::raster::texel;

/// An image in linear light, premultiplied by alpha.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LinearImage {
    /// Columns and rows, at least 1 each.
    pub(crate) size: [u32; 2],
    /// Row by row from the top.
    pub(crate) texels: Vec<[f32; 4]>,
}

impl LinearImage {
    /// The image averaged down to `size`, which must not be larger. Weights are exact for any ratio
    /// of sizes: odd sides lose no row, and the picture does not drift along the chain.
    pub(crate) fn reduced(&self, size: [u32; 2]) -> Self {
        let [columns, rows] = [0, 1].map(|axis| spans(self.size[axis], size[axis]));
        self.averaged(size, &columns, &rows)
    }

    /// Level `level` of an image of `full` texels, from this one, which is the level before it.
    fn next_level(&self, full: [u32; 2], level: u32) -> Self {
        let [columns, rows] = full.map(|side| halves(side, level));
        self.averaged(Image::level_size(full, level), &columns, &rows)
    }

    fn averaged(&self, size: [u32; 2], columns: &[Span], rows: &[Span]) -> Self {
        let width = self.size[0] as usize;
        let texels = rows
            .par_iter()
            .flat_map_iter(|row| {
                // First down the rows, then along the result: far fewer multiplications than texel
                // by texel.
                let column_sums = row_average(&self.texels, width, row);
                columns
                    .iter()
                    .map(move |column| average(&column_sums, column))
            })
            .collect();
        Self { size, texels }
    }

    /// The texels from left and top up to right and bottom.
    pub(crate) fn part(&self, [left, top, right, bottom]: [u32; 4]) -> Self {
        let rows = self.texels.chunks_exact(self.size[0] as usize);
        let rows = rows.skip(top as usize).take((bottom - top) as usize);
        Self {
            size: [right - left, bottom - top],
            texels: rows
                .flat_map(|row| &row[left as usize..right as usize])
                .copied()
                .collect(),
        }
    }

    /// Mirrors it along x and along y, as told.
    pub(crate) fn mirror(&mut self, [along_x, along_y]: [bool; 2]) {
        let width = self.size[0] as usize;
        if along_x {
            self.texels.chunks_exact_mut(width).for_each(<[_]>::reverse);
        }
        if along_y {
            // All texels backwards, each row then forwards again.
            self.texels.reverse();
            self.texels.chunks_exact_mut(width).for_each(<[_]>::reverse);
        }
    }
}

/// The finer texels that one coarse texel averages along an axis.
#[derive(Debug)]
struct Span {
    /// The first of them.
    first: usize,
    /// The weight of each; their sum is 1.
    weights: Vec<f32>,
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "weights are shares in [0, 1]"
)]
fn spans(fine: u32, coarse: u32) -> Vec<Span> {
    let (fine, coarse) = (u64::from(fine), u64::from(coarse));
    (0..coarse)
        .map(|i| {
            // In units of 1/coarse of a finer texel all borders are integers, so overlaps are
            // exact.
            let (start, end) = (i * fine, (i + 1) * fine);
            let (first, last) = (start / coarse, (end - 1) / coarse);
            let weights = (first..=last).map(|k| {
                let overlap = end.min((k + 1) * coarse) - start.max(k * coarse);
                (overlap as f64 / fine as f64) as f32
            });
            Span {
                first: usize::try_from(first).unwrap_or(usize::MAX),
                weights: weights.collect(),
            }
        })
        .collect()
}

/// The spans of a level of an image whose level 0 has `full` texels along an axis, in the level before
/// it. A texel at the end may stand for fewer texels of level 0 than the others, and then weighs less.
#[expect(
    clippy::cast_possible_truncation,
    reason = "weights are shares in [0, 1]"
)]
fn halves(full: u32, level: u32) -> Vec<Span> {
    let full = u64::from(full);
    let side = 1_u64 << (level - 1);
    let stands_for = |k: u64| side.min(full.saturating_sub(k * side)) as f64;
    (0..full.div_ceil(2 * side))
        .map(|i| {
            let [near, far] = [2 * i, 2 * i + 1].map(stands_for);
            let weights = [near, far].into_iter().filter(|&texels| texels > 0.0);
            Span {
                first: usize::try_from(2 * i).unwrap_or(usize::MAX),
                weights: weights
                    .map(|texels| (texels / (near + far)) as f32)
                    .collect(),
            }
        })
        .collect()
}

/// Weighted sum of whole rows of `width` texels.
fn row_average(texels: &[[f32; 4]], width: usize, row: &Span) -> Vec<[f32; 4]> {
    let mut sums = vec![[0.0; 4]; width];
    for (texels, &weight) in texels.chunks_exact(width).skip(row.first).zip(&row.weights) {
        for (sum, texel) in sums.iter_mut().zip(texels) {
            add(sum, texel, weight);
        }
    }
    sums
}

/// Weighted sum of the texels of one row.
fn average(texels: &[[f32; 4]], span: &Span) -> [f32; 4] {
    let mut sum = [0.0; 4];
    for (texel, &weight) in texels[span.first..].iter().zip(&span.weights) {
        add(&mut sum, texel, weight);
    }
    sum
}

fn add(sum: &mut [f32; 4], texel: &[f32; 4], weight: f32) {
    for (s, t) in sum.iter_mut().zip(texel) {
        *s += weight * t;
    }
}

/// An image for the file with `levels` levels, or fewer where one texel is left before. Each is made
/// from the level above it before that is rounded to bytes, so errors do not add up.
pub(crate) fn chain(level0: LinearImage, rect_uv: [f32; 4], levels: u32) -> Image {
    let size = level0.size;
    let mut mips = vec![stored(&level0)];
    let mut level = level0;
    for k in 1..levels.min(Image::level_count(size)) {
        level = level.next_level(size, k);
        mips.push(stored(&level));
    }
    Image {
        rect_uv,
        size,
        mips: Arc::new(mips),
    }
}

fn stored(level: &LinearImage) -> Vec<u8> {
    level
        .texels
        .par_iter()
        .flat_map_iter(|&texel| texel::stored_from_linear(texel))
        .collect()
}

#[cfg(test)]
mod tests {
    use vtex_format::MAX_MIPS;

    use super::*;

    fn image(size: [u32; 2], texel: impl Fn(u32, u32) -> [f32; 4]) -> LinearImage {
        let texels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        LinearImage {
            size,
            texels: texels.map(|(x, y)| texel(x, y)).collect(),
        }
    }

    #[test]
    fn a_constant_stays_constant_at_any_size() {
        let texel = [0.1, 0.2, 0.05, 0.5];
        for size in [[1, 1], [7, 5], [13, 1], [640, 3]] {
            let chain = chain(image(size, |_, _| texel), [0.0, 0.0, 1.0, 1.0], MAX_MIPS);
            assert_eq!(chain.mips.len(), Image::level_count(size) as usize);
            for (k, level) in (0..).zip(chain.mips.iter()) {
                let [w, h] = Image::level_size(size, k);
                assert_eq!(level.len(), 4 * w as usize * h as usize);
                let expected = texel::stored_from_linear(texel);
                assert!(
                    level.chunks_exact(4).all(|t| t == expected),
                    "{size:?} level {k}"
                );
            }
        }
    }

    #[test]
    fn odd_sides_keep_the_mean() {
        let ramp = image([7, 5], |x, y| [(x * y) as f32 / 24.0, 0.0, 0.0, 1.0]);
        let mean = ramp.texels.iter().map(|t| t[0]).sum::<f32>() / 35.0;
        let half = ramp.reduced([3, 2]);
        let last = half.reduced([1, 1]);
        assert!((last.texels[0][0] - mean).abs() < 1e-6);
    }

    #[test]
    fn a_texel_of_a_level_is_the_mean_of_those_that_it_covers() {
        let texel = |x: u32, y: u32| [((7 * x + 3 * y) % 11) as f32 / 11.0, 0.0, 0.0, 1.0];
        for size in [[13, 9], [8, 4], [5, 1], [1, 6]] {
            let mut level = image(size, texel);
            for k in 1..Image::level_count(size) {
                level = level.next_level(size, k);
                let [width, height] = Image::level_size(size, k);
                assert_eq!(
                    level.texels.len(),
                    (width * height) as usize,
                    "{size:?} {k}"
                );
                for (i, found) in (0..).zip(&level.texels) {
                    let range =
                        |place: u32, axis: usize| (place << k)..((place + 1) << k).min(size[axis]);
                    let covered: Vec<f32> = range(i / width, 1)
                        .flat_map(|y| range(i % width, 0).map(move |x| texel(x, y)[0]))
                        .collect();
                    let mean = covered.iter().sum::<f32>() / covered.len() as f32;
                    assert!((found[0] - mean).abs() < 1e-5, "{size:?} {k} {i}");
                }
            }
        }
    }

    #[test]
    fn an_edge_to_transparent_keeps_its_colour() {
        // Half-transparent red beside opaque green beside nothing: no darker hue may appear.
        let red = crate::drawing::color::decode(0.9);
        let level0 = image([4, 4], |x, _| match x {
            0 | 1 => [0.5 * red, 0.0, 0.0, 0.5],
            2 => [0.0, 1.0, 0.0, 1.0],
            _ => [0.0; 4],
        });
        let [r, g, b, a] = level0.reduced([1, 1]).texels[0];
        assert!((a - 0.5).abs() < 1e-6, "{a}");
        // Un-premultiplied: half the covered area is red, half green.
        assert!((r / a - 0.5 * red).abs() < 1e-6 && (g / a - 0.5).abs() < 1e-6 && b == 0.0);
        let right = level0.reduced([2, 2]).texels[1];
        assert_eq!(right, [0.0, 0.5, 0.0, 0.5], "green fades without darkening");
    }
}
