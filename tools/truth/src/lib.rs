//! What a texture should look like, and how far it is from that.
//!
//! The truth is a picture that resvg draws from the SVG. [`mod@reference`] draws it, at any zoom.
//! [`texture`] takes pictures of a `.vtex` file, and of the raster texture that engines use today.
//! [`picture`] measures how far two pictures are apart. [`comparison`] chooses the windows to
//! compare at a zoom, compares them, and makes a page of the pictures.
//!
//! Nothing here reads or writes files or prints.
//!
//! ```
//! use vtex_baker::{BakeConfig, Resources, bake};
//! use vtex_truth::comparison::{Comparison, Terms};
//! use vtex_truth::reference::{Edges, Reference};
//! use vtex_truth::texture::{FilterMode, Shooter, canvas_options, region_uv};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let svg = b"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'><path d='M1 1H6V7z'/></svg>";
//! let file = bake(svg, &BakeConfig::default(), &Resources::default())?;
//! let reference = Reference::parse(svg, Default::default(), Edges::Crisp)?;
//! let filter = FilterMode::Point;
//! let region_uv = region_uv(&file, filter);
//! let terms = Terms { longer_px: 64, spp: 16, region_uv, windows: 1, mask: false };
//! let shooter = Shooter::on_cpu(&file, canvas_options(filter));
//! let report = Comparison::new(&reference, terms)?.measure(8.0, |shot| shooter.shoot(shot))?;
//! assert!(report.worst().difference.psnr_db > 30.0);
//! # Ok(())
//! # }
//! ```

pub mod comparison;
mod error;
pub mod picture;
pub mod reference;
pub mod srgb;
pub mod texture;

pub use error::TruthError;
