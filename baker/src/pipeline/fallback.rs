//! The fallback for outlines that are too complex for curves: shapes become patches, clips are
//! dropped.

use vtex_format::{Warning, WarningCode};

use crate::{
    coverage::{
        cover::Cover,
        curves::CurveError,
        grid::Lattice,
        placed::{Placed, place_item},
        verdict::{Coverage, Verdict},
    },
    drawing::{Drawing, ImageItem, Item},
    number::count,
    raster::patch::{self, PatchSettings},
    warning,
};

/// Replaces shapes that cannot be curves by patches, and resolves all covers. Warns about each.
pub(crate) fn patch_failures(
    covers: Vec<Result<Cover, CurveError>>,
    drawing: &mut Drawing,
    placed: &mut [Placed],
    lattice: &Lattice,
    settings: PatchSettings,
) -> Vec<Cover> {
    let failures = covers.iter().filter(|cover| cover.is_err()).count();
    // All of them share the texels of patches equally.
    let share = 1.0 / count(failures.max(1));
    let longer = drawing.longer_side();
    let items = drawing.items.iter_mut().zip(placed);
    let mut resolved = Vec::with_capacity(covers.len());
    for (cover, (item, placed)) in covers.into_iter().zip(items) {
        resolved.push(cover.unwrap_or_else(|_| {
            let shape = match item {
                Item::Shape(shape) => shape,
                Item::Clip(_) => {
                    drawing.warnings.push(clip_warning());
                    return Cover::everywhere(lattice);
                }
                Item::Image(_) => return Cover::default(),
            };
            // Without a patch nothing of the shape shows, and its empty cover lists it nowhere.
            if let Some(patch) = patch::of_shape(shape, settings, share) {
                drawing
                    .warnings
                    .push(failure_warning(&patch, drawing.canvas_size));
                *item = Item::Image(patch);
                *placed = place_item(item, lattice, longer, Verdict::forced(Coverage::Msdf));
            }
            Cover::default()
        }));
    }
    resolved
}

fn clip_warning() -> Warning {
    let message = "an outline to clip to is too complex for curves; nothing is clipped to it";
    warning::plain(WarningCode::PathFallback, "clipPath", "", message)
}

fn failure_warning(patch: &ImageItem, canvas_size: [f64; 2]) -> Warning {
    let [width, height] = patch.image.size;
    Warning {
        code: WarningCode::PathFallback,
        feature: patch.feature.clone(),
        element: patch.element.clone(),
        message: format!(
            "this outline is too complex for curves; it is stored as a raster of {width} x {height} \
             texels"
        ),
        area: patch.area(canvas_size),
    }
}
