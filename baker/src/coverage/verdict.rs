//! What a shape becomes: the decision, and what it rests on.

use vtex_format::{FieldError, Finding};

use crate::drawing::Item;

/// How a shape covers cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coverage {
    /// Tiles of a distance field.
    Msdf,
    /// Curve records.
    Curves,
}

/// A decision and what it rests on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Verdict {
    /// What the shape becomes.
    pub(crate) coverage: Coverage,
    /// Why it is no distance field, or what is wrong with it.
    pub(crate) finding: Finding,
    /// Longer side of the shape in texels of the lattice on which its field was judged; 0 where
    /// none was.
    pub(crate) size_texels: u32,
    /// How far the field is off, where it was measured.
    pub(crate) error: Option<FieldError>,
}

impl Verdict {
    /// A verdict that the mode gives.
    pub(crate) fn forced(coverage: Coverage) -> Self {
        Self::unmeasured(coverage, Finding::None)
    }

    /// A verdict without a measurement.
    pub(crate) fn unmeasured(coverage: Coverage, finding: Finding) -> Self {
        Self {
            coverage,
            finding,
            size_texels: 0,
            error: None,
        }
    }
}

/// What becomes of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Judgement {
    /// One an item; what it says of patches has no meaning.
    pub(crate) verdicts: Vec<Verdict>,
    /// Texels of the lattice of distance fields along the canvas' longer side.
    pub(crate) msdf_size: u32,
}

impl Judgement {
    /// Whether every shape among the `items` judged becomes curves, and there is one.
    pub(crate) fn all_curves(&self, items: &[Item]) -> bool {
        let mut shapes = items
            .iter()
            .zip(&self.verdicts)
            .filter(|(item, _)| matches!(item, Item::Shape(_)))
            .peekable();
        shapes.peek().is_some() && shapes.all(|(_, verdict)| verdict.coverage == Coverage::Curves)
    }
}
