//! The baseline: a raster texture with mips, looked up on the CPU and by the sampler of the GPU.

use std::sync::Arc;

use vtex_format::Image;
use vtex_shaders::layout::BatchQuery;
use vtex_shaders::srgb;

use super::rasterise::{level_count, level_size};
use crate::timing::{Device, Kernel};

/// Side of the raster that a vector texture replaces: 64 MiB before its mips.
pub(crate) const RASTER_SIZE: u32 = 4096;

/// An opaque picture of `size` texels for rivals whose time does not depend on what is drawn.
pub(crate) fn synthetic(size: u32) -> Image {
    let texel = |i: u32| {
        let [x, y] = [i % size, i / size];
        let [red, green, ..] = (x ^ y).wrapping_mul(0x9e37_79b1).to_le_bytes();
        [
            red,
            green,
            if (x / 16 + y / 16).is_multiple_of(2) {
                255
            } else {
                0
            },
            255,
        ]
    };
    let mut mips = vec![(0..size * size).flat_map(texel).collect::<Vec<u8>>()];
    let mut side = size;
    while side > 1 {
        let finer = mips.last().map_or(&[][..], Vec::as_slice);
        mips.push(halved(finer, side));
        side /= 2;
    }
    Image {
        rect_uv: [0.0, 0.0, 1.0, 1.0],
        size: [size; 2],
        mips: Arc::new(mips),
    }
}

/// A square level of half the side. It averages encoded values: timing does not depend on colours.
fn halved(finer: &[u8], side: u32) -> Vec<u8> {
    let (side, half) = (side as usize, side as usize / 2);
    let byte = |i: usize| {
        let (texel, channel) = (i / 4, i % 4);
        let at = 4 * (texel / half * 2 * side + texel % half * 2) + channel;
        let sum: u16 = [0, 4, 4 * side, 4 * side + 4]
            .iter()
            .map(|o| u16::from(finer[at + o]))
            .sum();
        // A mean of bytes is a byte.
        u8::try_from(sum / 4).unwrap_or(u8::MAX)
    };
    (0..4 * half * half).map(byte).collect()
}

/// The image as an sRGB texture with all its levels behind a trilinear sampler.
pub(crate) fn hardware_kernel(device: &Device, image: &Image) -> Kernel {
    let texels = TexelBlocks {
        format: wgpu::TextureFormat::Rgba8UnormSrgb,
        side: 1,
        bytes: 4,
    };
    texture_kernel(device, texels, image.size, &image.mips)
}

/// How a texture's levels lie in memory: in square blocks of texels, row by row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TexelBlocks {
    pub(crate) format: wgpu::TextureFormat,
    /// Texels along a block.
    pub(crate) side: u32,
    /// Bytes of a block.
    pub(crate) bytes: u32,
}

/// A texture with `levels` behind a trilinear sampler.
pub(crate) fn texture_kernel(
    device: &Device,
    blocks: TexelBlocks,
    size: [u32; 2],
    levels: &[Vec<u8>],
) -> Kernel {
    let texture = upload(device, blocks, size, levels);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let sampler = device.device.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..wgpu::SamplerDescriptor::default()
    });
    let view = wgpu::BindingResource::TextureView(&view);
    let sampler = wgpu::BindingResource::Sampler(&sampler);
    device.kernel(include_str!("../wgsl/hardware.wgsl"), &[view, sampler])
}

fn upload(
    device: &Device,
    blocks: TexelBlocks,
    size: [u32; 2],
    levels: &[Vec<u8>],
) -> wgpu::Texture {
    let extent = |[width, height]: [u32; 2]| wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    let texture = device.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent(size),
        mip_level_count: level_count(size),
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: blocks.format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (level, bytes) in (0..).zip(levels) {
        // A copy takes whole blocks, also of a level that is smaller than one.
        let size = level_size(size, level).map(|side| side.next_multiple_of(blocks.side));
        let target = wgpu::TexelCopyTextureInfo {
            mip_level: level,
            ..texture.as_image_copy()
        };
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(blocks.bytes * (size[0] / blocks.side)),
            rows_per_image: None,
        };
        let size = extent(size);
        device.queue.write_texture(target, bytes, layout, size);
    }
    texture
}

/// The image as linear half floats in a storage buffer, filtered by hand.
pub(crate) fn halves_kernel(device: &Device, image: &Image) -> Kernel {
    let words = halves_words(image);
    let words = device.buffer(bytemuck::cast_slice(&words), wgpu::BufferUsages::STORAGE);
    device.kernel(
        include_str!("../wgsl/halves.wgsl"),
        &[words.as_entire_binding()],
    )
}

/// As `wgsl/halves.wgsl` reads them.
fn halves_words(image: &Image) -> Vec<u32> {
    let decode = srgb::decode_table();
    let levels = level_count(image.size);
    let mut words = vec![0; 20];
    words[..3].copy_from_slice(&[image.size[0], image.size[1], levels]);
    for (level, texels) in image.mips.iter().enumerate() {
        words[4 + level] = u32::try_from(words.len()).unwrap_or(u32::MAX);
        for texel in texels.as_chunks::<4>().0 {
            let [r, g, b, a] = linear(&decode, *texel)
                .map(half::f16::from_f32)
                .map(half::f16::to_bits);
            words.push(u32::from(r) | u32::from(g) << 16);
            words.push(u32::from(b) | u32::from(a) << 16);
        }
    }
    words
}

/// The same trilinear lookup in Rust: bytes decoded through a table, blended as floats.
#[derive(Debug)]
pub(crate) struct CpuRaster<'a> {
    image: &'a Image,
    decode: [f32; 256],
}

impl<'a> CpuRaster<'a> {
    pub(crate) fn new(image: &'a Image) -> Self {
        Self {
            image,
            decode: srgb::decode_table(),
        }
    }

    /// Linear light, premultiplied.
    pub(crate) fn sample(&self, query: &BatchQuery) -> [f32; 4] {
        let [width, height] = self.image.size.map(|side| side as f32);
        let [u0, v0, u1, v1] = query.footprint;
        let width_texels = (u0 * width)
            .hypot(v0 * height)
            .max((u1 * width).hypot(v1 * height));
        let last = (self.image.mips.len() - 1) as f32;
        let lod = width_texels.log2().clamp(0.0, last);
        let fine = floor_index(lod);
        let coarse = (fine + 1).min(self.image.mips.len() - 1);
        let t = glam::Vec4::splat(lod.fract());
        let [fine, coarse] = [self.level(fine, query.uv), self.level(coarse, query.uv)];
        (fine + (coarse - fine) * t).to_array()
    }

    fn level(&self, level: usize, uv: [f32; 2]) -> glam::Vec4 {
        let texels = &self.image.mips[level];
        let level = u32::try_from(level).unwrap_or(u32::MAX);
        let [width, height] = level_size(self.image.size, level).map(|side| side as usize);
        let (x0, x1, s) = neighbours(uv[0], width);
        let (y0, y1, t) = neighbours(uv[1], height);
        let texel = |x: usize, y: usize| {
            let at = 4 * (y * width + x);
            let bytes = [texels[at], texels[at + 1], texels[at + 2], texels[at + 3]];
            glam::Vec4::from_array(linear(&self.decode, bytes))
        };
        let upper = texel(x0, y0).lerp(texel(x1, y0), s);
        let lower = texel(x0, y1).lerp(texel(x1, y1), s);
        upper.lerp(lower, t)
    }
}

/// Texels around a coordinate, clamped to the edge, and the weight of the second.
fn neighbours(coordinate: f32, size: usize) -> (usize, usize, f32) {
    let x = coordinate * size as f32 - 0.5;
    let low = floor_index(x.max(0.0)).min(size - 1);
    (
        low,
        (low + 1).min(size - 1),
        (x - low as f32).clamp(0.0, 1.0),
    )
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "callers pass values between 0 and a texture's side"
)]
fn floor_index(value: f32) -> usize {
    value as usize
}

fn linear(decode: &[f32; 256], [r, g, b, a]: [u8; 4]) -> [f32; 4] {
    let color = [r, g, b].map(|byte| decode[usize::from(byte)]);
    [color[0], color[1], color[2], f32::from(a) / 255.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lookups_hit_texels_and_levels() {
        let image = synthetic(8);
        assert_eq!(image.mips.len(), 4);
        let raster = CpuRaster::new(&image);
        let at = |x: f32, y: f32, size: f32| {
            let footprint = [1.0 / size, 0.0, 0.0, 1.0 / size];
            let uv = [(x + 0.5) / size, (y + 0.5) / size];
            raster.sample(&BatchQuery {
                uv,
                footprint,
                ..BatchQuery::default()
            })
        };
        for (level, side) in [(0, 8_u8), (1, 4), (2, 2), (3, 1)] {
            for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
                let texel = 4 * (usize::from(y) * usize::from(side) + usize::from(x));
                let bytes: [u8; 4] = image.mips[level][texel..texel + 4].try_into().unwrap();
                let expect = linear(&raster.decode, bytes);
                let got = at(f32::from(x), f32::from(y), f32::from(side));
                assert!(
                    expect.iter().zip(got).all(|(e, g)| (e - g).abs() < 1e-6),
                    "{level} {x} {y}"
                );
            }
        }
    }
}
