//! How the light of a traced picture becomes colours, as the command line has it.

#![expect(clippy::doc_markdown, reason = "AgX is a name")]

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use vtex_runtime::ToneMap;

use super::values::{degrees, level, stops};

/// How the light of a traced picture becomes the colours of a PNG.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct Light {
    /// How light becomes the colours of a .png [default: none for a drawing on a plane, whose colours
    /// are to stay what they are; agx for glTF scenes and the showroom, whose light may be brighter
    /// than white paper]
    #[arg(long, value_enum)]
    pub(crate) tone: Option<Tone>,
    /// Stops by which a .png is brighter than its scene: 1 doubles the light, -1 halves it
    /// [default: 0]
    #[arg(long, value_name = "STOPS", value_parser = stops, allow_negative_numbers = true)]
    pub(crate) exposure: Option<f32>,
}

/// Light from everywhere else.
#[derive(Clone, Debug, Args)]
pub(crate) struct Surroundings {
    /// Panorama that lights the scene and is seen behind it: equirectangular, .hdr or .exr
    #[arg(long, value_name = "HDR|EXR")]
    pub(crate) environment: Option<PathBuf>,
    /// Turn the panorama, whose middle lies towards -z, clockwise as seen from above [default: 0]
    #[arg(long, value_name = "DEGREES", value_parser = degrees, requires = "environment", allow_negative_numbers = true)]
    pub(crate) environment_turn: Option<f32>,
    /// Radiance of a plain white sky instead of the scene's own; 0 for none [default: for glTF 1, or 0
    /// where the asset has lights of its own]
    #[arg(long, value_name = "RADIANCE", value_parser = level, conflicts_with = "environment", allow_negative_numbers = true)]
    pub(crate) sky: Option<f32>,
}

/// How light becomes colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Tone {
    /// AgX: bright light keeps its shades, strong colours fade towards white as it grows; white paper
    /// in white light is light grey
    Agx,
    /// ACES, in the fit of Stephen Hill: more contrast, and darker
    Aces,
    /// Plain sRGB: colours stay what they are, and light above white is cut off
    None,
}

impl From<Tone> for ToneMap {
    fn from(tone: Tone) -> Self {
        match tone {
            Tone::Agx => Self::AgX,
            Tone::Aces => Self::Aces,
            Tone::None => Self::Clip,
        }
    }
}
