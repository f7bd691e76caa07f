//! Patches: raster images of what no shape can be.
//!
//! Most are subtrees of the SVG that resvg paints ([`resvg`]), such as filters. A few are shapes
//! that are too complex for curve records ([`skia`]). Embedded images keep their own texels instead
//! ([`embedded`]).

mod density;
mod embedded;
mod finish;
mod reason;
mod resvg;
mod shown;
mod skia;
mod window;

use rayon::prelude::*;
use tiny_skia::Pixmap;
use vtex_format::{Warning, WarningCode};

use crate::{
    drawing::{ImageItem, Item, Shape, tree::Tree},
    raster::mips::LinearImage,
    svg::{Plan, PlanItem, Subtree},
    warning::{self, Warnings},
};
use density::{MAX_PATCH_TEXELS, WANTED_DENSITY};
use embedded::Embedded;
use finish::Source;
use window::Window;

pub(crate) use density::PatchSettings;

/// Feature of a patch that stands for a shape too complex for curve records.
pub(crate) const SHAPE_FEATURE: &str = "path";

/// Turns the items of a plan into those of a drawing, in painter's order: subtrees become
/// images.
pub(crate) fn resolve(
    plan: Plan<'_>,
    settings: PatchSettings,
    warnings: &Warnings,
) -> (Vec<Item>, Tree) {
    let embedded = embedded::choose(&plan.items);
    let patched = plan
        .items
        .iter()
        .zip(&embedded)
        .filter_map(|pair| match pair {
            (PlanItem::Raster(subtree), None) => Some(subtree),
            _ => None,
        });
    // One density for all patches, so that neighbours look equally sharp.
    let density = settings.common_density(patched);
    let painted: Vec<Outcome> = plan
        .items
        .into_par_iter()
        .zip(embedded)
        .map(|(item, image)| Outcome::of(item, image, settings, density))
        .collect();
    // Warnings are collected here and not while painting: their order must not depend on threads.
    let mut items = Vec::with_capacity(painted.len());
    let mut place = Vec::with_capacity(painted.len());
    let mut coarse = false;
    for outcome in painted {
        if let Outcome::Patch(_, density, _) = outcome {
            coarse |= density < settings.wanted_density();
        }
        let next = u32::try_from(items.len()).ok();
        let item = outcome.into_item(settings.canvas_size, warnings);
        place.push(item.as_ref().and(next));
        items.extend(item);
    }
    if coarse {
        warnings.add(coarse_warning());
    }
    (items, plan.tree.renumbered(&place))
}

/// The result of one item of a plan.
enum Outcome {
    /// An item that needs no warning: geometry, or an embedded image.
    Item(Item),
    /// A patch, its density, and why it is no geometry.
    Patch(ImageItem, f64, &'static str),
    /// Nothing: all of it is transparent, or lies beside the canvas.
    Nothing,
    /// resvg failed on this feature of this element.
    Failed(&'static str, String),
}

impl Outcome {
    fn of(
        item: PlanItem<'_>,
        image: Option<Embedded>,
        settings: PatchSettings,
        density: f64,
    ) -> Self {
        let subtree = match item {
            PlanItem::Shape(shape) => return Self::Item(Item::Shape(shape)),
            PlanItem::Clip(clip) => return Self::Item(Item::Clip(clip)),
            PlanItem::Raster(subtree) => subtree,
        };
        match image.and_then(|image| image.picture(&subtree, settings)) {
            Some(Some(item)) => Self::Item(item),
            Some(None) => Self::Nothing,
            None => Self::painted(&subtree, settings, density),
        }
    }

    /// The subtree painted by resvg, at `density` or at the largest density that its cost allows.
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
        let shown = window.picture(pixmap);
        match shown.map(|(picture, rect)| settings.item(picture, rect, source)) {
            Some(Item::Image(patch)) => Self::Patch(patch, density, reason::of(subtree)),
            Some(shape) => Self::Item(shape),
            None => Self::Nothing,
        }
    }

    /// The item, if there is one. Warns about everything but geometry and embedded images.
    fn into_item(self, canvas_size: [f64; 2], warnings: &Warnings) -> Option<Item> {
        match self {
            Self::Item(item) => Some(item),
            Self::Patch(patch, _, reason) => {
                warnings.add(patch_warning(&patch, reason, canvas_size));
                Some(Item::Image(patch))
            }
            Self::Nothing => None,
            Self::Failed(feature, element) => {
                let message = format!("{feature} could not be painted and is left out");
                warnings.push(WarningCode::RasterPatch, feature, &element, message);
                None
            }
        }
    }
}

/// The painted window; `None` when there is no memory for it or resvg panics.
fn paint_subtree(subtree: &Subtree<'_>, window: &Window) -> Option<Pixmap> {
    let view = window.view();
    let mut pixmap = Pixmap::new(view.size[0], view.size[1])?;
    let texel_from_parent = view.texel_from_canvas() * subtree.canvas_from_parent;
    resvg::paint_node(subtree.node, texel_from_parent, &mut pixmap)?;
    Some(pixmap)
}

/// A shape as a patch, within its `share` of the texels of all patches; `None` when nothing of it
/// shows.
pub(crate) fn of_shape(shape: &Shape, settings: PatchSettings, share: f64) -> Option<ImageItem> {
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
    let (picture, rect) = window.picture(pixmap)?;
    Some(settings.image(picture, rect, source))
}

/// The whole canvas as one patch, and a warning if it is coarse. `paint` makes the picture at a
/// size.
pub(crate) fn whole_canvas(
    settings: PatchSettings,
    paint: impl FnOnce([u32; 2]) -> LinearImage,
) -> (ImageItem, Option<Warning>) {
    let density = settings.density_of_canvas();
    let picture = paint(settings.lattice(density));
    let source = Source {
        feature: "raster",
        element: "",
    };
    let patch = settings.image(picture, settings.canvas_rect(), source);
    let coarse = density < settings.wanted_density();
    (patch, coarse.then(coarse_warning))
}

fn patch_warning(patch: &ImageItem, reason: &str, canvas_size: [f64; 2]) -> Warning {
    let (feature, [width, height]) = (&patch.feature, patch.image.size);
    Warning {
        code: WarningCode::RasterPatch,
        feature: feature.clone(),
        element: patch.element.clone(),
        message: format!("{feature} is stored as a raster of {width} x {height} texels: {reason}"),
        area: patch.area(canvas_size),
    }
}

fn coarse_warning() -> Warning {
    let mib = MAX_PATCH_TEXELS * 16.0 / 3.0 / 1_048_576.0;
    let message = format!(
        "raster patches have fewer than {WANTED_DENSITY} texels for each pixel at zoom 1, \
         to keep within {mib} MiB"
    );
    warning::plain(WarningCode::Reduced, "raster", "", message)
}
