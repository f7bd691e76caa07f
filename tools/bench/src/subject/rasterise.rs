//! How the raster texture that a vector texture replaces is made: resvg at an exact scale, then a
//! mip chain of linear-light averages.

use std::sync::Arc;

use anyhow::{Context as _, Result};
use resvg::tiny_skia::{Pixmap, PremultipliedColorU8, Transform};
use resvg::usvg;
use vtex_baker::Resources;
use vtex_format::Image;
use vtex_shaders::srgb;

/// Steps of the table that encodes linear light; a step is at most a twentieth of a byte's.
const ENCODE_STEPS: usize = 1 << 16;

/// The canvas with `longer_side` texels along its longer side, its levels as a file has them.
pub(crate) fn rasterise(svg: &[u8], resources: &Resources, longer_side: u32) -> Result<Image> {
    let tree = parse(svg, resources)?;
    let pixmap = render(&tree, longer_side)?;
    let size = [pixmap.width(), pixmap.height()];
    let levels = (0..Image::level_count(size)).map(|level| Image::level_size(size, level));
    Ok(with_mips(&pixmap, levels))
}

/// As [`rasterise`], with levels as graphics cards have them and both sides rounded to a multiple of
/// `multiple`: the drawing is stretched by less than that many texels.
pub(crate) fn rasterise_in_blocks(
    tree: &usvg::Tree,
    longer_side: u32,
    multiple: u32,
) -> Result<Image> {
    let size = size_for(tree, longer_side)
        .map(|side| (side + multiple / 2).max(multiple) / multiple * multiple);
    let levels = (0..level_count(size)).map(|level| level_size(size, level));
    Ok(with_mips(&render_at(tree, size)?, levels))
}

/// Parses the SVG as resvg does, with the fonts that a bake chooses and without outside images.
pub(crate) fn parse(svg: &[u8], resources: &Resources) -> Result<usvg::Tree> {
    let image_href_resolver = usvg::ImageHrefResolver {
        resolve_string: Box::new(|_, _| None),
        ..usvg::ImageHrefResolver::default()
    };
    let mut options = usvg::Options {
        fontdb: resources.fonts.clone(),
        image_href_resolver,
        ..usvg::Options::default()
    };
    options.font_resolver.select_font = vtex_baker::font_selector();
    Ok(usvg::Tree::from_data(svg, &options)?)
}

/// The picture with `longer_side` texels along its longer side.
pub(crate) fn render(tree: &usvg::Tree, longer_side: u32) -> Result<Pixmap> {
    let canvas = tree.size();
    let scale = longer_side as f32 / canvas.width().max(canvas.height());
    draw(tree, size_for(tree, longer_side), [scale, scale])
}

/// The picture stretched to `size`.
fn render_at(tree: &usvg::Tree, size: [u32; 2]) -> Result<Pixmap> {
    let canvas = [tree.size().width(), tree.size().height()];
    draw(
        tree,
        size,
        [0, 1].map(|axis| size[axis] as f32 / canvas[axis]),
    )
}

fn draw(tree: &usvg::Tree, size: [u32; 2], [x, y]: [f32; 2]) -> Result<Pixmap> {
    let mut pixmap = Pixmap::new(size[0], size[1]).context("no room for the raster")?;
    resvg::render(tree, Transform::from_scale(x, y), &mut pixmap.as_mut());
    Ok(pixmap)
}

fn size_for(tree: &usvg::Tree, longer_side: u32) -> [u32; 2] {
    let canvas = tree.size();
    let scale = longer_side as f32 / canvas.width().max(canvas.height());
    [canvas.width(), canvas.height()].map(|side| texels(side * scale))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturates"
)]
fn texels(side: f32) -> u32 {
    (side.round() as u32).max(1)
}

/// Texels of a level of a texture: graphics cards round down, where files round up.
pub(crate) fn level_size(size: [u32; 2], level: u32) -> [u32; 2] {
    size.map(|side| side.checked_shr(level).unwrap_or(0).max(1))
}

/// Levels of a texture down to one texel.
pub(crate) fn level_count(size: [u32; 2]) -> u32 {
    size[0].max(size[1]).max(1).ilog2() + 1
}

/// `levels`: the size of each, the finest first.
fn with_mips(pixmap: &Pixmap, levels: impl Iterator<Item = [u32; 2]>) -> Image {
    let size = [pixmap.width(), pixmap.height()];
    let transfer = Transfer::new();
    let mut mips: Vec<Vec<u8>> = vec![
        pixmap
            .pixels()
            .iter()
            .flat_map(|&pixel| transfer.texel(pixel))
            .collect(),
    ];
    let mut from = size.map(|side| side as usize);
    for to in levels.skip(1).map(|level| level.map(|side| side as usize)) {
        let finer = mips.last().map_or(&[][..], Vec::as_slice);
        mips.push(transfer.halved(finer, from, to));
        from = to;
    }
    Image {
        rect_uv: [0.0, 0.0, 1.0, 1.0],
        size,
        mips: Arc::new(mips),
    }
}

/// Both directions of the sRGB transfer function as tables.
struct Transfer {
    decode: [f32; 256],
    encode: Vec<u8>,
}

impl Transfer {
    fn new() -> Self {
        let encode = |step: usize| {
            let linear = step as f32 / (ENCODE_STEPS - 1) as f32;
            byte(srgb::encode(linear))
        };
        Self {
            decode: srgb::decode_table(),
            encode: (0..ENCODE_STEPS).map(encode).collect(),
        }
    }

    /// Premultiplied in linear light instead of encoded.
    fn texel(&self, pixel: PremultipliedColorU8) -> [u8; 4] {
        match pixel.alpha() {
            0 => [0; 4],
            u8::MAX => [pixel.red(), pixel.green(), pixel.blue(), u8::MAX],
            alpha => {
                let straight = pixel.demultiply();
                let color = [straight.red(), straight.green(), straight.blue()];
                let opacity = f32::from(alpha) / 255.0;
                let [r, g, b] =
                    color.map(|code| self.encoded(self.decode[usize::from(code)] * opacity));
                [r, g, b, alpha]
            }
        }
    }

    fn encoded(&self, linear: f32) -> u8 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "in 0..=1"
        )]
        let step = (linear * (ENCODE_STEPS - 1) as f32 + 0.5) as usize;
        self.encode[step.min(ENCODE_STEPS - 1)]
    }

    /// Means of 2 x 2 texels; a side of one texel is repeated.
    fn halved(&self, finer: &[u8], from: [usize; 2], to: [usize; 2]) -> Vec<u8> {
        let mut coarser = Vec::with_capacity(4 * to[0] * to[1]);
        for y in 0..to[1] {
            let rows = [2 * y, (2 * y + 1).min(from[1] - 1)].map(|y| 4 * y * from[0]);
            for x in 0..to[0] {
                let columns = [2 * x, (2 * x + 1).min(from[0] - 1)].map(|x| 4 * x);
                let at = |channel: usize| {
                    rows.map(|row| columns.map(|column| finer[row + column + channel]))
                };
                let mean = |channel: usize| {
                    let linear = |code: u8| self.decode[usize::from(code)];
                    at(channel)
                        .as_flattened()
                        .iter()
                        .copied()
                        .map(linear)
                        .sum::<f32>()
                        / 4.0
                };
                coarser.extend([0, 1, 2].map(|channel| self.encoded(mean(channel))));
                let alpha = at(3)
                    .as_flattened()
                    .iter()
                    .map(|&a| f32::from(a))
                    .sum::<f32>();
                coarser.push(byte(alpha / 4.0 / 255.0));
            }
        }
        coarser
    }
}

/// From [0, 1].
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturates"
)]
fn byte(value: f32) -> u8 {
    (value * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averages_are_of_linear_light() {
        let svg = br##"<svg xmlns="http://www.w3.org/2000/svg" width="4" height="2">
            <rect width="1" height="2" fill="#fff"/><rect x="1" width="1" height="2"/>
            <rect x="2" width="1" height="2" fill="#fff"/></svg>"##;
        let image = rasterise(svg, &Resources::default(), 4).unwrap();
        assert_eq!((image.size, image.mips.len()), ([4, 2], 3));
        // Half white, half black is 188, not 128; half white, half nothing the same at half alpha.
        assert_eq!(image.mips[1], [188, 188, 188, 255, 188, 188, 188, 128]);
        assert_eq!(image.mips[2], [188, 188, 188, 192]);
    }
}
