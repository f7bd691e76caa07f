//! The file's warnings.

use kurbo::{Rect, Shape as _};
use vtex_format::{Warning, WarningCode};

use crate::{
    cells::{CellInput, CellLists},
    coverage::{placed::PlacedKind, verdict::Coverage},
    drawing::{Drawing, Item, Shape},
    geometry::prepare::Note,
    number::to_f32,
    warning,
};

/// The warnings of the drawing, which are taken out of it, and those of the stages since.
pub(super) fn warnings(
    drawing: &mut Drawing,
    input: &CellInput<'_>,
    lists: &CellLists,
) -> Vec<Warning> {
    let mut warnings = std::mem::take(&mut drawing.warnings);
    for (item, placed) in drawing.items.iter().zip(input.placed) {
        // Curves have their outline as drawn in any case.
        if let (Item::Shape(shape), PlacedKind::Shape { note, verdict, .. }) = (item, &placed.kind)
            && *note == Note::Failed
            && verdict.coverage == Coverage::Msdf
        {
            warnings.push(overlaps_left(shape, drawing.canvas_size));
        }
    }
    if input.packing.forced {
        let message = "shapes that touch were forced into one layer";
        warnings.push(warning::plain(
            WarningCode::MergeOverlap,
            "merge",
            "",
            message,
        ));
    }
    let told = |code| warnings.iter().any(|warning| warning.code == code);
    let empty = lists.words.iter().all(|&word| word == 0);
    if empty && !told(WarningCode::EmptyDrawing) {
        let message = "nothing in the drawing shows on its canvas";
        warnings.push(warning::plain(
            WarningCode::EmptyDrawing,
            "svg",
            "",
            message,
        ));
    }
    warnings
}

fn overlaps_left(shape: &Shape, [width, height]: [f64; 2]) -> Warning {
    let canvas = Rect::new(0.0, 0.0, width, height);
    let shown = shape.outline.bounding_box().intersect(canvas);
    let message = "overlaps in this outline could not be removed; its edges may be rough";
    Warning {
        area: to_f32(shown.area() / canvas.area()).clamp(0.0, 1.0),
        ..warning::plain(WarningCode::PathFallback, "path", &shape.element, message)
    }
}
