//! The report of the bake.

use crate::container::issue::{self, Issues};
use crate::container::tag::Tag;
use crate::records::prov::{MsdfError, Provenance};

/// One report a shape, options sorted, errors and areas in range.
pub(super) fn provenance(provenance: &Provenance, shape_count: usize, issues: &mut Issues) {
    let reports = provenance.shapes.len();
    if reports != shape_count {
        let message = format_args!("{reports} reports, {shape_count} shapes");
        issues.add(issue::PROV_SHAPES, Tag::PROV, 0, message);
    }
    let sound = |error: MsdfError| {
        (0.0..=1.0).contains(&error.wrong_share) && error.p99_px.is_finite() && error.p99_px >= 0.0
    };
    for (index, report) in provenance.shapes.iter().enumerate() {
        if let Some(error) = report.msdf_error.filter(|error| !sound(*error)) {
            let message = format_args!("shape {index}: {error:?}");
            issues.add(issue::PROV_ERROR, Tag::PROV, 0, message);
        }
    }
    for (index, warning) in provenance.warnings.iter().enumerate() {
        if !(0.0..=1.0).contains(&warning.area) {
            let message = format_args!("warning {index}: {}", warning.area);
            issues.add(issue::PROV_AREA, Tag::PROV, 0, message);
        }
    }
    // Strictly: no name occurs twice.
    if !provenance.options.is_sorted_by(|a, b| a.0 < b.0) {
        issues.add(
            issue::PROV_OPTIONS,
            Tag::PROV,
            0,
            format_args!("not sorted"),
        );
    }
}
