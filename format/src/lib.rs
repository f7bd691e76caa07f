//! The `.vtex` container: bytes in, value out, and back.
//!
//! A [`VtexFile`] is one baked vector texture as plain data: a cell grid whose entries name
//! coverage and paint, the MSDF tiles they look up, raster images for minification and for what
//! is not vector, and the report of how it was baked. `docs/format.md` specifies every byte;
//! this crate is the only one that knows an offset.
//!
//! Reading never panics and never allocates more than [`Limits`] allows, whatever the bytes, and
//! a file that [`VtexFile::parse`] accepts is safe to evaluate: every index in it names something
//! and every list ends. [`validate`] lists all that is wrong with a file, [`directory`] what it
//! is made of.
//!
//! The smallest picture there is, one red cell:
//!
//! ```
//! use vtex_format::{CellWord, Grid, Limits, Meta, PaintRecord, SpecKey, VtexFile};
//!
//! let red = CellWord::Paint { paint: 0 };
//! let mut file = VtexFile {
//!     paints: vec![PaintRecord::solid([1.0, 0.0, 0.0, 1.0])],
//!     cells: vec![red.encode().expect("0 fits 30 bits")],
//!     ..VtexFile::blank(Meta::new([100.0, 100.0], Grid::new([1, 1], 8)))
//! };
//! file.spec = SpecKey::for_file(&file);
//!
//! let bytes = file.to_bytes()?;
//! assert_eq!(VtexFile::parse(&bytes, &Limits::default())?, file);
//!
//! // A truncated file says where it is broken and whose fault that is.
//! let error = VtexFile::parse(&bytes[..100], &Limits::default()).unwrap_err();
//! assert_eq!(error.issue().code, 1004);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(
    not(any(test, all(feature = "encode", feature = "decode"))),
    expect(
        dead_code,
        reason = "reading and writing share their modules; the half that is left out has no caller"
    )
)]

#[cfg(all(feature = "decode", not(any(feature = "zstd", feature = "ruzstd"))))]
compile_error!("reading needs a decoder: enable the feature `zstd` or `ruzstd`");

mod cells;
mod check;
mod container;
mod curves;
mod file;
mod packing;
mod records;
mod serial;

pub use cells::blocks::{
    Block, ListFault, ListFaultKind, MAX_BLEND_DEPTH, MaskBlock, branch_target, list_blend_depth,
    list_blocks,
};
pub use cells::cell::{
    CELL_TAG_SHIFT, CellWord, Entry, EntryKind, MAX_COMMANDS, MAX_ENTRIES_PER_CELL, MAX_INDEXED,
    MAX_LIST_COMMANDS,
};
pub use cells::control::{BlendMode, MaskKind, OPEN_ISOLATED};
pub use container::directory::{Directory, directory};
pub use container::error::{ReadError, WriteError};
pub use container::issue::{Fault, ISSUES, Issue, IssueKind};
pub use container::layout::{MAX_SECTIONS, VERSION_MAJOR, VERSION_MINOR};
pub use container::limits::Limits;
pub use container::section::{BundleInfo, Codec, SectionInfo};
pub use container::tag::Tag;
pub use curves::cut;
pub use curves::outlines::{
    OutlineError, RecordParts, StoredOutline, StoredOutlines, StoredSegment,
};
pub use file::spec::{Features, SHADER_ABI, SHALLOW_BLEND_DEPTH, SpecKey};
pub use file::texture::VtexFile;
#[cfg(feature = "encode")]
#[doc(hidden)]
pub use packing::dictionary::shader_dictionaries;
pub use records::curve::{
    CURVE_HEADER_WORDS, CURVE_LINE_WORDS, CURVE_QUAD_WORDS, CurveHeader, CurveLattice,
    MAX_CURVE_SEGMENTS, MAX_CURVE_STEPS,
};
pub use records::gradient::{Gradient, GradientShape, GradientStop, MAX_GRADIENT_STOPS, Spread};
pub use records::image::{Image, MAX_IMAGE_SIDE, MAX_MIPS};
pub use records::layer::LayerRecord;
pub use records::meta::{
    AddressMode, DistanceOutline, Grid, MAX_GRID_SIDE, MAX_TEXELS_PER_CELL, Meta, SamplerSettings,
};
pub use records::paint::{PAINT_SOLID, PaintRecord};
pub use records::prov::{
    EMBEDDED_SOURCE, Finding, MsdfError, Preparation, Provenance, ShapeReport, Warning, WarningCode,
};
pub use records::shader::ShaderBlob;
pub use records::shape::{
    COVERAGE_CURVES, COVERAGE_IMAGE, COVERAGE_MSDF, FILL_EVEN_ODD, FILL_NON_ZERO, ShapeRecord,
};
#[cfg(feature = "decode")]
pub use serial::read::validate;
#[cfg(feature = "encode")]
pub use serial::write::Executor;

/// The examples of README.md, which run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
