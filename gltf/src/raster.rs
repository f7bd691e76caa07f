//! Raster images as textures: one cell that shows one image with its mips, so that they lie in the
//! pages of the vector textures and are looked up by the same code.

use std::io::Cursor;
use std::sync::Arc;

use image::ImageReader;
use vtex_format::{AddressMode, Grid, Image, Meta, SamplerSettings, SpecKey, VtexFile};

use vtex_shaders::srgb;

use crate::document::material::AlphaMode;

/// Longest side of an image: what a page holds of its finest level.
const MOST_SIDE: u32 = 8190;
/// Bytes that decoding one image may take.
const MOST_BYTES: u64 = 1 << 30;

/// A decoded image, sRGB-encoded and straight, 4 bytes a texel.
#[derive(Clone, Debug)]
pub(crate) struct Raster {
    pub(crate) size: [u32; 2],
    pub(crate) texels: Vec<u8>,
}

/// How the texels of a base colour become those of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Alpha {
    pub(crate) mode: AlphaMode,
    pub(crate) factor: f32,
    pub(crate) cutoff: f32,
}

impl Raster {
    /// Of a PNG, JPEG or WebP.
    pub(crate) fn decode(bytes: &[u8]) -> Result<Self, String> {
        let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
        let mut reader = reader.map_err(|error| error.to_string())?;
        let mut limits = image::Limits::default();
        limits.max_image_width = Some(MOST_SIDE);
        limits.max_image_height = Some(MOST_SIDE);
        limits.max_alloc = Some(MOST_BYTES);
        reader.limits(limits);
        let decoded = reader.decode().map_err(|error| error.to_string())?;
        let texels = decoded.into_rgba8();
        Ok(Self {
            size: [texels.width(), texels.height()],
            texels: texels.into_raw(),
        })
    }

    /// One texel of white.
    pub(crate) fn white() -> Self {
        Self {
            size: [1; 2],
            texels: vec![u8::MAX; 4],
        }
    }

    /// Mean of each channel, in \[0, 1\]: as stored where `linear`, else of linear light.
    pub(crate) fn mean(&self, linear: bool) -> [f32; 4] {
        let mut sums = [0.0_f64; 4];
        for texel in self.texels.as_chunks::<4>().0 {
            for (channel, (sum, &value)) in sums.iter_mut().zip(texel).enumerate() {
                let value = f32::from(value) / 255.0;
                let decoded = if linear || channel == 3 {
                    value
                } else {
                    srgb::decode(value)
                };
                *sum += f64::from(decoded);
            }
        }
        let count = f64::from(self.size[0]) * f64::from(self.size[1]);
        sums.map(|sum| to_f32(sum / count.max(1.0)))
    }

    /// The texture of this image.
    pub(crate) fn texture(
        &self,
        alpha: Alpha,
        address: [AddressMode; 2],
        matrix: [f32; 6],
    ) -> VtexFile {
        let image = Image {
            rect_uv: [0.0, 0.0, 1.0, 1.0],
            size: self.size,
            mips: Arc::new(self.mips(alpha)),
        };
        let [width, height] = self.size.map(|side| side as f32);
        let mut meta = Meta::new([width, height], Grid::new([1, 1], 16));
        meta.sampler = SamplerSettings {
            texture_matrix: matrix,
            address,
            ..SamplerSettings::default()
        };
        let texels = image.mips[0].as_chunks::<4>().0;
        let opaque = texels.iter().all(|texel| texel[3] == u8::MAX);
        let mut file = VtexFile::of_image(meta, image, opaque);
        // Image 0 is the canvas too: its border follows the address modes, so that repeated images
        // have no seams.
        file.spec = SpecKey {
            features: vtex_format::Features::MIPS,
        };
        file.spec = SpecKey::for_file(&file);
        file
    }

    /// All levels: linear light, premultiplied, then sRGB-encoded.
    fn mips(&self, alpha: Alpha) -> Vec<Vec<u8>> {
        let table = srgb::decode_table();
        let covered = |stored: u8| {
            let value = f32::from(stored) / 255.0 * alpha.factor;
            match alpha.mode {
                AlphaMode::Opaque => 1.0,
                AlphaMode::Mask => f32::from(u8::from(value >= alpha.cutoff)),
                AlphaMode::Blend => value.clamp(0.0, 1.0),
            }
        };
        let mut level: Vec<[f32; 4]> = (self.texels.as_chunks::<4>().0.iter())
            .map(|&[r, g, b, a]| {
                let a = covered(a);
                let [r, g, b] = [r, g, b].map(|c| table[usize::from(c)] * a);
                [r, g, b, a]
            })
            .collect();
        let mut levels = vec![stored(&level)];
        let mut size = self.size;
        for _ in 1..Image::level_count(self.size) {
            let half = size.map(|side| side.div_ceil(2));
            level = halved(&level, size, half);
            size = half;
            levels.push(stored(&level));
        }
        levels
    }
}

/// The mean of two by two texels, of fewer at odd sides.
fn halved(level: &[[f32; 4]], size: [u32; 2], half: [u32; 2]) -> Vec<[f32; 4]> {
    let [width, height] = size.map(|side| side as usize);
    let [half_width, half_height] = half.map(|side| side as usize);
    let mut texels = Vec::with_capacity(half_width * half_height);
    for y in 0..half_height {
        for x in 0..half_width {
            let mut sum = [0.0; 4];
            let mut count = 0.0;
            for row in 2 * y..(2 * y + 2).min(height) {
                for texel in &level[row * width + 2 * x..row * width + (2 * x + 2).min(width)] {
                    for (sum, value) in sum.iter_mut().zip(texel) {
                        *sum += value;
                    }
                    count += 1.0;
                }
            }
            texels.push(sum.map(|value| value / count));
        }
    }
    texels
}

fn stored(level: &[[f32; 4]]) -> Vec<u8> {
    let texel =
        |&[r, g, b, a]: &[f32; 4]| [srgb::encode(r), srgb::encode(g), srgb::encode(b), a].map(byte);
    level.iter().flat_map(texel).collect()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between 0 and 255"
)]
fn byte(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a mean of texels in [0, 1]"
)]
fn to_f32(value: f64) -> f32 {
    value as f32
}
