//! The truth: resvg with crisp edges, supersampled, averaged in linear light.
//!
//! **Crisp edges.** resvg draws the SVG about 16 times as fine as wanted, with anti-aliasing off, so
//! that every fine pixel is an exact point sample at its centre. resvg's own anti-aliasing would be
//! no truth: it blends sRGB-encoded colours, and its coverage comes from four rows in
//! a pixel.
//!
//! **Supersampling.** The samples of a pixel are averaged in linear light, premultiplied. They lie
//! on a turned grid (`sample_pattern.rs`), 257 in a pixel: with an upright grid of 16 x 16 a
//! vertical edge has only 16 different places in a pixel, and next to black a step from one to the
//! next is up to 50 of 255 sRGB codes. Filters, patterns and images depend on the axes, so drawings
//! that have some are drawn upright, with 256 samples.
//!
//! **Scale.** uv \[0, 1\] maps exactly to the picture's edges in both directions, even where the
//! proportions of the picture are not quite those of the canvas because its size is whole pixels.
//!
//! **Strokes** of plain drawings are expanded at the scale of the picture (`plain.rs`).

mod plain;
mod sample_pattern;
mod strokes;

use std::sync::Arc;

use rayon::prelude::*;
use resvg::tiny_skia::{Pixmap, Transform};
use usvg::fontdb;

use crate::picture::{Picture, View};
use crate::{TruthError, srgb};
use plain::{Outlines, PlainPaths};
use sample_pattern::SamplePattern;

/// Samples along each side of a pixel in [`Reference::render`].
pub const SUPERSAMPLES: u32 = 16;
/// Fine pixels along a tile's side, roughly. A picture is drawn in tiles of 16 MiB, so that its size
/// does not decide how much memory a thread needs.
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
    /// The same drawing, if it consists of paths in solid colours only.
    plain: Option<PlainPaths>,
    /// Whether the drawing looks the same when it is drawn turned.
    turns: bool,
}

impl Reference {
    /// Parses an SVG (or gzipped SVG). Outside images are not loaded.
    ///
    /// # Errors
    /// usvg's message, when it is not an SVG. The caller knows the name of the file.
    pub fn parse(svg: &[u8], fonts: Arc<fontdb::Database>, edges: Edges) -> Result<Self, String> {
        let mut options = usvg::Options {
            fontdb: fonts,
            // As in a bake, and in browsers.
            font_size: 16.0,
            ..usvg::Options::default()
        };
        if edges == Edges::Crisp {
            options.shape_rendering = usvg::ShapeRendering::CrispEdges;
            options.text_rendering = usvg::TextRendering::OptimizeSpeed;
        }
        // usvg's own resolver would read any local file that the SVG names.
        options.image_href_resolver.resolve_string = Box::new(|_, _| None);
        // The same faces as a bake chooses; with others, glyphs would differ.
        options.font_resolver.select_font = vtex_baker::font_selector();
        // Styles that usvg does not know are those of the bake; docs/decisions/0028 says who checks them.
        let text =
            vtex_baker::styled_text(svg, &options.fontdb).map_err(|error| error.to_string())?;
        let tree = usvg::Tree::from_str(&text, &options).map_err(|error| error.to_string())?;
        let plain = match edges {
            Edges::Crisp => PlainPaths::new(&tree),
            Edges::Smooth => None,
        };
        let turns = turns(&tree);
        Ok(Self { tree, plain, turns })
    }

    /// Width and height of the canvas in user units.
    pub fn canvas_size(&self) -> [f64; 2] {
        let size = self.tree.size();
        [f64::from(size.width()), f64::from(size.height())]
    }

    /// `view` at `size_px`, about [`SUPERSAMPLES`] squared point samples a pixel.
    ///
    /// # Errors
    /// When a tile cannot be allocated.
    pub fn render(&self, view: View, size_px: [u32; 2]) -> Result<Picture, TruthError> {
        self.render_with(view, size_px, SUPERSAMPLES)
    }

    /// As [`Self::render`] with `samples` samples along each side of a pixel.
    ///
    /// # Errors
    /// When a tile cannot be allocated.
    pub fn render_with(
        &self,
        view: View,
        size_px: [u32; 2],
        samples: u32,
    ) -> Result<Picture, TruthError> {
        let pattern = SamplePattern::new(samples, self.turns);
        let side_px = (TILE_FINE_PX / samples).max(1);
        let [columns, rows] = size_px.map(|side| side.div_ceil(side_px));
        let table = srgb::decode_table();
        let outlines = self.outlines(view, size_px, &pattern);
        let tiles = (0..columns * rows)
            .into_par_iter()
            .map(|tile| {
                let origin_px = [tile % columns * side_px, tile / columns * side_px];
                let tile_px = [0, 1].map(|axis| side_px.min(size_px[axis] - origin_px[axis]));
                let fine = self.draw(
                    outlines.as_ref(),
                    view,
                    size_px,
                    origin_px,
                    tile_px,
                    &pattern,
                )?;
                Ok((
                    origin_px,
                    tile_px,
                    average(&fine, tile_px, &pattern, &table),
                ))
            })
            .collect::<Result<Vec<_>, TruthError>>()?;
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
    pub fn rasterize(&self, size_px: [u32; 2]) -> Result<Pixmap, TruthError> {
        let upright = SamplePattern::new(1, false);
        self.draw(None, View::WHOLE, size_px, [0, 0], size_px, &upright)
    }

    /// The plain paths in fine pixels of the picture; `None` where resvg has to draw.
    fn outlines(&self, view: View, size_px: [u32; 2], pattern: &SamplePattern) -> Option<Outlines> {
        let plain = self.plain.as_ref()?;
        let affine = self.fine_from_canvas(view, size_px, [0, 0], size_px, pattern);
        let size = pattern.fine_size(size_px).map(f64::from);
        Some(plain.outlines(kurbo::Affine::new(affine), size))
    }

    /// Coefficients `a b c d e f` of the map from the canvas to fine pixels of a tile.
    fn fine_from_canvas(
        &self,
        view: View,
        size_px: [u32; 2],
        origin_px: [u32; 2],
        tile_px: [u32; 2],
        pattern: &SamplePattern,
    ) -> [f64; 6] {
        let canvas = self.canvas_size();
        let extent = view.extent();
        let corner = [view.u0, view.v0];
        let size = size_px.map(f64::from);
        // From the canvas to pixels of the tile, along each axis.
        let scale = [0, 1].map(|axis| size[axis] / (canvas[axis] * extent[axis]));
        let shift = [0, 1]
            .map(|axis| -corner[axis] / extent[axis] * size[axis] - f64::from(origin_px[axis]));
        let [along_x, along_y] = [[scale[0], 0.0], [0.0, scale[1]]].map(|v| pattern.turn(v));
        let [e, f] = pattern.fine_from_px(shift, tile_px);
        [along_x[0], along_x[1], along_y[0], along_y[1], e, f]
    }

    fn draw(
        &self,
        outlines: Option<&Outlines>,
        view: View,
        size_px: [u32; 2],
        origin_px: [u32; 2],
        tile_px: [u32; 2],
        pattern: &SamplePattern,
    ) -> Result<Pixmap, TruthError> {
        let [width, height] = pattern.fine_size(tile_px);
        let mut pixmap = Pixmap::new(width, height).ok_or(TruthError::Memory)?;
        if let Some(outlines) = outlines {
            let corner = pattern.fine_corner(origin_px, size_px, tile_px);
            outlines.paint(corner, &mut pixmap.as_mut());
        } else {
            let affine = self.fine_from_canvas(view, size_px, origin_px, tile_px, pattern);
            let [a, b, c, d, e, f] = affine.map(narrow);
            let transform = Transform::from_row(a, b, c, d, e, f);
            resvg::render(&self.tree, transform, &mut pixmap.as_mut());
        }
        Ok(pixmap)
    }
}

/// Whether `tree` looks the same when resvg draws it turned by some degrees. Filters, patterns and
/// images do not: resvg works along the axes of the picture or resamples there.
fn turns(tree: &usvg::Tree) -> bool {
    tree.filters().is_empty() && tree.patterns().is_empty() && !holds_image(tree.root())
}

fn holds_image(group: &usvg::Group) -> bool {
    group.children().iter().any(|node| {
        let mut inside = matches!(node, usvg::Node::Image(_));
        if let usvg::Node::Group(group) = node {
            inside |= holds_image(group);
        }
        node.subroots(|group| inside |= holds_image(group));
        inside
    })
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "tiny-skia's transforms are f32"
)]
fn narrow(value: f64) -> f32 {
    value as f32
}

/// Linear-light premultiplied averages over the samples of each pixel of a tile.
fn average(
    fine: &Pixmap,
    tile_px: [u32; 2],
    pattern: &SamplePattern,
    table: &[f32; 256],
) -> Vec<[f32; 4]> {
    let width = fine.width() as usize;
    let texels = fine.data().as_chunks::<4>().0;
    let mut pixels = Vec::with_capacity(tile_px[0] as usize * tile_px[1] as usize);
    for y in 0..tile_px[1] {
        for x in 0..tile_px[0] {
            let mut sum = [0.0_f32; 4];
            for (row, columns) in pattern.samples_of([x, y], tile_px) {
                let start = row * width;
                for texel in &texels[start + columns.start..start + columns.end] {
                    let linear = linear_premultiplied(*texel, table);
                    sum = std::array::from_fn(|c| sum[c] + linear[c]);
                }
            }
            pixels.push(sum.map(|channel| channel / pattern.sample_count() as f32));
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
    fn coverage_is_right_to_a_257th_along_both_axes() {
        for share in [0.02, 0.1, 0.31, 0.5, 0.97] {
            let upright = format!("M0 0H{}V9H0z", 1.0 + share);
            let level = format!("M0 0V{}H9V0z", 1.0 + share);
            for (path, edge, inside, outside) in [(upright, 9, 8, 10), (level, 9, 1, 17)] {
                let svg = format!(
                    "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'>\
                     <path d='{path}' fill='#fff'/></svg>"
                );
                let picture = parse(&svg).render(View::WHOLE, [8, 8]).unwrap();
                assert_eq!(picture.pixels[inside], [1.0; 4]);
                assert_eq!(picture.pixels[outside], [0.0; 4]);
                let found = picture.pixels[edge][3];
                assert!(
                    (found - share).abs() <= 1.0 / 257.0,
                    "{path}: {found} {share}"
                );
            }
        }
    }

    #[test]
    fn what_does_not_turn_is_drawn_upright() {
        let svg = |content: &str| {
            format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'>{content}</svg>")
        };
        let shape = "<path d='M0 0H4V4z' filter='url(#f)'/>";
        let filter = "<filter id='f'><feOffset dx='1'/></filter>";
        assert!(parse(&svg(shape)).turns);
        assert!(!parse(&svg(&format!("{filter}{shape}"))).turns);
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
