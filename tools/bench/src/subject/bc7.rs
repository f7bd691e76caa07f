//! The rival that engines ship: the raster texture in BC7 blocks, with its mips.

use std::collections::BTreeMap;

use block_compression::encode::compress_rgba8;
use block_compression::{BC7Settings, CompressionVariant};
use rayon::prelude::*;
use vtex_format::Image;

use super::raster::{TexelBlocks, texture_kernel};
use super::rasterise::level_size;
use crate::timing::{Device, Kernel};

/// Longer sides of the BC7 textures: the raster's own level 0, 1 and 2.
pub(crate) const BC7_SIZES: [u32; 3] = [4096, 2048, 1024];
/// Sides of a raster are multiples of this, so that its first three levels are whole blocks.
pub(crate) const BC7_SIDE_MULTIPLE: u32 = BLOCK << (BC7_SIZES.len() - 1);

/// Texels along a block, and bytes of one.
const BLOCK: u32 = 4;
const BLOCK_BYTES: u32 = 16;
const BLOCK_RGBA: usize = 64;
/// Blocks that one task encodes.
const TASK: usize = 512;

/// A mip chain in blocks.
#[derive(Debug)]
pub(crate) struct Bc7 {
    size: [u32; 2],
    levels: Vec<Vec<u8>>,
}

impl Bc7 {
    /// The image's levels in blocks. Its sides are multiples of [`BC7_SIDE_MULTIPLE`].
    ///
    /// Most blocks of a drawing are of one colour, so each distinct block is encoded once.
    pub(crate) fn encode(image: &Image) -> Self {
        let mut known: BTreeMap<[u8; BLOCK_RGBA], usize> = BTreeMap::new();
        let mut distinct: Vec<[u8; BLOCK_RGBA]> = Vec::new();
        let levels: Vec<Vec<usize>> = (0..)
            .zip(image.mips.iter())
            .map(|(level, texels)| {
                let number = |block| {
                    *known.entry(block).or_insert_with(|| {
                        distinct.push(block);
                        distinct.len() - 1
                    })
                };
                let size = level_size(image.size, level);
                blocks(texels, size).map(number).collect()
            })
            .collect();
        let encoded: Vec<[u8; BLOCK_BYTES as usize]> =
            distinct.par_chunks(TASK).flat_map_iter(encode).collect();
        let bytes = |level: Vec<usize>| level.into_iter().flat_map(|i| encoded[i]).collect();
        Self {
            size: image.size,
            levels: levels.into_iter().map(bytes).collect(),
        }
    }

    /// The texture whose longer side is `BC7_SIZES[first]`: the levels from `first` on.
    pub(crate) fn levels(&self, first: usize) -> &[Vec<u8>] {
        &self.levels[first.min(self.levels.len())..]
    }

    /// Bytes of those levels on the GPU.
    pub(crate) fn bytes(&self, first: usize) -> usize {
        self.levels(first).iter().map(Vec::len).sum()
    }

    /// Those levels as an sRGB texture behind the sampler of the RGBA8 raster.
    pub(crate) fn kernel(&self, device: &Device, first: usize) -> Kernel {
        let shift = u32::try_from(first).unwrap_or(0);
        let blocks = TexelBlocks {
            format: wgpu::TextureFormat::Bc7RgbaUnormSrgb,
            side: BLOCK,
            bytes: BLOCK_BYTES,
        };
        let size = level_size(self.size, shift);
        texture_kernel(device, blocks, size, self.levels(first))
    }
}

/// Blocks of a level row by row; beyond its edge the last texels repeat.
fn blocks(texels: &[u8], size: [u32; 2]) -> impl Iterator<Item = [u8; BLOCK_RGBA]> {
    let [width, height] = size.map(|side| side as usize);
    let side = BLOCK as usize;
    let rows = 0..height.div_ceil(side);
    let corners =
        rows.flat_map(move |y| (0..width.div_ceil(side)).map(move |x| [x * side, y * side]));
    corners.map(move |[x, y]| {
        let mut block = [0; BLOCK_RGBA];
        for (i, texel) in block.as_chunks_mut::<4>().0.iter_mut().enumerate() {
            let column = (x + i % side).min(width - 1);
            let row = (y + i / side).min(height - 1);
            let at = 4 * (row * width + column);
            texel.copy_from_slice(&texels[at..at + 4]);
        }
        block
    })
}

/// Blocks one below the other are an image of four columns, as they lie in memory.
fn encode(texels: &[[u8; BLOCK_RGBA]]) -> Vec<[u8; BLOCK_BYTES as usize]> {
    let mut encoded = vec![[0; BLOCK_BYTES as usize]; texels.len()];
    let height = u32::try_from(texels.len()).unwrap_or(0) * BLOCK;
    compress_rgba8(
        CompressionVariant::BC7(BC7Settings::alpha_fast()),
        texels.as_flattened(),
        encoded.as_flattened_mut(),
        BLOCK,
        height,
        4 * BLOCK,
    );
    encoded
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use block_compression::decode::decompress_blocks_as_rgba8;

    use super::*;
    use crate::subject::{parse, rasterise_in_blocks, read, svg_files, system_fonts};

    /// Peak signal-to-noise ratio of all four channels, in dB.
    fn psnr(a: &[u8], b: &[u8]) -> f64 {
        let squares = a
            .iter()
            .zip(b)
            .map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2));
        let mean = squares.sum::<f64>() / a.len() as f64;
        10.0 * (255.0 * 255.0 / mean).log10()
    }

    #[test]
    fn the_paper_samples_survive() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/svg/paper");
        let files = svg_files(&folder);
        assert!(!files.is_empty());
        for path in files {
            let tree = parse(&read(&path).unwrap(), &system_fonts()).unwrap();
            let image = rasterise_in_blocks(&tree, 1024, BC7_SIDE_MULTIPLE).unwrap();
            let bc7 = Bc7::encode(&image);
            assert_eq!(bc7.levels.len(), image.mips.len());
            for (level, (blocks, texels)) in (0..).zip(bc7.levels.iter().zip(image.mips.iter())) {
                let [width, height] = level_size(image.size, level);
                // The decoder writes whole blocks.
                if width % BLOCK != 0 || height % BLOCK != 0 {
                    continue;
                }
                let mut decoded = vec![0; texels.len()];
                let variant = CompressionVariant::BC7(BC7Settings::alpha_fast());
                decompress_blocks_as_rgba8(variant, width, height, blocks, &mut decoded);
                let psnr = psnr(texels, &decoded);
                // In coarser levels many blocks hold more colours than BC7 can.
                let least = [50.0, 48.0, 40.0, 35.0, 30.0];
                let least = *least.get(level as usize).unwrap_or(&22.0);
                assert!(psnr > least, "{} {level}: {psnr:.1} dB", path.display());
            }
        }
    }

    #[test]
    fn the_edge_repeats() {
        let texels: Vec<u8> = (0..5).flat_map(|x| [x; 4]).collect();
        let blocks: Vec<_> = blocks(&texels, [5, 1]).collect();
        assert_eq!(blocks.len(), 2);
        assert_eq!(blocks[0][..16], blocks[0][48..]);
        assert_eq!(blocks[0][..8], [0, 0, 0, 0, 1, 1, 1, 1]);
        assert_eq!(blocks[1], [4; 64]);
    }
}
