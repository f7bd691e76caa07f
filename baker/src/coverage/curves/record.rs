//! Curve records: the words that the file stores.

use vtex_format::cut::CellCurves;

use super::CurveError;
use crate::drawing::FillRule;

/// The words of one record for shapes that share a cell, a paint and a fill rule. The shapes must
/// not overlap: their windings are added.
///
/// # Errors
/// [`CurveError::Overflow`] when they do not fit into one record.
pub(crate) fn encode_record(parts: &[&CellCurves], rule: FillRule) -> Result<Vec<u32>, CurveError> {
    let mut all = CellCurves::default();
    for part in parts {
        all.join(part);
    }
    let even_odd = rule == FillRule::EvenOdd;
    all.record(even_odd).ok_or(CurveError::Overflow)
}
