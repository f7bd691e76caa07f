//! How the light of a traced picture becomes colours, as the command line has it.

#![expect(clippy::doc_markdown, reason = "AgX is a name")]

use clap::{Args, ValueEnum};
use vtex_runtime::ToneMap;

use super::values::stops;

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
