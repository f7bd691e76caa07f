//! The evaluator's Rust twin: the functions of `wgsl/vtex`, file by file, in the same order of
//! `f32` operations. It is the oracle of the parity tests, the baker's judge of its own output
//! and the back-end of previews on a machine without a GPU.
//!
//! Where the WGSL is specialised by choosing modules, the twin asks the header.

mod address;
mod blend;
mod cell;
pub mod color;
mod composite;
mod cost;
mod coverage;
mod edge;
mod entry;
mod fill;
mod flat;
mod flow;
mod footprint;
mod frames;
mod gradient;
mod group;
mod image;
mod math;
mod matrix;
mod minify;
mod msdf;
mod over;
pub(crate) mod plane;
mod ramp;
mod run;
mod sample;
mod scopes;
mod segment;
mod settings;
mod source;
mod value;
mod words;

pub use cost::LookupCost;
use footprint::Lookup;
pub(crate) use math::to_f32;
use settings::Settings;
use value::Value;

/// A packed texture ready to be looked up. Cheap to make and to copy; lookups allocate nothing.
///
/// Words past the buffer's end read as zero, as on a GPU with robust buffer access, so a buffer
/// that [`crate::pack`] did not make gives a wrong picture and never a panic.
#[derive(Clone, Copy, Debug)]
pub struct Sampler<'a> {
    words: &'a [u32],
    settings: Settings,
}

impl<'a> Sampler<'a> {
    /// Reads the header of `words`, the words of one texture from [`crate::pack`].
    pub fn new(words: &'a [u32]) -> Self {
        Self {
            words,
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
}

/// Whether the entry whose items `words` start with fills at `p`, in units of its cell's box.
#[cfg(test)]
pub(crate) fn items_fill(words: &[u32], p: [f32; 2]) -> bool {
    run::run_at(&Sampler::new(words), 0, p, true).inside
}

/// How far its outline is, at most `reach`.
#[cfg(test)]
pub(crate) fn items_distance(words: &[u32], p: [f32; 2], reach: f32) -> f32 {
    let mut sampler = Sampler::new(words);
    sampler.settings.curve_lattice = [1.0, reach];
    run::run_at(&sampler, 0, p, false).nearest.sqrt()
}
