//! The evaluator's Rust twin: the functions of `wgsl/vtex`, file by file, in the same order of
//! `f32` operations. It is the oracle of the parity tests, the baker's judge of its own output
//! and the back-end of previews on a machine without a GPU.
//!
//! Where the WGSL is specialised by choosing modules, the twin asks the header.

mod backdrop;
mod blend;
mod brush;
mod cell;
pub mod color;
mod cost;
mod edge;
mod gradient;
mod groups;
mod image;
mod lookup;
mod mapping;
mod math;
mod minify;
mod msdf;
mod paint;
mod paper;
mod picture;
pub(crate) mod plane;
mod region;
mod rows;
mod sample;
mod samples;
mod segment;
mod settings;
mod uniform_color;
mod walk;
mod words;

pub use cost::LookupCost;
use lookup::Lookup;
pub(crate) use math::{to_f32, to_u32};
use settings::Settings;

use crate::packed::Packed;
use crate::texels::TexelPages;

/// A packed texture ready to be looked up. Cheap to make and to copy; lookups allocate nothing.
///
/// Words past the buffer's end read as zero, as on a GPU with robust buffer access, so a buffer
/// that [`crate::pack`] did not make gives a wrong picture and never a panic.
#[derive(Clone, Copy, Debug)]
pub struct Sampler<'a> {
    words: &'a [u32],
    texels: &'a TexelPages,
    /// Linear light of the codes of a texel's channel.
    decode: &'static [f32; 256],
    settings: Settings,
}

impl<'a> Sampler<'a> {
    /// Reads the header of a texture.
    pub fn new(packed: &'a Packed) -> Self {
        Self::of(&packed.words, &packed.texels)
    }

    /// As [`Sampler::new`]; `words` are those of one texture, and may begin anywhere in those of a
    /// [`PackedSet`](crate::PackedSet).
    pub fn of(words: &'a [u32], texels: &'a TexelPages) -> Self {
        Self {
            words,
            texels,
            decode: &color::DECODED,
            settings: Settings::read(words),
        }
    }

    /// The twin of `vtex_sample`: the texture at `uv`, filtered over `footprint` (`axis0.u,
    /// axis0.v, axis1.u, axis1.v`, full extents in uv; zeros for a point).
    ///
    /// Linear light, premultiplied alpha; a mask has its alpha in all four channels.
    pub fn sample(&self, uv: [f32; 2], footprint: [f32; 4]) -> [f32; 4] {
        sample::sample(self, uv, footprint)
    }

    /// Where a lookup in footprint mode samples, in uv after texture matrix and address mode: in the
    /// cells it is the mean of point lookups there. What lies beyond the canvas is left out.
    ///
    /// For tests and reports: lookups do not make this list.
    pub fn places(&self, uv: [f32; 2], footprint: [f32; 4]) -> Vec<[f32; 2]> {
        picture::places(self, &sample::lookup(self, uv, footprint))
    }
}

/// Whether the entry whose commands `words` start with fills at `p`, in units of its cell's box.
#[cfg(test)]
pub(crate) fn commands_fill(words: &[u32], p: [f32; 2]) -> bool {
    let texels = TexelPages::default();
    let sampler = Sampler::of(words, &texels);
    let point = samples::Point {
        uv: [0.0; 2],
        q: [0.0; 2],
        p,
    };
    let mut edge = edge::Edge::new();
    let commands = words.as_chunks::<4>().0;
    let last = commands
        .iter()
        .position(|command| command[3] & crate::layout::cmd::END_BIT != 0);
    let last = last.unwrap_or(commands.len() - 1);
    for &command in &commands[..=last] {
        edge.wind(&point, command);
    }
    edge.covered(&sampler, &point, commands[last], 1) != 0
}
