//! The `.vtex` container: bytes in, value out, and back.
//!
//! A [`VtexFile`] is one baked vector texture as plain data: a cell grid whose entries name
//! coverage and paint, the MSDF tiles they look up, raster images for minification and for what
//! is not vector, and the report of how it was baked. `docs/format.md` specifies every byte;
//! this crate is the only one that knows an offset.
//!
//! Reading never panics and never allocates more than [`Limits`] allows, whatever the bytes.

mod cell;
mod curve;
mod error;
mod file;
mod image;
mod layer;
mod limits;
mod meta;
mod paint;
mod prov;
mod shader;
mod shape;
mod spec;

pub use cell::{CELL_TAG_SHIFT, CellWord, Entry, EntryKind, MAX_ENTRIES_PER_CELL};
pub use curve::{
    CURVE_HEADER_WORDS, CURVE_LINE_WORDS, CURVE_QUAD_WORDS, CurveHeader, CurveLattice,
    MAX_CURVE_SEGMENTS, MAX_CURVE_STEPS,
};
pub use error::{ReadError, WriteError};
pub use file::VtexFile;
pub use image::{Image, MAX_MIPS};
pub use layer::LayerRecord;
pub use limits::Limits;
pub use meta::{AddressMode, Grid, Meta, Outline, SamplerSettings};
pub use paint::{PAINT_SOLID, PaintRecord};
pub use prov::{Provenance, ShapeReport, Warning, WarningCode};
pub use shader::ShaderBlob;
pub use shape::{COVERAGE_IMAGE, COVERAGE_MSDF, FILL_EVEN_ODD, FILL_NON_ZERO, ShapeRecord};
pub use spec::{Features, SHADER_ABI, SpecKey};
