//! How textures are looked up, as the command line has it.

use clap::{Args, ValueEnum};
use vtex_shaders::FootprintSamples;
use vtex_truth::texture::FilterMode;

/// How a texture is looked up.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct Lookup {
    /// How a lookup filters
    #[arg(long, value_enum, default_value_t)]
    pub(crate) filter: Filter,
    /// Places in a footprint of which `--filter footprint` takes the mean; other filters have no use
    /// for it. Against the mean over the area
    #[arg(long, value_enum, value_name = "N", default_value_t)]
    pub(crate) footprint_samples: Samples,
    /// Where lookups run
    #[arg(long, value_enum, default_value_t)]
    pub(crate) backend: Backend,
    /// Samples per pixel. With `--filter footprint` 1 is what engines show: each sample is filtered
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=65_536))]
    pub(crate) spp: u32,
}

/// How a lookup filters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Filter {
    /// The picture at the sample itself: only the samples of a pixel smooth its hard edges. Like the
    /// others it reads mips where a sample stands for more than about a texel of mip 0
    #[default]
    Point,
    /// The mean of the picture over a sample's footprint, from `--footprint-samples` places in it
    Footprint,
    /// The picture at the sample itself, with edges of MSDFs smoothed over the constant width of
    /// `bake --smoothing`; edges of curves and images stay hard
    Paper,
}

impl From<Filter> for FilterMode {
    fn from(filter: Filter) -> Self {
        match filter {
            Filter::Point => Self::Point,
            Filter::Footprint => Self::Footprint,
            Filter::Paper => Self::Paper,
        }
    }
}

/// How many places of a footprint count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Samples {
    /// 33 dB and more on ordinary drawings; thin lines become dotted
    #[value(name = "8")]
    Eight,
    /// 37 dB and more on ordinary drawings
    #[value(name = "16")]
    Sixteen,
    /// 41 dB and more on ordinary drawings
    #[default]
    #[value(name = "32")]
    ThirtyTwo,
}

impl Samples {
    /// The number itself.
    pub(crate) fn count(self) -> u32 {
        FootprintSamples::from(self) as u32
    }
}

impl From<Samples> for FootprintSamples {
    fn from(samples: Samples) -> Self {
        match samples {
            Samples::Eight => Self::Eight,
            Samples::Sixteen => Self::Sixteen,
            Samples::ThirtyTwo => Self::ThirtyTwo,
        }
    }
}

/// Where lookups run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Backend {
    /// On the CPU, without a GPU
    #[default]
    Cpu,
    /// On the best GPU adapter, or on the one that `VTEX_ADAPTER` names
    Gpu,
}
