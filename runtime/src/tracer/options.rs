//! How a picture is traced.

use crate::{RuntimeError, Trust};

/// Settings of a [`Tracer`](crate::Tracer).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraceOptions {
    /// Scatterings of a path, 0 to 64. 0 shows only what glows.
    pub max_bounces: u32,
    /// Seed of all random numbers.
    pub seed: u32,
    /// Scale of ray-cone footprints, in (0, 1]: `1 / sqrt(N)` where a pixel gets N samples in the
    /// end, so that each has 1/N of the pixel's footprint; see [`TraceOptions::for_samples`]. It is
    /// the same for all samples, however many there are so far: a picture must not depend on how
    /// they were spread over calls. With more samples than planned a picture stays softer, with
    /// fewer it has more noise, and nothing else changes.
    pub footprint_scale: f32,
    /// Largest radiance a sample may add by light that scattered twice or more. Lower means fewer
    /// bright dots and a darker picture; infinity switches the bias off.
    pub indirect_clamp: f32,
    /// How area lights are found.
    pub light_sampling: LightSampling,
    /// What camera rays that meet nothing leave on the film.
    pub background: Background,
    /// How the work is divided into kernels.
    pub integrator: Integrator,
    /// Whose kernels look textures up in [`Integrator::Staged`]; [`Integrator::Single`] has one of its own.
    /// A file's kernel reads that file alone, so at most eight textures are looked up by theirs, and further
    /// ones by text, as [`Tracer::notices`](crate::Tracer::notices) say.
    pub trust: Trust,
}

/// How the work is divided into kernels. The picture is the same but for rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// The faster one: [`Integrator::Staged`], also on the software driver on which both were measured.
    #[default]
    Auto,
    /// A kernel for each stage of a path, with queues between them; textures of one kernel key share a
    /// kernel, which answers a queue of lookups. A texture's features cost others nothing.
    Staged,
    /// One kernel for whole paths, with the code of all features that any texture has.
    Single,
}

impl Integrator {
    /// What [`Integrator::Auto`] means.
    pub(super) fn chosen(self) -> Self {
        match self {
            Self::Auto | Self::Staged => Self::Staged,
            Self::Single => Self::Single,
        }
    }
}

/// How area lights are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum LightSampling {
    /// By aiming at them and by scattering, weighted: little noise.
    #[default]
    Mis = 0,
    /// By scattering alone: the same picture with more noise, a check of the other.
    ScatterOnly = 1,
}

/// What camera rays that meet nothing leave on the film.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum Background {
    /// The sky.
    #[default]
    Sky = 0,
    /// Transparent black; the sky lights the scene all the same.
    Transparent = 1,
}

/// Past this many scatterings nothing is left to see.
const MAX_BOUNCES: u32 = 64;

impl Default for TraceOptions {
    fn default() -> Self {
        Self {
            max_bounces: 8,
            seed: 0,
            // 16 samples.
            footprint_scale: 0.25,
            indirect_clamp: 16.0,
            light_sampling: LightSampling::Mis,
            background: Background::Sky,
            integrator: Integrator::Auto,
            trust: Trust::Regenerate,
        }
    }
}

impl TraceOptions {
    /// The defaults with the footprint scale for `samples` a pixel, `1 / sqrt(samples)`.
    #[must_use]
    pub fn for_samples(samples: u32) -> Self {
        Self {
            footprint_scale: 1.0 / (samples.max(1) as f32).sqrt(),
            ..Self::default()
        }
    }

    pub(crate) fn check(&self) -> Result<(), RuntimeError> {
        let scale = self.footprint_scale;
        // Each comparison is false for NaN, which is refused so.
        if self.max_bounces <= MAX_BOUNCES
            && scale > 0.0
            && scale <= 1.0
            && self.indirect_clamp > 0.0
        {
            Ok(())
        } else {
            Err(RuntimeError::Parameter(format!(
                "trace options out of range: {self:?}"
            )))
        }
    }
}
