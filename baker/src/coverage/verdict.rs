//! The decision what a shape becomes, with its reasons.

use vtex_format::{Finding, MsdfError};

use crate::drawing::Item;

/// How the edges of a shape are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coverage {
    /// Tiles of an MSDF.
    Msdf,
    /// Curve records.
    Curves,
}

/// The decision for one shape, with its reasons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Verdict {
    /// What the shape becomes.
    pub(crate) coverage: Coverage,
    /// Why it is no MSDF, or what is wrong with its MSDF.
    pub(crate) finding: Finding,
    /// Longer side of the shape in texels of the lattice on which its MSDF was judged; 0 if none
    /// was.
    pub(crate) size_texels: u32,
    /// The error of its MSDF, if it was measured.
    pub(crate) error: Option<MsdfError>,
}

impl Verdict {
    /// A verdict that follows from the options alone.
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

/// The decisions for a drawing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Judgement {
    /// One for each item. Those of images and clips mean nothing.
    pub(crate) verdicts: Vec<Verdict>,
    /// Texels of the MSDF lattice along the canvas' longer side.
    pub(crate) msdf_size: u32,
}

impl Judgement {
    /// Whether there are shapes among the judged `items` and all of them become curves.
    pub(crate) fn all_curves(&self, items: &[Item]) -> bool {
        let mut shapes = items
            .iter()
            .zip(&self.verdicts)
            .filter(|(item, _)| matches!(item, Item::Shape(_)))
            .peekable();
        shapes.peek().is_some() && shapes.all(|(_, verdict)| verdict.coverage == Coverage::Curves)
    }
}
