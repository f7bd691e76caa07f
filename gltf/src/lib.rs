//! Reads glTF 2.0 into scenes of the path tracer in `vtex-runtime`, with vector textures in any slot.
//!
//! [`read`] takes the bytes of a `.glb` or `.gltf` file. It opens no file and parses no SVG: a program
//! lends it both through [`Files`]. What the tracer does not show yet is kept in [`Asset`] and named in
//! [`Asset::warnings`]. [`attach`] adds vector textures to an asset; it opens in any other program with
//! the images that it had. `docs/gltf.md` describes the extension `VTEX_texture_vector`.
//!
//! ```
//! use vtex_gltf::{NoFiles, ReadOptions, read};
//!
//! let text = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": []}]}"#;
//! let asset = read(text.as_bytes(), &mut NoFiles, &ReadOptions::default())?;
//! assert!(asset.scene.instances.is_empty());
//! # Ok::<(), vtex_gltf::GltfError>(())
//! ```

mod attach;
mod buffers;
mod document;
mod error;
mod geometry;
mod nodes;
mod raster;
mod read;
mod surface;
mod texture;
mod view;

pub use attach::{Attachment, attach};
pub use buffers::source::{Files, NoFiles};
pub use document::material;
pub use error::GltfError;
pub use geometry::Attributes;
pub use nodes::{NamedCamera, PunctualKind, PunctualLight};
pub use read::{Asset, PrimitiveInfo, ReadOptions, read};
pub use view::view_of;
