//! Raster patches: subtrees of the SVG that are not geometry, and shapes that are too much for
//! curves.

mod density;
mod native;
mod resvg;
mod skia;
mod window;

use rayon::prelude::*;
use tiny_skia::Pixmap;
use vtex_format::{Warning, WarningCode};

use crate::{
    drawing::{Item, Patch, Shape, tree::Tree},
    raster::mips::{self, LinearImage},
    svg::{Plan, Step, Subtree},
    warning::Warnings,
};
use density::{MAX_PATCH_TEXELS, WANTED_DENSITY};
use native::Native;
use window::{Source, Window};

pub(crate) use density::PatchSettings;

/// What a shape is called that is a patch because it is too much for curve records.
pub(crate) const SHAPE_FEATURE: &str = "path";

/// Makes a drawing's items of the plan's steps, subtrees becoming images; the result is in
/// painter's order.
pub(crate) fn resolve(
    plan: Plan<'_>,
    settings: PatchSettings,
    warnings: &Warnings,
) -> (Vec<Item>, Tree) {
    let natives = native::choose(&plan.steps);
    let patched = plan
        .steps
        .iter()
        .zip(&natives)
        .filter_map(|pair| match pair {
            (Step::Raster(subtree), None) => Some(subtree),
            _ => None,
        });
    // One density for all: neighbours must not differ in sharpness.
    let density = settings.common_density(patched);
    let painted: Vec<Outcome> = plan
        .steps
        .into_par_iter()
        .zip(natives)
        .map(|(step, native)| Outcome::of(step, native, settings, density))
        .collect();
    // Warnings are told here and not while painting: in document order at any thread count.
    let mut items = Vec::with_capacity(painted.len());
    let mut place = Vec::with_capacity(painted.len());
    let mut coarse = false;
    for outcome in painted {
        let next = u32::try_from(items.len()).ok();
        let item = match outcome {
            Outcome::Item(item) => Some(item),
            Outcome::Patch(patch, density) => {
                coarse |= density < settings.wanted_density();
                warnings.add(patch_warning(&patch, settings.canvas_size));
                Some(Item::Patch(patch))
            }
            Outcome::Nothing => None,
            Outcome::Failed(feature, element) => {
                let message = format!("{feature} could not be painted and is left out");
                warnings.push(WarningCode::RasterPatch, feature, &element, message);
                None
            }
        };
        place.push(item.as_ref().and(next));
        items.extend(item);
    }
    if coarse {
        warnings.add(coarse_warning());
    }
    (items, plan.tree.renumbered(&place))
}

/// What becomes of a step.
enum Outcome {
    /// An item without a word: geometry, or an image that keeps its texels.
    Item(Item),
    /// A patch and its density.
    Patch(Patch, f64),
    /// Nothing of it shows.
    Nothing,
    /// resvg failed on this feature of this element.
    Failed(&'static str, String),
}

impl Outcome {
    fn of(step: Step<'_>, native: Option<Native>, settings: PatchSettings, density: f64) -> Self {
        let subtree = match step {
            Step::Shape(shape) => return Self::Item(Item::Shape(shape)),
            Step::Clip(clip) => return Self::Item(Item::Clip(clip)),
            Step::Raster(subtree) => subtree,
        };
        let native = native.and_then(|native| native.patch(&subtree, settings.canvas_size));
        match native {
            Some(patch) => Self::Item(Item::Patch(patch)),
            None => Self::painted(&subtree, settings, density),
        }
    }

    /// The subtree as resvg paints it, at `density` or as fine as it can be.
    fn painted(subtree: &Subtree<'_>, settings: PatchSettings, density: f64) -> Self {
        let density = density.min(settings.density_limit(subtree));
        let window = Window::new(subtree.bounds, settings.lattice(density), settings);
        let Some(pixmap) = paint_subtree(subtree, &window) else {
            return Self::Failed(subtree.feature, subtree.element.clone());
        };
        let source = Source {
            feature: subtree.feature,
            element: &subtree.element,
        };
        match window.patch(pixmap, source) {
            Some(patch) => Self::Patch(patch, density),
            None => Self::Nothing,
        }
    }
}

/// `None` when there is no memory for the window or resvg panics.
fn paint_subtree(subtree: &Subtree<'_>, window: &Window) -> Option<Pixmap> {
    let view = window.view();
    let mut pixmap = Pixmap::new(view.size[0], view.size[1])?;
    let texel_from_parent = view.texel_from_canvas() * subtree.canvas_from_parent;
    resvg::paint_node(subtree.node, texel_from_parent, &mut pixmap)?;
    Some(pixmap)
}

/// One shape as a patch, within its `share` of what patches may take; `None` when nothing of it
/// shows.
pub(crate) fn of_shape(shape: &Shape, settings: PatchSettings, share: f64) -> Option<Patch> {
    let bounds = shape
        .outline
        .control_box()
        .intersect(settings.canvas_rect());
    let density = settings.density_of_share(bounds, share);
    let window = Window::new(bounds, settings.lattice(density), settings);
    let pixmap = skia::picture(shape, window.view())?;
    let source = Source {
        feature: SHAPE_FEATURE,
        element: &shape.element,
    };
    window.patch(pixmap, source)
}

/// The whole canvas as one patch, of which `paint` makes a picture of a size.
pub(crate) fn whole_canvas(
    settings: PatchSettings,
    paint: impl FnOnce([u32; 2]) -> LinearImage,
) -> (Patch, Option<Warning>) {
    let density = settings.density_of_canvas();
    let picture = paint(settings.lattice(density));
    let patch = Patch {
        rect: settings.canvas_rect(),
        image: mips::chain(picture, [0.0, 0.0, 1.0, 1.0]),
        feature: "raster".to_owned(),
        element: String::new(),
    };
    let coarse = density < settings.wanted_density();
    (patch, coarse.then(coarse_warning))
}

fn patch_warning(patch: &Patch, canvas_size: [f64; 2]) -> Warning {
    let (feature, [width, height]) = (&patch.feature, patch.image.size);
    Warning {
        code: WarningCode::RasterPatch,
        feature: feature.clone(),
        element: patch.element.clone(),
        message: format!("{feature} is stored as a raster of {width} x {height} texels"),
        area: patch.area(canvas_size),
    }
}

fn coarse_warning() -> Warning {
    Warning {
        code: WarningCode::Reduced,
        feature: "raster".into(),
        element: String::new(),
        message: format!(
            "raster patches have fewer than {WANTED_DENSITY} texels for each of mip 0, \
             to keep within {} MiB",
            MAX_PATCH_TEXELS * 16.0 / 3.0 / 1_048_576.0
        ),
        area: 0.0,
    }
}
