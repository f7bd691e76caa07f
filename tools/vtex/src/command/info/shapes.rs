//! The part of `vtex info` about shapes.

use std::fmt::Write as _;

use serde_json::{Value, json};
use vtex_format::{
    COVERAGE_CURVES, COVERAGE_IMAGE, COVERAGE_MSDF, Finding, PaintRecord, Preparation, ShapeRecord,
    ShapeReport, VtexFile,
};
use vtex_truth::srgb;

use super::hex;
use crate::cli::counted;

/// A shape's record and report as JSON.
pub(super) fn shape_json(file: &VtexFile, index: usize, shape: &ShapeRecord) -> Value {
    let report = file.provenance.as_ref().and_then(|p| p.shapes.get(index));
    let error = report.and_then(|r| r.msdf_error);
    let place = match shape.coverage {
        COVERAGE_IMAGE => json!({"image": shape.layer_or_image}),
        _ => json!({"layer": shape.layer_or_image}),
    };
    let paint = file.paints.get(shape.paint as usize);
    let mut record = json!({
        "coverage": coverage_name(shape.coverage),
        "element": report.map(|r| &r.element), "source": report.map(|r| &r.source),
        "preparation": report.map(|r| preparation_name(r.preparation)),
        "finding": report.map(|r| finding_name(r.finding)),
        "size_texels": report.map(|r| r.size_texels),
        "wrong_share": error.map(|e| e.wrong_share), "p99_px": error.map(|e| e.p99_px),
        "bounds_uv": shape.bounds_uv, "segments": shape.segment_count,
        "color": paint.filter(|paint| !paint.is_gradient()).map(|paint| paint.color),
        "gradient": paint.is_some_and(PaintRecord::is_gradient),
    });
    if let (Value::Object(record), Value::Object(place)) = (&mut record, place) {
        record.extend(place);
    }
    record
}

fn coverage_name(coverage: u32) -> &'static str {
    match coverage {
        COVERAGE_MSDF => "msdf",
        COVERAGE_CURVES => "curves",
        _ => "image",
    }
}

fn preparation_name(preparation: Preparation) -> &'static str {
    match preparation {
        Preparation::AsDrawn => "as drawn",
        Preparation::Simplified => "simplified",
        Preparation::SecondMethod => "second method",
        Preparation::Failed => "failed",
    }
}

fn finding_name(finding: Finding) -> &'static str {
    match finding {
        Finding::None => "none",
        Finding::Cost => "cost",
        Finding::Quantisation => "quantisation",
        Finding::Hairline => "hairline",
        Finding::Cusp => "cusp",
        Finding::ThinFeature => "thin feature",
        Finding::Displaced => "displaced",
        Finding::Overlaps => "overlaps",
        Finding::TooManySegments => "too many segments",
    }
}

/// What is unusual about a shape; empty when nothing is.
fn report_text(report: &ShapeReport) -> String {
    let mut parts = Vec::new();
    if report.preparation != Preparation::AsDrawn {
        parts.push(preparation_name(report.preparation).to_owned());
    }
    if report.finding != Finding::None {
        parts.push(finding_name(report.finding).to_owned());
    }
    if report.size_texels > 0 {
        parts.push(counted(report.size_texels, "texel"));
    }
    if let Some(error) = report.msdf_error {
        let (p99, wrong) = (error.p99_px, 100.0 * error.wrong_share);
        parts.push(format!("error p99 {p99:.3} px, {wrong:.2}% wrong"));
    }
    match parts.is_empty() {
        true => String::new(),
        false => format!("[{}]", parts.join(", ")),
    }
}

/// The number of shapes by kind of coverage.
fn coverage_counts(file: &VtexFile) -> String {
    let counts = [COVERAGE_MSDF, COVERAGE_CURVES, COVERAGE_IMAGE].map(|coverage| {
        let shapes = file.shapes.iter();
        let count = shapes.filter(|shape| shape.coverage == coverage).count();
        format!("{count} {}", coverage_name(coverage))
    });
    counts.join(", ")
}

/// The table of shapes.
pub(super) fn shapes(out: &mut String, file: &VtexFile, shown: usize) -> std::fmt::Result {
    let columns = ["shape", "layer", "segments", "colour", "element"];
    let [shape, layer, segments, colour, element] = columns;
    let count = file.shapes.len();
    writeln!(
        out,
        "\n{} in painter's order: {}\n{shape:>5} {layer:>7} {segments:>9}  {colour:9}  {element}",
        counted(count, "shape"),
        coverage_counts(file)
    )?;
    for (index, shape) in file.shapes.iter().enumerate().take(shown) {
        let report = file.provenance.as_ref().and_then(|p| p.shapes.get(index));
        let place = match shape.coverage {
            COVERAGE_IMAGE => format!("image {}", shape.layer_or_image),
            _ => shape.layer_or_image.to_string(),
        };
        let colour = match file.paints.get(shape.paint as usize) {
            Some(paint) if shape.coverage != COVERAGE_IMAGE => css(paint),
            _ => "-".to_owned(),
        };
        let what = report.map_or_else(String::new, |report| {
            [
                report.source.clone(),
                report.element.clone(),
                report_text(report),
            ]
            .into_iter()
            .filter(|text| !text.is_empty())
            .collect::<Vec<_>>()
            .join(" ")
        });
        writeln!(
            out,
            "{index:>5} {place:>7} {:>9}  {colour:9}  {what}",
            shape.segment_count
        )?;
    }
    if count > shown {
        writeln!(out, "      ... {} more; -v prints them all", count - shown)?;
    }
    Ok(())
}

fn css(paint: &PaintRecord) -> String {
    if paint.is_gradient() {
        return "gradient".to_owned();
    }
    format!("#{}", hex(&paint.color.map(srgb::byte)))
}
