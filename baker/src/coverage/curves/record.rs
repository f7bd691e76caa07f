//! Records: what evaluators read.

use vtex_format::cut::CellCurves;

use super::CurveError;
use crate::drawing::FillRule;

/// The words of one record for shapes that share a cell, a paint and a fill rule and do not
/// overlap, so that their windings may be added.
///
/// # Errors
/// [`CurveError::Overflow`] when they do not fit one record.
pub(crate) fn encode_record(parts: &[&CellCurves], rule: FillRule) -> Result<Vec<u32>, CurveError> {
    let mut all = CellCurves::default();
    for part in parts {
        all.join(part);
    }
    let even_odd = rule == FillRule::EvenOdd;
    all.record(even_odd).ok_or(CurveError::Overflow)
}
