//! What the caller can ask of a bake.

use std::fmt;
use std::sync::Arc;

use usvg::fontdb;
use vtex_format::AddressMode;

use crate::BakeError;

/// Pixels along the canvas' longer side at zoom 1. Zoom is a number the caller can picture only if
/// it means pixels.
pub(crate) const PIXELS_AT_ZOOM_1: f64 = 512.0;

/// Which coverage kinds a bake may use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// The judge decides for each shape.
    #[default]
    Auto,
    /// Every shape becomes an MSDF.
    Msdf,
    /// Every shape becomes curves.
    Curves,
    /// The whole canvas becomes one raster image.
    Raster,
}

/// What a file is made for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Profile {
    /// A small file. Loaders cut its outlines.
    #[default]
    Size,
    /// A file that also carries what loaders make of its outlines for points (filter modes point and
    /// paper). It loads four to thirty times as fast and is about three times as large, a busy drawing six.
    Load,
    /// The same for footprints.
    LoadFootprints,
}

/// Options of a bake. The file records all of them.
#[derive(Clone, Debug, PartialEq)]
pub struct BakeConfig {
    /// Kinds of coverage.
    pub mode: Mode,
    /// Texels along the longer side of mip 0; the nearest power of two is taken.
    pub mip0_size: u32,
    /// Texels of the MSDF lattice along the canvas' longer side, at most.
    pub msdf_size: u32,
    /// Full width of the distances that an MSDF texel can hold, in texels.
    pub distance_range_texels: f32,
    /// Largest zoom that geometry is prepared for; 1 shows the canvas' longer side at 512 pixels.
    pub max_zoom: f32,
    /// How far an MSDF may displace an edge, in pixels at `max_zoom`, before the shape becomes
    /// curves. For [`Mode::Auto`].
    pub error_px: f64,
    /// Put all shapes into one layer, \[SFG22\]'s "merge all".
    pub merge: bool,
    /// Lookups return alpha only.
    pub mask: bool,
    /// Half width S of \[SFG22\] eq. 1, as a share of the distance range.
    pub smoothing: f32,
    /// Width of the distance outline, \[SFG22\] eq. 2, in texels. For [`Mode::Auto`], which then
    /// makes MSDFs alone, and [`Mode::Msdf`].
    pub outline_texels: Option<f32>,
    /// Replaces the paint of every fill: straight alpha, sRGB-encoded.
    pub fill_color: Option<[f32; 4]>,
    /// Replaces the paint of every stroke and of the distance outline.
    pub stroke_color: Option<[f32; 4]>,
    /// Address modes along u and v.
    pub address: [AddressMode; 2],
    /// `a b c d e f` of the texture matrix.
    pub texture_matrix: [f32; 6],
    /// Bytes on a GPU, packed for lookups of points with texels of four bytes, beyond which the file
    /// has a warning. Nothing else depends on it.
    pub gpu_budget_bytes: u64,
    /// What the file is made for.
    pub profile: Profile,
}

impl Default for BakeConfig {
    fn default() -> Self {
        Self {
            mode: Mode::Auto,
            mip0_size: 128,
            msdf_size: 1024,
            distance_range_texels: 4.0,
            max_zoom: 64.0,
            error_px: 0.1,
            merge: false,
            mask: false,
            smoothing: 1.0 / 64.0,
            outline_texels: None,
            fill_color: None,
            stroke_color: None,
            address: [AddressMode::Clamp; 2],
            texture_matrix: [1.0, 0.0, 0.0, 1.0, 0.0, 0.0],
            gpu_budget_bytes: 4 << 20,
            profile: Profile::Size,
        }
    }
}

impl BakeConfig {
    /// Pixels along the canvas' longer side at the largest zoom. Every tolerance that is given in
    /// pixels becomes a length through this number.
    pub(crate) fn longer_side_px(&self) -> f64 {
        PIXELS_AT_ZOOM_1 * f64::from(self.max_zoom)
    }

    /// Checks every option against its range.
    ///
    /// # Errors
    /// [`BakeError::Parameter`] naming the first option out of range.
    pub fn check(&self) -> Result<(), BakeError> {
        let unit =
            |c: Option<[f32; 4]>| c.is_none_or(|c| c.iter().all(|v| (0.0..=1.0).contains(v)));
        let half_range = self.distance_range_texels / 2.0;
        let outline_fits = |w: f32| w > 0.0 && w < half_range;
        let [a, b, c, d, _, _] = self.texture_matrix;
        let rules = [
            (
                (1..=8192).contains(&self.mip0_size),
                "mip 0 size must lie between 1 and 8192 texels",
            ),
            (
                (16..=8192).contains(&self.msdf_size),
                "MSDF size must lie between 16 and 8192 texels",
            ),
            (
                (1.0..=64.0).contains(&self.distance_range_texels),
                "distance range must lie between 1 and 64 texels",
            ),
            (
                (1.0..=4096.0).contains(&self.max_zoom),
                "maximum zoom must lie between 1 and 4096",
            ),
            (
                self.error_px > 0.0 && self.error_px.is_finite(),
                "error bound must be positive and finite",
            ),
            (
                self.smoothing > 0.0 && self.smoothing <= 0.5,
                "smoothing must be positive and at most 0.5",
            ),
            (
                self.outline_texels.is_none_or(outline_fits),
                "outline width must be positive and below half the distance range",
            ),
            (
                self.outline_texels.is_none() || matches!(self.mode, Mode::Auto | Mode::Msdf),
                "a distance outline needs MSDFs, which the modes curves and raster do not make",
            ),
            (
                unit(self.fill_color),
                "fill colour channels must lie between 0 and 1",
            ),
            (
                unit(self.stroke_color),
                "stroke colour channels must lie between 0 and 1",
            ),
            (
                self.texture_matrix.iter().all(|v| v.is_finite()) && a * d - b * c != 0.0,
                "texture matrix must be finite and invertible",
            ),
        ];
        match rules.iter().find(|(holds, _)| !holds) {
            Some((_, rule)) => Err(BakeError::Parameter((*rule).to_owned())),
            None => Ok(()),
        }
    }
}

/// What a bake may use besides the SVG. The baker itself opens no file.
#[derive(Clone, Debug, Default)]
pub struct Resources {
    /// Fonts for text.
    pub fonts: Arc<fontdb::Database>,
    /// Reads images that the SVG links to. Without a reader they are left out with a warning.
    pub images: Option<ImageReader>,
}

/// Reads the file that an `<image>` or `feImage` links to.
///
/// The reader gets the link exactly as the SVG gives it. The SVG may be hostile, so the reader must
/// refuse every path that it should not read. An SVG image that is read this way cannot link to
/// files of its own.
#[derive(Clone)]
pub struct ImageReader(Arc<ReadImage>);

/// From a link to the bytes of an image file, or to a few words on why there are none.
type ReadImage = dyn Fn(&str) -> Result<Vec<u8>, String> + Send + Sync;

impl ImageReader {
    /// A reader that calls `read` once for each `<image>`.
    pub fn new(read: impl Fn(&str) -> Result<Vec<u8>, String> + Send + Sync + 'static) -> Self {
        Self(Arc::new(read))
    }

    /// The bytes behind a link.
    pub(crate) fn read(&self, reference: &str) -> Result<Vec<u8>, String> {
        (self.0)(reference)
    }
}

impl fmt::Debug for ImageReader {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("ImageReader")
    }
}

/// Stages of a bake, in order. [`crate::bake_observed`] reports each as it begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// From SVG text to usvg's tree.
    Parse,
    /// From the tree to shapes and patches.
    Draw,
    /// Outlines are prepared, and each shape gets its kind of coverage.
    Prepare,
    /// Shapes are packed into layers.
    Pack,
    /// Each cell gets its list of entries.
    Cells,
    /// MSDF tiles are rendered.
    Msdf,
    /// Records and the shader are made.
    Encode,
    /// Mips of the canvas are made.
    Mips,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_out_of_range_are_named() {
        assert!(BakeConfig::default().check().is_ok());
        let bad = [
            BakeConfig {
                mip0_size: 0,
                ..BakeConfig::default()
            },
            BakeConfig {
                max_zoom: f32::NAN,
                ..BakeConfig::default()
            },
            BakeConfig {
                smoothing: 0.0,
                ..BakeConfig::default()
            },
            BakeConfig {
                outline_texels: Some(2.0),
                ..BakeConfig::default()
            },
            BakeConfig {
                outline_texels: Some(1.0),
                mode: Mode::Curves,
                ..BakeConfig::default()
            },
            BakeConfig {
                fill_color: Some([2.0, 0.0, 0.0, 1.0]),
                ..BakeConfig::default()
            },
            BakeConfig {
                texture_matrix: [1.0, 2.0, 2.0, 4.0, 0.0, 0.0],
                ..BakeConfig::default()
            },
        ];
        for config in bad {
            assert!(
                matches!(config.check(), Err(BakeError::Parameter(_))),
                "{config:?}"
            );
        }
    }
}
