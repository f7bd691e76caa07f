//! Zooming out: from cells over the cross-fade into the mips there is no step, and pictures that
//! are moved by part of a pixel do not shimmer.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use std::path::Path;
use std::sync::Arc;

use vtex_baker::{BakeConfig, Resources, bake};
use vtex_format::VtexFile;
use vtex_runtime::FilterMode;
use vtex_shaders::{PackOptions, Packed, cpu, pack};
use vtex_tests::random::Random;
use vtex_truth::picture::{Picture, View};
use vtex_truth::reference::{Edges, Reference};

/// Texels along mip 0.
const MIP0: u32 = 256;
/// Pixels of the truth along a side: eight a texel.
const TRUTH: u32 = 2048;
/// Footprints an octave.
const STEPS: u32 = 8;
/// Lookups a footprint.
const LOOKUPS: usize = 6000;

/// A drawing with its truth.
struct Subject {
    file: VtexFile,
    sums: Sums,
}

impl Subject {
    fn new(svg: &[u8]) -> Self {
        let config = BakeConfig {
            mip0_size: MIP0,
            ..BakeConfig::default()
        };
        let file = bake(svg, &config, &Resources::default()).unwrap();
        let reference = Reference::parse(svg, Arc::default(), Edges::Crisp).unwrap();
        let picture = reference.render_with(View::WHOLE, [TRUTH; 2], 2).unwrap();
        let sums = Sums::new(&picture);
        Self { file, sums }
    }

    fn packed(&self, filter: FilterMode) -> Packed {
        let options = PackOptions {
            filter,
            ..PackOptions::default()
        };
        pack(&self.file, &options)
    }

    /// Bias of the mean and rms of the error of lookups with a footprint of `texels`.
    fn errors(&self, sampler: &cpu::Sampler<'_>, texels: f32) -> [f64; 2] {
        let side = texels / MIP0 as f32;
        let mut random = Random::new(3);
        let (mut bias, mut squares) = ([0.0; 4], 0.0);
        for _ in 0..LOOKUPS {
            let uv = [(); 2].map(|()| random.between(0.5 * side, 1.0 - 0.5 * side));
            let seen = sampler.sample(uv, [side, 0.0, 0.0, side]);
            let truth = self.sums.mean(uv, side);
            for channel in 0..4 {
                let error = f64::from(seen[channel]) - truth[channel];
                bias[channel] += error / LOOKUPS as f64;
                squares += error * error / (4 * LOOKUPS) as f64;
            }
        }
        let worst = bias.iter().fold(0.0, |most, b| f64::max(most, b.abs()));
        [worst, squares.sqrt()]
    }
}

/// Sums over all pixels above and left of each (Crow 1984).
struct Sums {
    sums: Vec<[f64; 4]>,
}

impl Sums {
    const WIDTH: usize = TRUTH as usize + 1;

    fn new(picture: &Picture) -> Self {
        let mut sums = vec![[0.0; 4]; Self::WIDTH * Self::WIDTH];
        for y in 1..Self::WIDTH {
            let mut row = [0.0; 4];
            for x in 1..Self::WIDTH {
                let pixel = picture.pixels[(y - 1) * TRUTH as usize + x - 1];
                row = std::array::from_fn(|c| row[c] + f64::from(pixel[c]));
                let above = sums[(y - 1) * Self::WIDTH + x];
                sums[y * Self::WIDTH + x] = std::array::from_fn(|c| above[c] + row[c]);
            }
        }
        Self { sums }
    }

    /// Interpolated between pixels.
    fn at(&self, x: f64, y: f64) -> [f64; 4] {
        let [i, j] = [x, y].map(|c| c.floor().clamp(0.0, f64::from(TRUTH - 1)));
        let (s, t) = (x - i, y - j);
        #[expect(clippy::cast_possible_truncation, reason = "clamped")]
        #[expect(clippy::cast_sign_loss, reason = "clamped")]
        let first = j as usize * Self::WIDTH + i as usize;
        let corner = |offset: usize| self.sums[first + offset];
        let corners = [
            corner(0),
            corner(1),
            corner(Self::WIDTH),
            corner(Self::WIDTH + 1),
        ];
        let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t];
        std::array::from_fn(|c| (0..4).map(|k| weights[k] * corners[k][c]).sum())
    }

    /// Over the square of `side` about `uv`.
    fn mean(&self, uv: [f32; 2], side: f32) -> [f64; 4] {
        let ends =
            |c: f32| [c - 0.5 * side, c + 0.5 * side].map(|c| f64::from(c) * f64::from(TRUTH));
        let ([x0, x1], [y0, y1]) = (ends(uv[0]), ends(uv[1]));
        let area = (x1 - x0) * (y1 - y0);
        let [a, b, c, d] = [
            self.at(x1, y1),
            self.at(x0, y1),
            self.at(x1, y0),
            self.at(x0, y0),
        ];
        std::array::from_fn(|k| (a[k] - b[k] - c[k] + d[k]) / area)
    }
}

#[test]
fn zooming_out_shows_no_step() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/svg/paper/peacock.svg");
    let subject = Subject::new(&std::fs::read(path).unwrap());
    for filter in [FilterMode::Point, FilterMode::Footprint] {
        let packed = subject.packed(filter);
        let sampler = cpu::Sampler::new(&packed);
        // A quarter of a texel to 16.
        let footprints = (0..=6 * STEPS).map(|k| 2.0_f32.powf(k as f32 / STEPS as f32 - 2.0));
        let errors: Vec<(f32, [f64; 2])> = footprints
            .map(|texels| (texels, subject.errors(&sampler, texels)))
            .collect();
        for pair in errors.windows(2) {
            let step = (pair[1].1[1] - pair[0].1[1]).abs();
            assert!(
                step < 0.004,
                "{filter:?}: rms error steps by {step:.4} at {pair:?}"
            );
        }
        // What few lookups a texel and rounding to codes leave.
        let biased = errors.iter().find(|(_, [bias, _])| *bias > 0.003);
        assert_eq!(biased, None, "{filter:?}");
    }
}

/// Clear of the canvas' edge, so that the whole of it is always in the picture.
const ISLAND: &[u8] = br##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">
    <path d="M50 12L61 39 90 41 67 59 75 88 50 71 25 88 33 59 10 41 39 39z" fill="#d03020"/>
    <path d="M30 30C40 20 60 80 70 70" stroke="#fff" stroke-width=".8" fill="none"/>
    <circle cx="50" cy="52" r="9.3" fill="#104080"/></svg>"##;

#[test]
fn moving_by_part_of_a_pixel_keeps_the_mean() {
    let subject = Subject::new(ISLAND);
    let packed = subject.packed(FilterMode::Footprint);
    let sampler = cpu::Sampler::new(&packed);
    for texels in [0.4_f32, 0.75, 1.0, 1.7, 3.0, 6.5] {
        let side = texels / MIP0 as f32;
        let means: Vec<f64> = (0..8_u8)
            .map(|k| {
                let shift = [f32::from(k) / 8.0, (0.37 * f32::from(k)).fract()];
                mean(&sampler, side, shift)
            })
            .collect();
        let least = means.iter().copied().fold(f64::INFINITY, f64::min);
        let most = means.iter().copied().fold(0.0, f64::max);
        // Pictures of few pixels: what trilinear filtering of a coarse level ripples by. Measured: 1.1%
        // at 6.5 texels. Lookups of the level of the footprint's own width would ripple by 0.6% there
        // and by 1.9% at 13 texels, where these do by 1.3%.
        let bound = 0.0018 * f64::from(texels) * most;
        assert!(most - least < bound, "{texels}: {least} to {most}");
    }
}

/// Mean over the canvas of pixels with one lookup each, `side` wide and moved by `shift` pixels.
fn mean(sampler: &cpu::Sampler<'_>, side: f32, shift: [f32; 2]) -> f64 {
    let mut sum = 0.0;
    let mut v = (shift[1] - 1.0) * side;
    while v < 1.0 + side {
        let mut u = (shift[0] - 1.0) * side;
        while u < 1.0 + side {
            let [r, g, b, _] = sampler.sample([u, v], [side, 0.0, 0.0, side]);
            sum += f64::from(r + g + b) / 3.0;
            u += side;
        }
        v += side;
    }
    sum * f64::from(side * side)
}
