//! How far the GPU may be from the twin: set to what is measured on lavapipe and on a card (NVIDIA
//! H200), with what was met.

use std::fmt;
use std::io::Write as _;

use rayon::prelude::*;
use vtex_format::Features;
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{BatchQuery, TexelPages};

use crate::random::Random;

/// Roundings of a channel, linear light: 2.3e-5 was met on lavapipe, where gradients are blended and in
/// paper mode, and 2.2e-5 on the card. That is a tenth of a code of black.
const ROUNDING: f32 = 5e-5;
/// Roundings of a place, in uv: a difference no larger than what the twin itself answers there is one.
/// Steep gradients, texels and edges make differences of any size of them.
const PLACE_ROUNDINGS: [f32; 3] = [1.2e-7, 4.8e-7, 1.9e-6];
/// A lookup that reads texels may differ by this much more: a card's weights have 8 bits, so along each of
/// two axes they are off by up to 1 / 256 of the difference of two texels. 1.7e-3 was met on lavapipe and
/// 5.3e-3 on the card.
const TEXELS: f32 = 2.0 / 256.0;
/// Share of lookups of a point that may fall on the other side of an edge: of 240,000 one did.
const POINT_STRAYS: f64 = 2e-5;
/// Share of lookups of a footprint of which samples may: of 2,000,000 nine did.
const FOOTPRINT_STRAYS: f64 = 1e-4;
/// How many of a footprint's samples may; the difference of one is at most its share of the mean.
const STRAY_SAMPLES: f32 = 2.0;

/// A packed texture, or several in one buffer, looked up on the GPU with a key of these features.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// What the twin reads: the words of one texture.
    pub words: &'a [u32],
    /// The pages that these words name.
    pub texels: &'a TexelPages,
    /// Bits of [`Features`] of the texture's own key, which say how it is filtered.
    pub features: u32,
}

impl Subject<'_> {
    /// What the twin answers.
    pub fn twin(&self, queries: &[BatchQuery]) -> Vec<[f32; 4]> {
        let sampler = Sampler::of(self.words, self.texels);
        let look = |query: &BatchQuery| sampler.sample(query.uv, query.footprint);
        queries.par_iter().map(look).collect()
    }

    /// What the GPU answers beside what the twin does.
    ///
    /// # Panics
    /// When not every query has one answer of each.
    pub fn compare(&self, queries: &[BatchQuery], twin: &[[f32; 4]], gpu: &[[f32; 4]]) -> Parity {
        let count = queries.len();
        assert_eq!([twin.len(), gpu.len()], [count; 2], "one colour a query");
        let footprints = self.features & Features::FOOTPRINT != 0;
        let share = if footprints {
            FOOTPRINT_STRAYS
        } else {
            POINT_STRAYS
        };
        // Samples share a gradient's or an image's colour, so all of them may stray together.
        let shared = self.features & (Features::GRADIENTS | Features::IMAGES) != 0;
        let mut parity = Parity {
            lookups: count,
            allowed: share * count as f64,
            ..Parity::default()
        };
        let sampler = Sampler::of(self.words, self.texels);
        // Empty texels: what they make no difference to reads none.
        let empty = TexelPages::default();
        let without = Sampler::of(self.words, &empty);
        for (query, (twin, gpu)) in queries.iter().zip(twin.iter().zip(gpu)) {
            let difference = difference(twin, gpu);
            if difference <= ROUNDING {
                parity.rounding = parity.rounding.max(difference);
                continue;
            }
            let texels = without.sample(query.uv, query.footprint) != *twin;
            if texels && difference <= ROUNDING + TEXELS {
                parity.texels = parity.texels.max(difference);
                continue;
            }
            let filtered = if texels { TEXELS } else { 0.0 };
            if difference <= ROUNDING + filtered + moved(&sampler, query, twin) {
                parity.moved += 1;
                continue;
            }
            let samples = if footprints {
                sampler.places(query.uv, query.footprint).len()
            } else {
                1
            };
            parity.strays += 1;
            let strayed = difference * samples as f32;
            parity.samples = parity.samples.max(strayed);
            let known = strayed <= STRAY_SAMPLES || shared && strayed.is_finite();
            parity.wrong += usize::from(!known);
        }
        parity
    }
}

/// The largest difference from `own`, the twin's answer, of what it answers a rounding away.
fn moved(sampler: &Sampler<'_>, query: &BatchQuery, own: &[f32; 4]) -> f32 {
    let mut largest = 0.0_f32;
    for step in PLACE_ROUNDINGS {
        for (u, v) in (-1_i8..=1).flat_map(|u| (-1_i8..=1).map(move |v| (u, v))) {
            let uv = [
                query.uv[0] + step * f32::from(u),
                query.uv[1] + step * f32::from(v),
            ];
            let by = difference(own, &sampler.sample(uv, query.footprint));
            // No number there says nothing about this place.
            largest = largest.max(if by.is_finite() { by } else { 0.0 });
        }
    }
    largest
}

/// The largest difference of a channel; infinite if one of them is no number.
fn difference(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, |most, difference| {
        let known = if difference.is_nan() {
            f32::INFINITY
        } else {
            difference
        };
        most.max(known)
    })
}

/// What a comparison of two evaluators came to.
#[derive(Clone, Copy, Debug, Default)]
pub struct Parity {
    /// Lookups that were compared.
    pub lookups: usize,
    /// The largest difference of a channel by rounding alone.
    pub rounding: f32,
    /// The largest difference of a channel where texels are read, by the sampler and by rounding.
    pub texels: f32,
    /// Lookups that differ by no more than the twin does from itself where the place is rounded.
    pub moved: usize,
    /// Lookups that differ by more: some place that they read lies on another side of an edge.
    pub strays: usize,
    /// The largest difference of those, as a share of one sample; a point is one sample.
    pub samples: f32,
    /// Strays of more samples than there may be.
    wrong: usize,
    /// How many strays are to be expected at most.
    allowed: f64,
}

impl Parity {
    /// # Errors
    /// What differs more than it may.
    pub fn check(&self) -> Result<(), String> {
        // Four standard deviations of a count, and a few where next to none is expected.
        let most = self.allowed + 4.0 * self.allowed.sqrt() + 2.0;
        if self.wrong > 0 || self.strays as f64 > most {
            return Err(self.to_string());
        }
        Ok(())
    }

    /// This comparison and another one.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            lookups: self.lookups + other.lookups,
            rounding: self.rounding.max(other.rounding),
            texels: self.texels.max(other.texels),
            moved: self.moved + other.moved,
            strays: self.strays + other.strays,
            samples: self.samples.max(other.samples),
            wrong: self.wrong + other.wrong,
            allowed: self.allowed + other.allowed,
        }
    }
}

impl fmt::Display for Parity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            lookups,
            rounding,
            texels,
            moved,
            strays,
            samples,
            ..
        } = self;
        write!(
            f,
            "{rounding:.1e} by rounding, {texels:.1e} with texels; of {lookups} lookups {moved}"
        )?;
        write!(f, " as at places rounded otherwise, {strays} otherwise")?;
        write!(f, ", by up to {samples:.1e} samples")
    }
}

const FILTERS: [&str; 3] = ["point", "footprint", "paper"];

/// Comparisons in point, footprint and paper mode.
#[derive(Clone, Copy, Debug, Default)]
pub struct Parities([Parity; 3]);

impl Parities {
    /// Adds one with a key of these features.
    pub fn add(&mut self, features: u32, parity: Parity) {
        let place = match features & (Features::FOOTPRINT | Features::PAPER) {
            0 => 0,
            Features::FOOTPRINT => 1,
            _ => 2,
        };
        self.0[place] = self.0[place].and(parity);
    }

    /// These comparisons and others.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].and(other.0[i])))
    }

    /// # Errors
    /// The filter mode, and what differs more than it may.
    pub fn check(&self) -> Result<(), String> {
        for (filter, parity) in FILTERS.iter().zip(self.0) {
            parity.check().map_err(|why| format!("{filter}: {why}"))?;
        }
        Ok(())
    }

    /// Tells stderr, which the test harness does not hold back, the largest differences met.
    ///
    /// # Panics
    /// When one differs more than it may.
    pub fn report(&self, what: &str) {
        // A report that nobody can read is no failure.
        let _ = write!(std::io::stderr(), "GPU and twin, {what}:\n{self}");
        assert_eq!(self.check(), Ok(()), "{what}");
    }
}

/// A line for each filter mode of which there were lookups.
impl fmt::Display for Parities {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (filter, parity) in FILTERS.iter().zip(self.0) {
            if parity.lookups > 0 {
                writeln!(f, "  {filter}: {parity}")?;
            }
        }
        Ok(())
    }
}

/// Points up to `margin` outside the canvas; footprints from none to the whole of it.
pub fn random_queries(seed: u64, count: u32, margin: f32) -> Vec<BatchQuery> {
    let mut r = Random::new(seed);
    let query = |_| {
        let width = if r.below(4) == 0 {
            0.0
        } else {
            r.between(-12.0, 0.0).exp2()
        };
        BatchQuery {
            uv: [(); 2].map(|()| r.between(-margin, 1.0 + margin)),
            padding: [0.0; 2],
            footprint: [(); 4].map(|()| width * r.between(-1.0, 1.0)),
        }
    };
    (0..count).map(query).collect()
}
