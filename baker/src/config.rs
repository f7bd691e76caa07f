//! What the user can ask of a bake.

use std::sync::Arc;

use usvg::fontdb;
use vtex_format::AddressMode;

/// Which coverage kinds a bake may use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// The best for each shape.
    #[default]
    Auto,
    /// Every shape an MSDF.
    Msdf,
    /// The whole canvas a raster image.
    Raster,
}

/// Options of a bake; all are recorded in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct BakeConfig {
    /// Coverage kinds.
    pub mode: Mode,
    /// Texels of mip 0's longer side.
    pub mip0_size: u32,
    /// Texels of the MSDF lattice along the canvas' longer side.
    pub msdf_size: u32,
    /// Full width of the distances an MSDF texel holds, in texels.
    pub distance_range_texels: f32,
    /// Largest magnification that geometry is prepared for; 1 shows the canvas at 512 pixels.
    pub max_zoom: f32,
    /// Put all shapes into one layer, [SFG22]'s "merge all".
    pub merge: bool,
    /// Output coverage only.
    pub mask: bool,
    /// Half width S of [SFG22] eq. 1, in units of the stored field.
    pub smoothing: f32,
    /// Width of [SFG22] eq. 2's outline in texels.
    pub outline_texels: Option<f32>,
    /// Replaces every fill's colour: straight alpha, sRGB-encoded.
    pub fill_color: Option<[f32; 4]>,
    /// Replaces every stroke's and the outline's colour.
    pub stroke_color: Option<[f32; 4]>,
    /// Address modes along u and v.
    pub address: [AddressMode; 2],
    /// `a b c d e f` of the texture matrix.
    pub texture_matrix: [f32; 6],
}

impl Default for BakeConfig {
    fn default() -> Self {
        Self {
            mode: Mode::Auto,
            mip0_size: 512,
            msdf_size: 512,
            distance_range_texels: 4.0,
            max_zoom: 64.0,
            merge: false,
            mask: false,
            smoothing: 1.0 / 64.0,
            outline_texels: None,
            fill_color: None,
            stroke_color: None,
            address: [AddressMode::Clamp; 2],
            texture_matrix: [1.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        }
    }
}

/// What a bake may use besides the SVG; the baker itself opens no file.
#[derive(Clone, Debug, Default)]
pub struct Resources {
    /// Fonts for text.
    pub fonts: Arc<fontdb::Database>,
}

/// Steps of a bake in order, told to the caller as each begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// SVG text to usvg tree.
    Parse,
    /// Tree to shapes and patches.
    Draw,
    /// Outlines made simple.
    Prepare,
    /// Shapes into layers.
    Pack,
    /// Cells and their entries.
    Cells,
    /// MSDF tiles.
    Msdf,
    /// Raster mips.
    Mips,
    /// Shader and records.
    Encode,
}
