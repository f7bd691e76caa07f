//! The truth: resvg with crisp edges, supersampled, averaged in linear light.
//!
//! resvg draws the SVG at 16 times the wanted size in both directions with anti-aliasing off, so
//! every fine pixel is an exact point sample at its centre; the 256 of a pixel are averaged in
//! linear light, premultiplied. The scale is exact: uv \[0, 1\] maps to the picture's edges in
//! both directions, whatever the rounding of the canvas' size to whole pixels.

use std::sync::Arc;

use rayon::prelude::*;
use resvg::tiny_skia::{Pixmap, Transform};
use usvg::fontdb;

use crate::failure::{Failure, Outcome};
use crate::picture::{Picture, View};
use crate::srgb;

/// Samples a pixel's side has in [`Reference::render`].
pub const SUPERSAMPLES: u32 = 16;
/// Fine pixels a tile's side has: 16 MiB a tile, whatever the picture's size.
const TILE_FINE_PX: u32 = 2048;

/// Edges in the rendering of [`Reference`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    /// Point samples.
    Crisp,
    /// resvg's own anti-aliasing.
    Smooth,
}

/// A parsed SVG that can be drawn at any zoom.
#[derive(Debug)]
pub struct Reference {
    tree: usvg::Tree,
}

impl Reference {
    /// Parses an SVG (or gzipped SVG). Outside images are not loaded.
    ///
    /// # Errors
    /// When it is not an SVG; the message is usvg's, the caller names the file.
    pub fn parse(svg: &[u8], fonts: Arc<fontdb::Database>, edges: Edges) -> Result<Self, String> {
        let mut options = usvg::Options {
            fontdb: fonts,
            ..usvg::Options::default()
        };
        if edges == Edges::Crisp {
            options.shape_rendering = usvg::ShapeRendering::CrispEdges;
            options.text_rendering = usvg::TextRendering::OptimizeSpeed;
        }
        // usvg's own resolver reads any local file an SVG names.
        options.image_href_resolver.resolve_string = Box::new(|_, _| None);
        // Glyphs of another face would be compared otherwise.
        options.font_resolver.select_font = vtex_baker::font_selector();
        let tree = usvg::Tree::from_data(svg, &options).map_err(|error| error.to_string())?;
        Ok(Self { tree })
    }

    /// Width and height of the canvas in user units.
    pub fn canvas_size(&self) -> [f64; 2] {
        let size = self.tree.size();
        [f64::from(size.width()), f64::from(size.height())]
    }

    /// `view` at `size_px`, [`SUPERSAMPLES`] squared point samples a pixel.
    ///
    /// # Errors
    /// When a tile cannot be allocated.
    pub fn render(&self, view: View, size_px: [u32; 2]) -> Outcome<Picture> {
        self.render_with(view, size_px, SUPERSAMPLES)
    }

    /// As [`Self::render`] with `samples` samples along each side of a pixel.
    ///
    /// # Errors
    /// When a tile cannot be allocated.
    pub fn render_with(&self, view: View, size_px: [u32; 2], samples: u32) -> Outcome<Picture> {
        let side_px = (TILE_FINE_PX / samples).max(1);
        let [columns, rows] = size_px.map(|side| side.div_ceil(side_px));
        let table = srgb::decode_table();
        let tiles = (0..columns * rows)
            .into_par_iter()
            .map(|tile| {
                let origin_px = [tile % columns * side_px, tile / columns * side_px];
                let tile_px = [0, 1].map(|axis| side_px.min(size_px[axis] - origin_px[axis]));
                let fine = self.draw(view, size_px, origin_px, tile_px, samples)?;
                Ok((origin_px, tile_px, average(&fine, tile_px, samples, &table)))
            })
            .collect::<Outcome<Vec<_>>>()?;
        let mut pixels = vec![[0.0; 4]; size_px[0] as usize * size_px[1] as usize];
        for (origin_px, tile_px, tile) in tiles {
            for (row, source) in (origin_px[1]..).zip(tile.chunks_exact(tile_px[0] as usize)) {
                let start = row as usize * size_px[0] as usize + origin_px[0] as usize;
                pixels[start..start + source.len()].copy_from_slice(source);
            }
        }
        Ok(Picture { size_px, pixels })
    }

    /// The whole canvas at `size_px` as premultiplied sRGB bytes, as an importer would draw it.
    ///
    /// # Errors
    /// When the pixels cannot be allocated.
    pub fn rasterize(&self, size_px: [u32; 2]) -> Outcome<Pixmap> {
        self.draw(View::WHOLE, size_px, [0, 0], size_px, 1)
    }

    fn draw(
        &self,
        view: View,
        size_px: [u32; 2],
        origin_px: [u32; 2],
        tile_px: [u32; 2],
        samples: u32,
    ) -> Outcome<Pixmap> {
        let canvas = self.canvas_size();
        let extent = view.extent();
        let corner = [view.u0, view.v0];
        let fine = |axis: usize| f64::from(size_px[axis] * samples);
        let scale = [0, 1].map(|axis| fine(axis) / (canvas[axis] * extent[axis]));
        let shift = [0, 1].map(|axis| {
            -corner[axis] / extent[axis] * fine(axis) - f64::from(origin_px[axis] * samples)
        });
        let mut pixmap = Pixmap::new(tile_px[0] * samples, tile_px[1] * samples)
            .ok_or_else(|| Failure::runtime("cannot allocate the reference picture"))?;
        let [sx, sy, tx, ty] = [scale[0], scale[1], shift[0], shift[1]].map(narrow);
        resvg::render(
            &self.tree,
            Transform::from_row(sx, 0.0, 0.0, sy, tx, ty),
            &mut pixmap.as_mut(),
        );
        Ok(pixmap)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "tiny-skia's transforms are f32"
)]
fn narrow(value: f64) -> f32 {
    value as f32
}

/// Linear-light premultiplied averages over blocks of `samples` squared fine pixels.
fn average(fine: &Pixmap, size_px: [u32; 2], samples: u32, table: &[f32; 256]) -> Vec<[f32; 4]> {
    let width = fine.width() as usize;
    let samples = samples as usize;
    let mut pixels = Vec::with_capacity(size_px[0] as usize * size_px[1] as usize);
    for y in 0..size_px[1] as usize {
        for x in 0..size_px[0] as usize {
            let mut sum = [0.0_f32; 4];
            for row in 0..samples {
                let start = (y * samples + row) * width + x * samples;
                for texel in &fine.data().as_chunks::<4>().0[start..start + samples] {
                    let linear = linear_premultiplied(*texel, table);
                    sum = std::array::from_fn(|c| sum[c] + linear[c]);
                }
            }
            let count = (samples * samples) as f32;
            pixels.push(sum.map(|channel| channel / count));
        }
    }
    pixels
}

/// A premultiplied sRGB texel as linear light, premultiplied.
fn linear_premultiplied([r, g, b, a]: [u8; 4], table: &[f32; 256]) -> [f32; 4] {
    match a {
        0 => [0.0; 4],
        255 => [
            table[usize::from(r)],
            table[usize::from(g)],
            table[usize::from(b)],
            1.0,
        ],
        _ => {
            let alpha = f32::from(a) / 255.0;
            let [r, g, b] =
                [r, g, b].map(|c| srgb::decode((f32::from(c) / f32::from(a)).min(1.0)) * alpha);
            [r, g, b, alpha]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(svg: &str) -> Reference {
        Reference::parse(svg.as_bytes(), Arc::default(), Edges::Crisp).unwrap()
    }

    #[test]
    fn half_covered_pixel_is_half_in_linear_light() {
        let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 4 4'>\
                   <path d='M0 0H1.5V4H0z' fill='#fff'/></svg>";
        let picture = parse(svg).render(View::WHOLE, [4, 4]).unwrap();
        assert_eq!(picture.pixels[0], [1.0; 4]);
        assert_eq!(picture.pixels[1], [0.5; 4]);
        assert_eq!(picture.pixels[2], [0.0; 4]);
    }

    #[test]
    fn tiles_and_windows_agree_with_the_whole() {
        let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 300 200'>\
                   <circle cx='140' cy='90' r='70' fill='#d03020' fill-opacity='.5'/></svg>";
        let reference = parse(svg);
        // 300 px at 16 samples are three tiles across.
        let whole = reference.render(View::WHOLE, [300, 200]).unwrap();
        let view = View {
            u0: 0.5,
            v0: 0.25,
            u1: 1.0,
            v1: 0.75,
        };
        let part = reference.render(view, [150, 100]).unwrap();
        for y in 0..100 {
            for x in 0..150 {
                let [a, b] = [
                    whole.pixels[(y + 50) * 300 + x + 150],
                    part.pixels[y * 150 + x],
                ];
                // tiny-skia flattens curves to an eighth of a fine pixel, and differently in each
                // tile: an edge along a row of samples may take half a row with it.
                let close = a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 8.0 / 256.0);
                assert!(close, "{x} {y}: {a:?} {b:?}");
            }
        }
    }
}
