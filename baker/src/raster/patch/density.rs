//! How fine patches are: what is wanted, and what memory and time allow.
//!
//! *Density* is the number of patch texels for each pixel at zoom 1, along an axis. At density 8 a
//! patch stays sharp up to zoom 8.

use kurbo::Rect;

use crate::{
    config::{BakeConfig, PIXELS_AT_ZOOM_1},
    number::floor_u32,
    svg::{Cost, Subtree},
};

/// Density when there is room.
const FINEST_DENSITY: f64 = 8.0;
/// Density below which a warning is due: such a patch is visibly blurred at zoom 4.
pub(super) const WANTED_DENSITY: f64 = 4.0;
/// Texels along the longer side of a patch, without up to three of its border. A square of that
/// size takes 21 MiB with its mips.
const MAX_PATCH_SIDE: f64 = 2048.0;
/// Texels of level 0 of all patches of a file together: 32 MiB with their mips.
pub(super) const MAX_PATCH_TEXELS: f64 = 6_291_456.0;
/// Bytes that resvg's layers may take while one patch is painted. A patch that needs more gets
/// coarser.
const MAX_LAYER_BYTES: f64 = 536_870_912.0;
/// Texels that pattern tiles may take at once, 256 MiB. A patch that needs more gets coarser.
const MAX_PATTERN_TEXELS: f64 = 67_108_864.0;
/// Largest size of a resvg layer along an axis, in multiples of its pixmap.
const LAYER_OVERHANG: f64 = 5.0;

/// What the density of a drawing's patches depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchSettings {
    /// Width and height of the canvas in user units.
    pub(crate) canvas_size: [f64; 2],
    /// Texels of mip 0's longer side.
    pub(crate) mip0_size: u32,
    /// Largest zoom.
    pub(crate) max_zoom: f64,
}

impl PatchSettings {
    /// The settings of a bake, for a canvas of `canvas_size` user units.
    pub(crate) fn new(canvas_size: [f64; 2], config: &BakeConfig) -> Self {
        Self {
            canvas_size,
            mip0_size: config.mip0_size,
            max_zoom: f64::from(config.max_zoom),
        }
    }

    /// More than the largest zoom shows is never needed.
    fn finest_density(self) -> f64 {
        FINEST_DENSITY.min(self.max_zoom.max(1.0))
    }

    /// Below it a patch deserves a warning.
    pub(super) fn wanted_density(self) -> f64 {
        WANTED_DENSITY.min(self.max_zoom.max(1.0))
    }

    /// Texels along a user unit at density 1.
    fn base_scale(self) -> f64 {
        PIXELS_AT_ZOOM_1 / self.canvas_size[0].max(self.canvas_size[1])
    }

    /// The canvas in user units.
    pub(super) fn canvas_rect(self) -> Rect {
        Rect::new(0.0, 0.0, self.canvas_size[0], self.canvas_size[1])
    }

    /// The largest density at which the patches of all `subtrees` together stay within their
    /// budget.
    pub(super) fn common_density<'a, 'b: 'a>(
        self,
        subtrees: impl Iterator<Item = &'a Subtree<'b>>,
    ) -> f64 {
        let subtrees: Vec<(Rect, f64)> = subtrees
            .map(|s| {
                (
                    s.bounds.intersect(self.canvas_rect()),
                    self.density_limit(s),
                )
            })
            .collect();
        let mut density = self.finest_density();
        // Without borders the sum would be quadratic in the density and one step would do.
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

    /// The density of one patch that may take this `share` of what all patches may.
    pub(super) fn density_of_share(self, bounds: Rect, share: f64) -> f64 {
        let texels = bounds.area() * self.base_scale().powi(2);
        self.finest_density()
            .min(self.density_for_side(bounds))
            .min((share * MAX_PATCH_TEXELS / texels.max(1.0)).sqrt())
    }

    /// The density of a patch of the whole canvas.
    pub(super) fn density_of_canvas(self) -> f64 {
        self.finest_density().min(MAX_PATCH_SIDE / PIXELS_AT_ZOOM_1)
    }

    fn density_for_side(self, bounds: Rect) -> f64 {
        let side = bounds.width().max(bounds.height()) * self.base_scale();
        MAX_PATCH_SIDE / side.max(f64::MIN_POSITIVE)
    }

    /// The largest density of one subtree: its side, layers, patterns and filters each set a limit.
    pub(super) fn density_limit(self, subtree: &Subtree<'_>) -> f64 {
        let visible = subtree.bounds.intersect(self.canvas_rect());
        let cost = Cost::of_node(subtree.node, subtree.canvas_from_parent, self.canvas_size);
        let base = self.base_scale();
        // resvg makes layers as large as the subtree, but not arbitrarily larger than the pixmap.
        let layer_area = subtree.bounds.width().min(LAYER_OVERHANG * visible.width())
            * subtree
                .bounds
                .height()
                .min(LAYER_OVERHANG * visible.height());
        let layer_bytes = 4.0 * cost.layers * layer_area * base * base;
        let pattern_texels = cost.pattern_area * base * base;
        // Memory grows with the square of the density.
        let for_layers = (MAX_LAYER_BYTES / layer_bytes.max(f64::MIN_POSITIVE)).sqrt();
        let for_patterns = (MAX_PATTERN_TEXELS / pattern_texels.max(f64::MIN_POSITIVE)).sqrt();
        self.density_for_side(visible)
            .min(for_layers)
            .min(for_patterns)
            .min(cost.filter_density(base))
    }

    /// Texels of an image on `rect` at which each has a pixel at the largest zoom. No image needs more.
    pub(super) fn most_texels(self, rect: Rect) -> [u32; 2] {
        let scale = self.base_scale() * self.max_zoom;
        [rect.width(), rect.height()].map(|side| floor_u32((side * scale).ceil()).max(1))
    }

    /// Texels of the whole canvas at a density. They cover the canvas exactly, so they are not
    /// quite square.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positive; `as` saturates and the side limit keeps windows small"
    )]
    pub(super) fn lattice(self, density: f64) -> [u32; 2] {
        let scale = self.base_scale() * density;
        self.canvas_size
            .map(|side| (side * scale).ceil().max(1.0) as u32)
    }
}
