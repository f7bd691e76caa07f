//! The drawing as the baker sees it: shapes and patches in painter's order, in canvas space
//! (SVG user units, origin top left, y down, the canvas being `[0, width] x [0, height]`).

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
    /// Width and height of the canvas.
    pub(crate) canvas_size: [f64; 2],
    /// Back to front.
    pub(crate) items: Vec<Item>,
    /// How they belong together.
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
    pub(crate) fn flat(canvas_size: [f64; 2], items: Vec<Item>) -> Self {
        Self {
            canvas_size,
            tree: Tree::flat(items.len()),
            items,
            warnings: Vec::new(),
        }
    }
}

/// One thing painted, or what limits others.
#[derive(Debug)]
pub(crate) enum Item {
    /// Geometry with a paint.
    Shape(Shape),
    /// A subtree that is not yet geometry.
    Patch(Patch),
    /// Shows nothing: where a group may show.
    Clip(ClipOutline),
}

/// An outline that a group is clipped to.
#[derive(Debug)]
pub(crate) struct ClipOutline {
    /// Closed contours.
    pub(crate) outline: BezPath,
    /// Inside test.
    pub(crate) rule: FillRule,
}

/// A filled region with one paint. Strokes arrive here already expanded.
#[derive(Debug)]
pub(crate) struct Shape {
    /// Closed contours.
    pub(crate) outline: BezPath,
    /// Inside test.
    pub(crate) fill_rule: FillRule,
    /// What fills it, every opacity folded in.
    pub(crate) paint: Paint,
    /// Where it comes from.
    pub(crate) source: ShapeSource,
    /// `id` of the element or its nearest named ancestor, may be empty.
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

/// Inside test, SVG 2 sec. 13.3.2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FillRule {
    /// Winding not zero.
    NonZero,
    /// Winding odd.
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

/// A subtree as a raster image at its place in the painter's order.
#[derive(Debug)]
pub(crate) struct Patch {
    /// Where it lies on the canvas.
    pub(crate) rect: Rect,
    /// Its texels and mips.
    pub(crate) image: Image,
    /// Why it is not geometry, such as `linearGradient`.
    pub(crate) feature: String,
    /// `id` of the element, may be empty.
    pub(crate) element: String,
}

impl Patch {
    /// Share of the canvas where it shows something: texels with alpha above 0.
    pub(crate) fn area(&self, canvas_size: [f64; 2]) -> f32 {
        let texels = self.image.mips.first().map_or(&[][..], |level| level);
        let alphas = texels.iter().skip(3).step_by(4);
        let clear = alphas.filter(|&&alpha| alpha == 0).count();
        let shown = 1.0 - count(clear) / count((texels.len() / 4).max(1));
        to_f32(shown * self.rect.area() / (canvas_size[0] * canvas_size[1])).clamp(0.0, 1.0)
    }
}
