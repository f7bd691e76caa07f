//! Taking a picture of a texture: stratified samples in each pixel, averaged in linear light.

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
}

impl Shot {
    /// All lookups of pixel `(x, y)`.
    ///
    /// Divide a pixel into `n` columns or into `n` rows: each holds one of its `n` samples. If `n` is
    /// a power of two, that also holds for all grids of `n` boxes between the two. The samples are
    /// a Hammersley set, shifted and scrambled by a hash of the pixel, so that pixels differ and the
    /// same picture has the same samples every time.
    ///
    /// The footprint of a sample is that of the pixel with its axes divided by `sqrt(n)`, so that
    /// the footprints of all samples have the area of the pixel.
    pub fn queries(self, x: u32, y: u32) -> impl Iterator<Item = BatchQuery> {
        let extent = self.view.extent();
        let axis = |a: usize| extent[a] / f64::from(self.size_px[a]) / f64::from(self.spp).sqrt();
        let footprint = [narrow(axis(0)), 0.0, 0.0, narrow(axis(1))];
        let key = hash(u64::from(y) << 32 | u64::from(x));
        (0..self.spp).map(move |sample| {
            let [dx, dy] = self.offset(sample, key);
            let point = [f64::from(x) + dx, f64::from(y) + dy];
            let uv = self.view.uv_from_px(point, self.size_px).map(narrow);
            BatchQuery {
                uv,
                padding: [0.0; 2],
                footprint,
            }
        })
    }

    /// Where in the pixel sample `sample` lies, in \[0, 1)^2.
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
    fn batches_and_single_lookups_agree() {
        let shot = Shot {
            view: View::WHOLE,
            size_px: [5, 3],
            spp: 3,
        };
        let lookup = |uv: [f32; 2]| [uv[0], uv[1], uv[0] * uv[1], 1.0];
        let single = shot.shoot(|uv, _| lookup(uv));
        let batches = shot
            .shoot_batches(|q| Ok::<_, ()>(q.iter().map(|q| lookup(q.uv)).collect()))
            .unwrap();
        assert_eq!(single, batches);
    }
}
