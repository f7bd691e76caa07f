//! The drawing: items in painter's order and the tree of groups that holds them.
//!
//! All coordinates are in canvas space: SVG user units, origin top left, y down. The canvas is
//! `[0, width] x [0, height]`; items may reach beyond it.

pub(crate) mod color;
pub(crate) mod paint;
pub(crate) mod tree;

use kurbo::{BezPath, Rect};
use vtex_format::{Image, Warning};

use crate::number::{count, to_f32};

pub(crate) use paint::Paint;

use tree::Tree;

/// A whole drawing, back to front.
#[derive(Debug)]
pub(crate) struct Drawing {
    /// Width and height of the canvas in user units.
    pub(crate) canvas_size: [f64; 2],
    /// Back to front.
    pub(crate) items: Vec<Item>,
    /// The groups that hold them.
    pub(crate) tree: Tree,
    /// What was approximated or left out.
    pub(crate) warnings: Vec<Warning>,
}

impl Drawing {
    /// Length of the canvas' longer side.
    pub(crate) fn longer_side(&self) -> f64 {
        self.canvas_size[0].max(self.canvas_size[1])
    }

    /// Items without groups.
    #[cfg(test)]
    pub(crate) fn ungrouped(canvas_size: [f64; 2], items: Vec<Item>) -> Self {
        Self {
            canvas_size,
            tree: Tree::ungrouped(items.len()),
            items,
            warnings: Vec::new(),
        }
    }
}

/// One element of the drawing.
#[derive(Debug)]
pub(crate) enum Item {
    /// Geometry with a paint.
    Shape(Shape),
    /// A raster image: a patch or an embedded image.
    Image(ImageItem),
    /// An outline that clips a group. It paints nothing itself.
    Clip(ClipOutline),
}

/// An outline that clips a group.
#[derive(Debug)]
pub(crate) struct ClipOutline {
    /// Closed contours.
    pub(crate) outline: BezPath,
    /// Its fill rule.
    pub(crate) rule: FillRule,
}

/// One outline filled with one paint. A stroke is a shape too: the walk has expanded it.
#[derive(Debug)]
pub(crate) struct Shape {
    /// Closed contours.
    pub(crate) outline: BezPath,
    /// Its fill rule.
    pub(crate) fill_rule: FillRule,
    /// What fills it, with every opacity folded in.
    pub(crate) paint: Paint,
    /// Which half of an SVG path it comes from.
    pub(crate) source: ShapeSource,
    /// `id` of the element or of its nearest ancestor that has one; may be empty.
    pub(crate) element: String,
}

/// Which half of an SVG path a shape is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShapeSource {
    /// Its interior.
    Fill,
    /// Its expanded stroke.
    Stroke,
}

/// Fill rule, SVG 2 sec. 13.3.2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FillRule {
    /// Inside where the winding is not zero.
    NonZero,
    /// Inside where the winding is odd.
    EvenOdd,
}

impl FillRule {
    /// Whether a point of this winding is inside, SVG 2 sec. 13.3.2.
    pub(crate) fn fills(self, winding: i32) -> bool {
        match self {
            Self::NonZero => winding != 0,
            Self::EvenOdd => winding % 2 != 0,
        }
    }
}

/// A raster image at its place in painter's order: a subtree that is not geometry, a shape that is
/// too complex, or an embedded image with its own texels.
#[derive(Debug)]
pub(crate) struct ImageItem {
    /// Where it lies on the canvas.
    pub(crate) rect: Rect,
    /// Its texels and mips.
    pub(crate) image: Image,
    /// Why it is not geometry, such as `filter`.
    pub(crate) feature: String,
    /// `id` of the element; may be empty.
    pub(crate) element: String,
}

impl ImageItem {
    /// Share of the canvas that it covers: only texels with alpha above 0 count.
    pub(crate) fn area(&self, canvas_size: [f64; 2]) -> f32 {
        let texels = self.image.mips.first().map_or(&[][..], |level| level);
        let alphas = texels.iter().skip(3).step_by(4);
        let clear = alphas.filter(|&&alpha| alpha == 0).count();
        let shown = 1.0 - count(clear) / count((texels.len() / 4).max(1));
        to_f32(shown * self.rect.area() / (canvas_size[0] * canvas_size[1])).clamp(0.0, 1.0)
    }
}
