//! Pictures in linear light, how they are taken, and how far two of them are apart.

mod metrics;
mod shot;

use crate::{TruthError, srgb};

pub use metrics::{Difference, PSNR_CAP_DB, WRONG_ABOVE, difference, difference_picture};
pub use shot::{POINTS, Shot, hash};

/// A rectangle of the canvas in uv: left, top, right, bottom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Left.
    pub u0: f64,
    /// Top.
    pub v0: f64,
    /// Right.
    pub u1: f64,
    /// Bottom.
    pub v1: f64,
}

impl View {
    /// The whole canvas.
    pub const WHOLE: Self = Self {
        u0: 0.0,
        v0: 0.0,
        u1: 1.0,
        v1: 1.0,
    };

    /// The window of `1 / zoom` of the canvas around `center_uv`, moved to lie inside it.
    pub fn window(center_uv: [f64; 2], zoom: f64) -> Self {
        let side = 1.0 / zoom.max(1.0);
        let [u0, v0] = center_uv.map(|c| (c - side / 2.0).clamp(0.0, 1.0 - side));
        Self {
            u0,
            v0,
            u1: u0 + side,
            v1: v0 + side,
        }
    }

    /// Width and height in uv.
    pub fn extent(&self) -> [f64; 2] {
        [self.u1 - self.u0, self.v1 - self.v0]
    }

    /// The uv of a point given in pixels of a picture of `size_px` that shows this view.
    pub fn uv_from_px(&self, point_px: [f64; 2], size_px: [u32; 2]) -> [f64; 2] {
        let [width, height] = self.extent();
        [
            self.u0 + width * point_px[0] / f64::from(size_px[0]),
            self.v0 + height * point_px[1] / f64::from(size_px[1]),
        ]
    }

    /// As numbers, for reports.
    pub fn as_array(&self) -> [f64; 4] {
        [self.u0, self.v0, self.u1, self.v1]
    }
}

/// Pixels in linear light, premultiplied alpha, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// `width * height` pixels.
    pub pixels: Vec<[f32; 4]>,
}

impl Picture {
    /// Straight-alpha sRGB bytes, four a pixel.
    pub fn to_straight_srgb(&self) -> Vec<u8> {
        let straight = |&[r, g, b, a]: &[f32; 4]| {
            let channel = |c: f32| {
                if a > 0.0 {
                    srgb::byte(srgb::encode(c / a))
                } else {
                    0
                }
            };
            [channel(r), channel(g), channel(b), srgb::byte(a)]
        };
        self.pixels.iter().flat_map(straight).collect()
    }

    /// Straight-alpha sRGB PNG.
    ///
    /// # Errors
    /// When the picture has no pixels.
    pub fn to_png(&self) -> Result<Vec<u8>, TruthError> {
        encode_png(
            self.size_px,
            &self.to_straight_srgb(),
            png::Compression::Balanced,
        )
    }

    /// sRGB-encoded red, green and blue, composited over an opaque grey of linear value `ground`.
    pub fn over(&self, ground: f32) -> Vec<[f32; 3]> {
        let over = |&[r, g, b, a]: &[f32; 4]| {
            [r, g, b].map(|c| srgb::encode((c + (1.0 - a) * ground).clamp(0.0, 1.0)))
        };
        self.pixels.iter().map(over).collect()
    }

    /// Alpha as an opaque grey picture: how masks are compared.
    pub fn alpha_as_grey(mut self) -> Self {
        for pixel in &mut self.pixels {
            *pixel = [pixel[3], pixel[3], pixel[3], 1.0];
        }
        self
    }
}

/// RGBA8 bytes as PNG, marked sRGB.
///
/// # Errors
/// When the sizes do not agree.
pub fn encode_png(
    size_px: [u32; 2],
    rgba: &[u8],
    compression: png::Compression,
) -> Result<Vec<u8>, TruthError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size_px[0], size_px[1]);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(compression);
    encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(rgba))?;
    Ok(bytes)
}

/// Width and height in the proportions of the canvas: the longer side is `longer_px`, the other at
/// least 1.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "positive and at most longer_px"
)]
pub fn fit_size(canvas_size: [f64; 2], longer_px: u32) -> [u32; 2] {
    let longer = canvas_size[0].max(canvas_size[1]);
    canvas_size.map(|side| ((side / longer * f64::from(longer_px)).round() as u32).max(1))
}
