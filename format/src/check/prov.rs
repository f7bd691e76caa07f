//! The report of the bake.

use crate::issue::{self, Issues};
use crate::{Provenance, Tag};

/// One report a shape, options sorted.
pub(super) fn provenance(provenance: &Provenance, shape_count: usize, issues: &mut Issues) {
    let reports = provenance.shapes.len();
    if reports != shape_count {
        let message = format_args!("{reports} reports, {shape_count} shapes");
        issues.add(issue::PROV_SHAPES, Tag::PROV, 0, message);
    }
    if !provenance.options.is_sorted_by(|a, b| a.0 < b.0) {
        issues.add(
            issue::PROV_OPTIONS,
            Tag::PROV,
            0,
            format_args!("not sorted"),
        );
    }
}
