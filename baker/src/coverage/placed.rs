//! Items placed on the MSDF lattice.

use kurbo::{BezPath, Rect, Shape as _};
use rayon::prelude::*;

use crate::{
    coverage::{
        grid::Lattice,
        verdict::{Coverage, Verdict},
    },
    drawing::{Drawing, FillRule, Item, Paint},
    geometry::{
        Region,
        prepare::{Note, Prepared, clean, prepare},
    },
    number::floor_index,
};

/// One item in lattice steps. Its index in a list is its place in painter's order.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    /// Closed contours.
    pub(crate) outline: BezPath,
    /// Answers inside tests of the outline.
    pub(crate) region: Region,
    /// Its fill rule.
    pub(crate) rule: FillRule,
    /// What kind of item it is.
    pub(crate) kind: PlacedKind,
}

/// What a placed item is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PlacedKind {
    /// A shape.
    Shape {
        /// Its paint, gradients in uv.
        paint: Paint,
        /// What preparation did.
        note: Note,
        /// What it becomes.
        verdict: Verdict,
    },
    /// A raster image; the outline is its rectangle.
    Image,
    /// An outline that clips a group.
    Clip,
}

impl Placed {
    /// An outline in lattice steps.
    pub(crate) fn new(outline: BezPath, rule: FillRule, kind: PlacedKind) -> Self {
        Self {
            region: Region::new(&outline, rule),
            outline,
            rule,
            kind,
        }
    }

    /// Whether it is a shape.
    pub(crate) fn is_shape(&self) -> bool {
        matches!(self.kind, PlacedKind::Shape { .. })
    }

    /// Whether it becomes curve records. Clip outlines always do: a test needs a sharp inside.
    pub(crate) fn is_curves(&self) -> bool {
        match &self.kind {
            PlacedKind::Shape { verdict, .. } => verdict.coverage == Coverage::Curves,
            PlacedKind::Clip => true,
            PlacedKind::Image => false,
        }
    }

    /// Longer side in texels.
    pub(crate) fn size_texels(&self) -> u32 {
        let bounds = self.bounds();
        let size = bounds.width().max(bounds.height()).ceil();
        u32::try_from(floor_index(size)).unwrap_or(u32::MAX)
    }

    /// Box of the control points, in steps.
    pub(crate) fn bounds(&self) -> Rect {
        self.region.bounds()
    }
}

/// Prepares and places every item of `drawing`.
pub(crate) fn place(drawing: &Drawing, lattice: &Lattice, verdicts: &[Verdict]) -> Vec<Placed> {
    let longer = drawing.longer_side();
    let items = drawing.items.par_iter().zip(verdicts);
    items
        .map(|(item, &verdict)| place_item(item, lattice, longer, verdict))
        .collect()
}

/// A prepared outline alone, for judging.
pub(crate) fn place_prepared(prepared: &Prepared, lattice: &Lattice) -> Placed {
    let kind = PlacedKind::Shape {
        paint: Paint::BLACK,
        note: prepared.note,
        verdict: Verdict::forced(Coverage::Msdf),
    };
    let outline = lattice.lattice_from_canvas * &prepared.outline;
    Placed::new(outline, prepared.rule, kind)
}

/// Prepares and places one item of a drawing whose longer side is `canvas_longer` units.
pub(crate) fn place_item(
    item: &Item,
    lattice: &Lattice,
    canvas_longer: f64,
    verdict: Verdict,
) -> Placed {
    match item {
        Item::Shape(shape) => {
            let prepared = match verdict.coverage {
                Coverage::Msdf => prepare(shape, canvas_longer),
                // Windings need no preparation. It would even do harm: an edge that two shapes
                // share must stay the same in both, or a seam shows.
                Coverage::Curves => Prepared {
                    outline: clean(&shape.outline, canvas_longer),
                    rule: shape.fill_rule,
                    note: Note::AsDrawn,
                },
            };
            let kind = PlacedKind::Shape {
                paint: shape.paint.clone(),
                note: prepared.note,
                verdict,
            };
            let outline = lattice.lattice_from_canvas * prepared.outline;
            Placed::new(outline, prepared.rule, kind)
        }
        Item::Clip(clip) => {
            let outline = lattice.lattice_from_canvas * clean(&clip.outline, canvas_longer);
            Placed::new(outline, clip.rule, PlacedKind::Clip)
        }
        Item::Image(image) => {
            // The tolerance has no meaning for a rectangle.
            let outline = lattice.lattice_from_canvas * image.rect.to_path(0.1);
            Placed::new(outline, FillRule::NonZero, PlacedKind::Image)
        }
    }
}
