//! Taking a picture of a texture: samples in each pixel, averaged in linear light.

use rayon::prelude::*;
use vtex_shaders::layout::BatchQuery;

use super::{Picture, View};

/// Which picture to take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// The part of the canvas that is shown.
    pub view: View,
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// Samples per pixel. A single one lies at the centre of the pixel.
    pub spp: u32,
    /// Samples are regions if each has at least this width and height in uv, otherwise points.
    /// `crate::texture::region_uv` says from what size on a texture averages.
    pub region_uv: [f64; 2],
}

/// [`Shot::region_uv`] where all samples are points.
pub const POINTS: [f64; 2] = [f64::INFINITY; 2];

impl Shot {
    /// All lookups of pixel `(x, y)`. Each of `n` samples has a footprint of `1/n` of the pixel.
    ///
    /// *Regions* divide the pixel into columns and rows, as square as `n` allows. So their mean is
    /// that over the pixel, neither wider nor noisy.
    ///
    /// *Points* stand for themselves. Divide a pixel into `n` columns or into `n` rows: each holds
    /// one of them. If `n` is a power of two, that also holds for all grids of `n` boxes between the
    /// two. They are a Hammersley set, shifted and scrambled by a hash of the pixel, so that pixels
    /// differ and the same picture has the same samples every time.
    pub fn queries(self, x: u32, y: u32) -> impl Iterator<Item = BatchQuery> {
        let extent = self.view.extent();
        let pixel_uv = [0, 1].map(|a| extent[a] / f64::from(self.size_px[a]));
        let grid = grid(self.spp);
        let regions = (0..2).all(|a| pixel_uv[a] / grid[a] >= self.region_uv[a]);
        let parts = if regions {
            grid
        } else {
            [f64::from(self.spp).sqrt(); 2]
        };
        let [width, height] = [0, 1].map(|a| narrow(pixel_uv[a] / parts[a]));
        let key = hash(u64::from(y) << 32 | u64::from(x));
        (0..self.spp).map(move |sample| {
            let [dx, dy] = if regions {
                let row = (f64::from(sample) / grid[0]).floor();
                let column = f64::from(sample) - row * grid[0];
                [(column + 0.5) / grid[0], (row + 0.5) / grid[1]]
            } else {
                self.offset(sample, key)
            };
            let point = [f64::from(x) + dx, f64::from(y) + dy];
            let uv = self.view.uv_from_px(point, self.size_px).map(narrow);
            BatchQuery {
                uv,
                padding: [0.0; 2],
                footprint: [width, 0.0, 0.0, height],
            }
        })
    }

    /// Where in the pixel point `sample` lies, in \[0, 1)^2.
    fn offset(self, sample: u32, key: u64) -> [f64; 2] {
        if self.spp == 1 {
            return [0.5; 2];
        }
        let [shift, scramble] = halves(key);
        let across = (f64::from(sample) + unit(shift)) / f64::from(self.spp);
        // The low bits of the scramble place the sample inside its stratum.
        [across, unit(sample.reverse_bits() ^ scramble)]
    }

    /// Takes the picture with `lookup(uv, footprint)`, which returns linear light, premultiplied.
    pub fn shoot(self, lookup: impl Fn([f32; 2], [f32; 4]) -> [f32; 4] + Sync) -> Picture {
        let rows = (0..self.size_px[1]).into_par_iter().map(|y| {
            let pixel = |x| {
                let colors = self
                    .queries(x, y)
                    .map(|query| lookup(query.uv, query.footprint));
                mean(colors, self.spp)
            };
            (0..self.size_px[0]).map(pixel).collect::<Vec<_>>()
        });
        Picture {
            size_px: self.size_px,
            pixels: rows.flatten_iter().collect(),
        }
    }

    /// Takes the picture with batches of lookups, for a GPU.
    ///
    /// # Errors
    /// Those of `lookup`.
    pub fn shoot_batches<E>(
        self,
        mut lookup: impl FnMut(&[BatchQuery]) -> Result<Vec<[f32; 4]>, E>,
    ) -> Result<Picture, E> {
        /// Most queries in a batch: 32 MiB, a quarter of what a binding may hold.
        const BATCH_QUERIES: u32 = 1 << 20;
        let row_queries = self.size_px[0].saturating_mul(self.spp).max(1);
        let rows_at_once = (BATCH_QUERIES / row_queries).max(1);
        let mut pixels = Vec::new();
        let mut first = 0;
        while first < self.size_px[1] {
            let end = (first + rows_at_once).min(self.size_px[1]);
            let queries: Vec<BatchQuery> = (first..end)
                .flat_map(|y| (0..self.size_px[0]).flat_map(move |x| self.queries(x, y)))
                .collect();
            let colors = lookup(&queries)?;
            let samples = self.spp as usize;
            pixels.extend(
                colors
                    .chunks_exact(samples)
                    .map(|c| mean(c.iter().copied(), self.spp)),
            );
            first = end;
        }
        Ok(Picture {
            size_px: self.size_px,
            pixels,
        })
    }
}

/// Columns and rows that hold `count` parts, as near to each other as its divisors are.
fn grid(count: u32) -> [f64; 2] {
    let rows = (1..=count.isqrt())
        .rev()
        .find(|&rows| count.is_multiple_of(rows));
    let rows = rows.unwrap_or(1);
    [count / rows, rows].map(f64::from)
}

fn mean(colors: impl Iterator<Item = [f32; 4]>, count: u32) -> [f32; 4] {
    let sum = colors.fold([0.0_f32; 4], |sum, color| {
        std::array::from_fn(|c| sum[c] + color[c])
    });
    sum.map(|channel| channel / count as f32)
}

/// A hash of 64 bits: the finaliser of `SplitMix64` (Steele, Lea, Flood 2014).
pub fn hash(key: u64) -> u64 {
    let mut z = key.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[expect(clippy::cast_possible_truncation, reason = "the two halves are wanted")]
fn halves(key: u64) -> [u32; 2] {
    [(key >> 32) as u32, key as u32]
}

/// 32 random bits as a number in \[0, 1).
fn unit(bits: u32) -> f64 {
    f64::from(bits) / (f64::from(u32::MAX) + 1.0)
}

#[expect(clippy::cast_possible_truncation, reason = "lookups take f32")]
fn narrow(value: f64) -> f32 {
    value as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_stratified_both_ways() {
        let shot = Shot {
            view: View::WHOLE,
            size_px: [8, 8],
            spp: 16,
            region_uv: POINTS,
        };
        for (x, y) in [(0, 0), (3, 5), (7, 7)] {
            let mut boxes = [0; 16];
            for query in shot.queries(x, y) {
                let inside = [0, 1].map(|a| query.uv[a] * 8.0 - [x, y][a] as f32);
                assert!(inside.iter().all(|c| (0.0..1.0).contains(c)), "{inside:?}");
                let [column, row] = inside.map(|c| {
                    (0_u8..3)
                        .take_while(|&k| c * 4.0 >= f32::from(k + 1))
                        .count()
                });
                boxes[row * 4 + column] += 1;
            }
            assert_eq!(boxes, [1; 16]);
        }
    }

    #[test]
    fn regions_tile_the_pixel() {
        for (spp, [columns, rows]) in [(1, [1, 1]), (3, [3, 1]), (8, [4, 2]), (16, [4, 4])] {
            let shot = Shot {
                view: View::WHOLE,
                size_px: [8, 8],
                spp,
                region_uv: [0.125 / f64::from(columns), 0.125 / f64::from(rows)],
            };
            let size = [columns, rows].map(|parts| 0.125 / parts as f32);
            for (sample, query) in (0..).zip(shot.queries(5, 2)) {
                let place: [u32; 2] = [sample % columns, sample / columns];
                let uv = [0, 1].map(|a| [5, 2][a] as f32 / 8.0 + (place[a] as f32 + 0.5) * size[a]);
                let apart = (0..2).all(|a| (query.uv[a] - uv[a]).abs() < 1e-6);
                assert!(apart, "{spp}: {query:?}, not {uv:?}");
                assert_eq!(query.footprint, [size[0], 0.0, 0.0, size[1]]);
            }
        }
    }

    #[test]
    fn batches_and_single_lookups_agree() {
        let shot = Shot {
            view: View::WHOLE,
            size_px: [5, 3],
            spp: 3,
            region_uv: POINTS,
        };
        let lookup = |uv: [f32; 2]| [uv[0], uv[1], uv[0] * uv[1], 1.0];
        let single = shot.shoot(|uv, _| lookup(uv));
        let batches = shot
            .shoot_batches(|q| Ok::<_, ()>(q.iter().map(|q| lookup(q.uv)).collect()))
            .unwrap();
        assert_eq!(single, batches);
    }
}
