//! Subtrees that are not geometry become raster patches, painted by resvg.

use std::panic::{AssertUnwindSafe, catch_unwind};

use kurbo::{Affine, Rect};
use rayon::prelude::*;
use tiny_skia::{Pixmap, Transform};
use vtex_format::{Warning, WarningCode};

use crate::{
    config::BakeConfig,
    drawing::{Item, Patch, color, tree::Tree},
    number::to_f32,
    raster::{
        detail,
        mips::{self, LinearImage},
        skia::{self, View},
    },
    svg::{Cost, Plan, Step, Subtree},
    warning::Warnings,
};

/// Patch texels for each texel of mip 0, when there is room. More gives crisper edges until curve
/// and gradient cells make patches rare.
const FINEST_DENSITY: f64 = 8.0;
/// Below this a patch is visibly blurred soon after mip 0 is left behind: worth a warning.
const WANTED_DENSITY: f64 = 4.0;
/// Texels of a patch's longer side, besides up to three at its ends; RGBA of that square is 21 MiB
/// with its mips.
const MAX_PATCH_SIDE: f64 = 2048.0;
/// Level 0 texels of all patches of a file: 32 MiB with their mips.
const MAX_PATCH_TEXELS: f64 = 6_291_456.0;
/// Bytes of resvg's layers while one patch is painted. Past it the patch gets coarser.
const MAX_LAYER_BYTES: f64 = 536_870_912.0;
/// Texels of one pattern tile, 256 MiB. Past it the patch gets coarser.
const MAX_PATTERN_TEXELS: f64 = 67_108_864.0;
/// resvg bounds a layer to this multiple of its pixmap, each way.
const LAYER_OVERHANG: f64 = 5.0;

/// What a shape is called that is a patch because it is too much for curve records.
pub(crate) const SHAPE_FEATURE: &str = "path";

/// How patches are made for one drawing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchSettings {
    /// Width and height of the canvas in user units.
    pub(crate) canvas_size: [f64; 2],
    /// Texels of mip 0's longer side.
    pub(crate) mip0_size: u32,
    /// Largest magnification.
    pub(crate) max_zoom: f64,
}

/// Paints every subtree of the plan; the result is in painter's order.
pub(crate) fn resolve(
    plan: Plan<'_>,
    settings: PatchSettings,
    warnings: &Warnings,
) -> (Vec<Item>, Tree) {
    let density = settings.common_density(&plan);
    let painted: Vec<Outcome> = plan
        .steps
        .into_par_iter()
        .map(|step| match step {
            Step::Shape(shape) => Outcome::Item(Item::Shape(shape)),
            Step::Clip(clip) => Outcome::Item(Item::Clip(clip)),
            Step::Raster(subtree) => match settings.paint_native(&subtree) {
                Some(patch) => Outcome::Item(Item::Patch(patch)),
                None => settings.paint_alone(&subtree, density),
            },
        })
        .collect();
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

/// The whole canvas as one patch, of which `paint` makes a picture of a size.
pub(crate) fn whole_canvas(
    settings: PatchSettings,
    paint: impl FnOnce([u32; 2]) -> LinearImage,
) -> (Patch, Option<Warning>) {
    let [width, height] = settings.canvas_size;
    let density = settings
        .finest_density()
        .min(MAX_PATCH_SIDE / f64::from(settings.mip0_size));
    let picture = paint(settings.lattice(density));
    let patch = Patch {
        rect: Rect::new(0.0, 0.0, width, height),
        image: mips::chain(picture, [0.0, 0.0, 1.0, 1.0]),
        feature: "raster".to_owned(),
        element: String::new(),
    };
    let coarse = density < settings.wanted_density();
    (patch, coarse.then(coarse_warning))
}

/// One shape as a patch, within its `share` of what patches may take; `None` when nothing of it
/// shows.
pub(crate) fn of_shape(item: &Item, settings: PatchSettings, share: f64) -> Option<Patch> {
    let Item::Shape(shape) = item else {
        return None;
    };
    let bounds = shape.outline.control_box().intersect(settings.canvas());
    let texels = bounds.area() * settings.base_scale().powi(2);
    let density = settings
        .finest_density()
        .min(settings.density_for_side(bounds))
        .min((share * MAX_PATCH_TEXELS / texels.max(1.0)).sqrt());
    let lattice = settings.lattice(density);
    let window = settings.window(bounds, lattice);
    let view = settings.view(window, lattice);
    let mut pixmap = skia::picture(std::slice::from_ref(item), view)?;
    clear_border(&mut pixmap, window, lattice);
    let shown = shown_part(&pixmap, window, lattice)?;
    Some(settings.patch(
        &pixmap,
        window,
        shown,
        lattice,
        [SHAPE_FEATURE, &shape.element],
    ))
}

enum Outcome {
    /// No subtree.
    Item(Item),
    /// A patch and its density.
    Patch(Patch, f64),
    /// Nothing of it shows.
    Nothing,
    /// resvg failed on this feature of this element.
    Failed(&'static str, String),
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

/// A rectangle of lattice texels: left, top, right, bottom.
type Window = [u32; 4];

impl PatchSettings {
    /// Of a bake of a canvas of `canvas_size`.
    pub(crate) fn new(canvas_size: [f64; 2], config: &BakeConfig) -> Self {
        Self {
            canvas_size,
            mip0_size: config.mip0_size,
            max_zoom: f64::from(config.max_zoom),
        }
    }

    fn finest_density(self) -> f64 {
        FINEST_DENSITY.min(self.max_zoom.max(1.0))
    }

    fn wanted_density(self) -> f64 {
        WANTED_DENSITY.min(self.max_zoom.max(1.0))
    }

    /// Texels a user unit at density 1.
    fn base_scale(self) -> f64 {
        f64::from(self.mip0_size) / self.canvas_size[0].max(self.canvas_size[1])
    }

    fn canvas(self) -> Rect {
        Rect::new(0.0, 0.0, self.canvas_size[0], self.canvas_size[1])
    }

    /// The largest density at which all patches together stay within their budget.
    fn common_density(self, plan: &Plan<'_>) -> f64 {
        let subtrees: Vec<(Rect, f64)> = plan
            .steps
            .iter()
            .filter_map(|step| match step {
                Step::Raster(s) if s.native.is_some() => None,
                Step::Raster(s) => Some((s.bounds.intersect(self.canvas()), self.density_limit(s))),
                Step::Shape(_) | Step::Clip(_) => None,
            })
            .collect();
        let mut density = self.finest_density();
        // Borders make the sum not quite quadratic in the density: a few rounds converge.
        for _ in 0..16 {
            let texels = |&(bounds, limit): &(Rect, f64)| {
                let scale = self.base_scale() * density.min(limit);
                (bounds.width() * scale + 2.0) * (bounds.height() * scale + 2.0)
            };
            let total: f64 = subtrees.iter().map(texels).sum();
            if total <= MAX_PATCH_TEXELS {
                break;
            }
            density *= (MAX_PATCH_TEXELS / total).sqrt() * 0.999;
        }
        density
    }

    fn density_for_side(self, bounds: Rect) -> f64 {
        let side = bounds.width().max(bounds.height()) * self.base_scale();
        MAX_PATCH_SIDE / side.max(f64::MIN_POSITIVE)
    }

    /// Bounds of one subtree's density: side, layers, patterns, filters.
    fn density_limit(self, subtree: &Subtree<'_>) -> f64 {
        let visible = subtree.bounds.intersect(self.canvas());
        let cost = Cost::of_node(subtree.node, subtree.canvas_from_parent, self.canvas_size);
        let base = self.base_scale();
        let layer_area = subtree.bounds.width().min(LAYER_OVERHANG * visible.width())
            * subtree
                .bounds
                .height()
                .min(LAYER_OVERHANG * visible.height());
        let layer_bytes = 4.0 * cost.layers * layer_area * base * base;
        let pattern_texels = cost.pattern_area * base * base;
        let for_layers = (MAX_LAYER_BYTES / layer_bytes.max(f64::MIN_POSITIVE)).sqrt();
        let for_patterns = (MAX_PATTERN_TEXELS / pattern_texels.max(f64::MIN_POSITIVE)).sqrt();
        self.density_for_side(visible)
            .min(for_layers)
            .min(for_patterns)
            .min(cost.filter_density(base))
    }

    /// Texels of the whole canvas at a density. The canvas covers them exactly, at the price of
    /// texels that are not quite square.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positive; `as` saturates and the side limit keeps windows small"
    )]
    fn lattice(self, density: f64) -> [u32; 2] {
        let scale = self.base_scale() * density;
        self.canvas_size
            .map(|side| (side * scale).ceil().max(1.0) as u32)
    }

    /// Texels that `bounds` touches and one more all around, within the canvas.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the lattice"
    )]
    fn window(self, bounds: Rect, lattice: [u32; 2]) -> Window {
        let low = |value: f64, axis: usize| {
            let texel = value * f64::from(lattice[axis]) / self.canvas_size[axis];
            (texel.floor() - 1.0).clamp(0.0, f64::from(lattice[axis] - 1)) as u32
        };
        let high = |value: f64, axis: usize| {
            let texel = value * f64::from(lattice[axis]) / self.canvas_size[axis];
            (texel.ceil() + 1.0).clamp(1.0, f64::from(lattice[axis])) as u32
        };
        [
            low(bounds.x0, 0),
            low(bounds.y0, 1),
            high(bounds.x1, 0),
            high(bounds.y1, 1),
        ]
    }

    fn view(self, window: Window, lattice: [u32; 2]) -> View {
        View {
            size: [window[2] - window[0], window[3] - window[1]],
            origin: [f64::from(window[0]), f64::from(window[1])],
            ..View::canvas(self.canvas_size, lattice)
        }
    }

    /// An image with its own texels.
    fn paint_native(self, subtree: &Subtree<'_>) -> Option<Patch> {
        subtree.native?.patch(subtree, self.canvas_size)
    }

    fn paint_alone(self, subtree: &Subtree<'_>, density: f64) -> Outcome {
        let density = density.min(self.density_limit(subtree));
        let lattice = self.lattice(density);
        let window = self.window(subtree.bounds, lattice);
        let view = self.view(window, lattice);
        let painted = Pixmap::new(view.size[0], view.size[1])
            .and_then(|mut pixmap| paint_node(subtree, view, &mut pixmap).map(|()| pixmap));
        let Some(mut pixmap) = painted else {
            return Outcome::Failed(subtree.feature, subtree.element.clone());
        };
        clear_border(&mut pixmap, window, lattice);
        match shown_part(&pixmap, window, lattice) {
            Some(shown) => Outcome::Patch(
                self.patch(&pixmap, window, shown, lattice, subtree.names()),
                density,
            ),
            None => Outcome::Nothing,
        }
    }

    /// The part `shown` of a painted window as a patch.
    fn patch(
        self,
        pixmap: &Pixmap,
        window: Window,
        shown: Window,
        lattice: [u32; 2],
        [feature, element]: [&str; 2],
    ) -> Patch {
        let level0 = detail::fitted(cropped(pixmap, window, shown));
        let uv = |texel: u32, axis: usize| f64::from(texel) / f64::from(lattice[axis]);
        let [left, top, right, bottom] = [
            uv(shown[0], 0),
            uv(shown[1], 1),
            uv(shown[2], 0),
            uv(shown[3], 1),
        ];
        let [width, height] = self.canvas_size;
        Patch {
            rect: Rect::new(left * width, top * height, right * width, bottom * height),
            image: mips::chain(level0, [left, top, right, bottom].map(to_f32)),
            feature: feature.to_owned(),
            element: element.to_owned(),
        }
    }
}

impl Subtree<'_> {
    /// Feature and element.
    fn names(&self) -> [&str; 2] {
        [self.feature, &self.element]
    }
}

/// Paints one node with its ancestors' transform; `None` when resvg panics.
fn paint_node(subtree: &Subtree<'_>, view: View, pixmap: &mut Pixmap) -> Option<()> {
    let texel_from_parent = view.texel_from_canvas() * subtree.canvas_from_parent;
    paint_node_by(subtree.node, texel_from_parent, pixmap)
}

/// Paints one node, whose parent's space is mapped to texels; `None` when resvg panics.
#[expect(clippy::cast_possible_truncation, reason = "tiny-skia works in f32")]
pub(crate) fn paint_node_by(
    node: &usvg::Node,
    texel_from_parent: Affine,
    pixmap: &mut Pixmap,
) -> Option<()> {
    let Some(bbox) = node.abs_layer_bounding_box() else {
        return Some(());
    };
    let [a, b, c, d, e, f] = texel_from_parent.as_coeffs().map(|v| v as f32);
    // `render_node` moves the node's box to the origin; this moves it back.
    let transform = Transform::from_row(a, b, c, d, e, f).pre_translate(bbox.x(), bbox.y());
    catch_unwind(AssertUnwindSafe(|| {
        resvg::render_node(node, transform, &mut pixmap.as_mut());
    }))
    .ok()
}

/// Clears the outermost texels except along the canvas' own edges, so that bilinear lookups fade
/// to nothing there even if a box was too small.
fn clear_border(pixmap: &mut Pixmap, window: Window, lattice: [u32; 2]) {
    let (width, height) = (pixmap.width() as usize, pixmap.height() as usize);
    let texels = pixmap.data_mut().as_chunks_mut::<4>().0;
    if window[1] > 0 {
        texels[..width].fill([0; 4]);
    }
    if window[3] < lattice[1] {
        texels[(height - 1) * width..].fill([0; 4]);
    }
    for row in texels.chunks_exact_mut(width) {
        if window[0] > 0 {
            row[0] = [0; 4];
        }
        if window[2] < lattice[0] {
            row[width - 1] = [0; 4];
        }
    }
}

/// The smallest part of the window outside of which all is transparent, with a transparent border
/// except along the canvas' edges. `None` when nothing shows.
fn shown_part(pixmap: &Pixmap, window: Window, lattice: [u32; 2]) -> Option<Window> {
    let width = pixmap.width() as usize;
    let texels = pixmap.data().as_chunks::<4>().0;
    let shows = |texel: &[u8; 4]| texel[3] > 0;
    let mut columns: Option<(usize, usize)> = None;
    let mut rows: Option<(usize, usize)> = None;
    for (y, row) in texels.chunks_exact(width).enumerate() {
        let Some(first) = row.iter().position(shows) else {
            continue;
        };
        let last = row.iter().rposition(shows).unwrap_or(first);
        columns = Some(columns.map_or((first, last), |(a, b)| (a.min(first), b.max(last))));
        rows = Some(rows.map_or((y, y), |(a, _)| (a, y)));
    }
    let ((left, right), (top, bottom)) = (columns?, rows?);
    let texel = |offset: usize, axis: usize| window[axis] + u32::try_from(offset).unwrap_or(0);
    Some([
        texel(left, 0).saturating_sub(1),
        texel(top, 1).saturating_sub(1),
        (texel(right, 0) + 2).min(lattice[0]),
        (texel(bottom, 1) + 2).min(lattice[1]),
    ])
}

fn cropped(pixmap: &Pixmap, window: Window, shown: Window) -> LinearImage {
    let size = [shown[2] - shown[0], shown[3] - shown[1]];
    let width = pixmap.width() as usize;
    let (left, top) = (
        (shown[0] - window[0]) as usize,
        (shown[1] - window[1]) as usize,
    );
    let texels = pixmap.data().as_chunks::<4>().0;
    let rows = texels.chunks_exact(width).skip(top).take(size[1] as usize);
    let texels = rows
        .flat_map(|row| &row[left..left + size[0] as usize])
        .map(|&texel| color::linear_from_skia(texel))
        .collect();
    LinearImage { size, texels }
}
