//! The raster texture that engines use today: the SVG rasterised once, with mips and trilinear
//! lookups.

use rayon::prelude::*;

use crate::picture::{Picture, Shot, encode_png, fit_size};
use crate::reference::Reference;
use crate::{TruthError, srgb};

/// Texels along the longer side of a large raster texture today.
pub const TODAY_TEXELS: u32 = 4096;

/// What a raster with all mips takes in GPU memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RasterBytes {
    /// Bytes as RGBA8.
    pub rgba8: u64,
    /// Bytes as BC7: 16 for each block of 4 x 4 texels.
    pub bc7: u64,
}

impl RasterBytes {
    /// Of a raster of a whole canvas with `longer_texels` along the longer side.
    pub fn of(canvas_size: [f64; 2], longer_texels: u32) -> Self {
        let mut size = fit_size(canvas_size, longer_texels).map(u64::from);
        let mut bytes = Self { rgba8: 0, bc7: 0 };
        loop {
            let [width, height] = size;
            bytes.rgba8 += 4 * width * height;
            bytes.bc7 += 16 * width.div_ceil(4) * height.div_ceil(4);
            if size == [1, 1] {
                return bytes;
            }
            size = size.map(|side| (side / 2).max(1));
        }
    }
}

/// One mip level, RGBA8: colours are premultiplied in linear light, then sRGB-encoded.
#[derive(Debug)]
struct Level {
    size: [u32; 2],
    texels: Vec<[u8; 4]>,
}

/// A raster texture as an engine's importer would make it.
#[derive(Debug)]
pub struct RasterTexture {
    levels: Vec<Level>,
    decode: [f32; 256],
}

impl RasterTexture {
    /// Draws the whole canvas with resvg's anti-aliasing, `longer_texels` along the longer side.
    ///
    /// # Errors
    /// When the picture cannot be drawn.
    pub fn new(smooth: &Reference, longer_texels: u32) -> Result<Self, TruthError> {
        let size = fit_size(smooth.canvas_size(), longer_texels);
        let pixmap = smooth.rasterize(size)?;
        let decode = srgb::decode_table();
        let texel = |&[r, g, b, a]: &[u8; 4]| match a {
            0 => [0; 4],
            255 => [r, g, b, 255],
            _ => {
                // resvg premultiplies sRGB-encoded colours. Filtering is right only for colours that
                // were premultiplied in linear light.
                let alpha = f32::from(a) / 255.0;
                let [r, g, b] = [r, g, b].map(|c| {
                    let straight = (f32::from(c) / f32::from(a)).min(1.0);
                    srgb::byte(srgb::encode(srgb::decode(straight) * alpha))
                });
                [r, g, b, a]
            }
        };
        let texels = pixmap
            .data()
            .as_chunks::<4>()
            .0
            .par_iter()
            .map(texel)
            .collect();
        let mut levels = vec![Level { size, texels }];
        while let Some(last) = levels.last().filter(|level| level.size != [1, 1]) {
            let next = last.halved(&decode);
            levels.push(next);
        }
        Ok(Self { levels, decode })
    }

    /// Texels of mip 0.
    pub fn size(&self) -> [u32; 2] {
        self.levels[0].size
    }

    /// Bytes of mip 0 as PNG.
    ///
    /// # Errors
    /// When it cannot be encoded.
    pub fn png_bytes(&self) -> Result<u64, TruthError> {
        let mip0 = &self.levels[0];
        let bytes = encode_png(
            mip0.size,
            mip0.texels.as_flattened(),
            png::Compression::Fast,
        )?;
        Ok(bytes.len() as u64)
    }

    /// A trilinear lookup, clamped to the edge: linear light, premultiplied.
    pub fn sample(&self, uv: [f32; 2], footprint: [f32; 4]) -> [f32; 4] {
        let [width, height] = self.size().map(|side| side as f32);
        let axis = |u: f32, v: f32| (u * width).hypot(v * height);
        let texels = axis(footprint[0], footprint[1]).max(axis(footprint[2], footprint[3]));
        let last = (self.levels.len() - 1) as f32;
        let lod = texels.max(1.0).log2().min(last);
        let (fine, blend) = (index(lod), lod.fract());
        let mut color = self.bilinear(&self.levels[fine], uv);
        if blend > 0.0 {
            let coarse = self.bilinear(&self.levels[(fine + 1).min(self.levels.len() - 1)], uv);
            color = std::array::from_fn(|c| color[c] + blend * (coarse[c] - color[c]));
        }
        color
    }

    /// Takes a picture, for comparisons.
    pub fn shoot(&self, shot: Shot) -> Picture {
        shot.shoot(|uv, footprint| self.sample(uv, footprint))
    }

    fn bilinear(&self, level: &Level, uv: [f32; 2]) -> [f32; 4] {
        let position: [f32; 2] = std::array::from_fn(|a| uv[a] * level.size[a] as f32 - 0.5);
        let weight = position.map(|p| p - p.floor());
        let mut color = [0.0; 4];
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let texel = level.at([position[0].floor() + dx, position[1].floor() + dy]);
            let share = |w: f32, d: f32| if d > 0.0 { w } else { 1.0 - w };
            let w = share(weight[0], dx) * share(weight[1], dy);
            let linear = self.linear(texel);
            color = std::array::from_fn(|c| color[c] + w * linear[c]);
        }
        color
    }

    fn linear(&self, [r, g, b, a]: [u8; 4]) -> [f32; 4] {
        let table = |c: u8| self.decode[usize::from(c)];
        [table(r), table(g), table(b), f32::from(a) / 255.0]
    }
}

impl Level {
    fn at(&self, texel: [f32; 2]) -> [u8; 4] {
        let [x, y] = [0, 1].map(|a| index(texel[a]).min(self.size[a] as usize - 1));
        self.texels[y * self.size[0] as usize + x]
    }

    /// The next level: averages of 2 x 2 texels in linear light. A side of one texel is repeated.
    fn halved(&self, decode: &[f32; 256]) -> Self {
        let size = self.size.map(|side| (side / 2).max(1));
        let average = |i: u32| {
            let corner = [i % size[0] * 2, i / size[0] * 2];
            let mut sum = [0.0_f32; 4];
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let [r, g, b, a] = self.at([(corner[0] + dx) as f32, (corner[1] + dy) as f32]);
                let [r, g, b] = [r, g, b].map(|c| decode[usize::from(c)]);
                sum = [
                    sum[0] + r,
                    sum[1] + g,
                    sum[2] + b,
                    sum[3] + f32::from(a) / 255.0,
                ];
            }
            let [r, g, b, a] = sum.map(|channel| channel / 4.0);
            let [r, g, b] = [r, g, b].map(|c| srgb::byte(srgb::encode(c)));
            [r, g, b, srgb::byte(a)]
        };
        Self {
            size,
            texels: (0..size[0] * size[1])
                .into_par_iter()
                .map(average)
                .collect(),
        }
    }
}

/// A non-negative number's whole part; negative becomes 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturating: callers clamp to the level's size"
)]
fn index(value: f32) -> usize {
    value.max(0.0) as usize
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::reference::Edges;

    #[test]
    fn blocks_of_small_levels_are_whole() {
        let bytes = RasterBytes::of([8.0, 5.0], 8);
        assert_eq!(bytes.rgba8, 4 * (8 * 5 + 4 * 2 + 2 + 1));
        assert_eq!(bytes.bc7, 16 * (4 + 1 + 1 + 1));
    }

    #[test]
    fn mips_keep_the_mean() {
        let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'>\
                   <path d='M0 0H4V8H0z' fill='#fff'/></svg>";
        let smooth = Reference::parse(svg.as_bytes(), Arc::default(), Edges::Smooth).unwrap();
        let texture = RasterTexture::new(&smooth, 8).unwrap();
        let whole = texture.sample([0.5, 0.5], [1.0, 0.0, 0.0, 1.0]);
        assert!(
            (whole[0] - 0.5).abs() < 0.01 && (whole[3] - 0.5).abs() < 0.01,
            "{whole:?}"
        );
        assert_eq!(texture.sample([0.25, 0.5], [0.0; 4]), [1.0; 4]);
        assert_eq!(texture.sample([0.75, 0.5], [0.0; 4]), [0.0; 4]);
    }
}
