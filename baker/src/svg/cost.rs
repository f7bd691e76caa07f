//! Memory and time that resvg needs to paint a subtree, estimated before it starts.
//!
//! A few lines of SVG can ask for gigabytes or hours: a filter on a huge region, a mask in a mask
//! in a mask, a pattern of patterns. Too much for the whole file is an error; too much for one
//! patch makes the patch coarser.

use kurbo::Affine;
use usvg::filter::{Filter, Kind};
use usvg::{Group, ImageKind, Node, Paint, Pattern};

use crate::svg::path::{affine, transformed_bounds};

/// Nanoseconds that resvg spends on a texel of a filter primitive. A blur takes the longest of the
/// ordinary ones.
const PRIMITIVE_NS: f64 = 60.0;
/// Nanoseconds on a texel of `feTurbulence`, for each octave.
const OCTAVE_NS: f64 = 100.0;
/// Nanoseconds on a sample of the window of `feMorphology` or `feConvolveMatrix`. resvg visits
/// every sample of the window for every texel.
const SAMPLE_NS: f64 = 2.0;
/// Largest side of a filter region, in canvases: resvg makes no larger layers.
const MAX_REGION_CANVASES: f64 = 5.0;

/// Nanoseconds that the filters of one patch may take on one core. A patch that needs more gets
/// coarser.
const MAX_PATCH_FILTER_NS: f64 = 5e9;

/// What a subtree needs, for one texel in a square user unit of the canvas. The caller scales it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Cost {
    /// Most layers of the subtree's size that exist at the same time.
    pub(crate) layers: f64,
    /// Largest area of pattern tiles that exist at the same time, in square user units of the
    /// canvas.
    pub(crate) pattern_area: f64,
    /// Nanoseconds for all filters without windows.
    pub(crate) filter_ns: f64,
    /// Nanoseconds for filters with a window. The window grows with the scale as well, so their
    /// time grows with the square of the number of texels.
    pub(crate) window_ns: f64,
}

/// Canvas width and height in user units.
type Canvas = [f64; 2];

impl Cost {
    /// The cost of a node, by the transform of its parent.
    pub(crate) fn of_node(node: &Node, canvas_from_parent: Affine, canvas: Canvas) -> Self {
        match node {
            Node::Group(group) => Self::of_group(group, canvas_from_parent, canvas),
            Node::Path(path) => {
                let fill = path.fill().map(usvg::Fill::paint);
                let stroke = path.stroke().map(usvg::Stroke::paint);
                let paints = fill.into_iter().chain(stroke);
                paints
                    .map(|p| Self::of_paint(p, canvas_from_parent, canvas))
                    .fold(Self::default(), Self::beside)
            }
            Node::Image(image) => match image.kind() {
                ImageKind::SVG(tree) => {
                    Self::of_group(tree.root(), canvas_from_parent, canvas).plus_layers(1.0)
                }
                _ => Self::default(),
            },
            Node::Text(text) => Self::of_group(text.flattened(), canvas_from_parent, canvas),
        }
    }

    /// The cost of a group, by the transform of its parent.
    pub(crate) fn of_group(group: &Group, canvas_from_parent: Affine, canvas: Canvas) -> Self {
        let canvas_from_group = canvas_from_parent * affine(group.transform());
        let children = group
            .children()
            .iter()
            .map(|n| Self::of_node(n, canvas_from_group, canvas));
        let mut cost = children.fold(Self::default(), Self::beside);
        // A mask or clip path is painted while the layer of its group waits, and so is each mask on
        // a mask.
        if let Some(mask) = group.mask() {
            let links = std::iter::successors(Some(mask), |m| m.mask()).count();
            let inner = Self::of_group(mask.root(), canvas_from_group, canvas);
            cost = cost.beside(inner.plus_layers(links as f64));
        }
        if let Some(clip) = group.clip_path() {
            let links = std::iter::successors(Some(clip), |c| c.clip_path()).count();
            cost = cost.beside(
                Self::of_group(clip.root(), canvas_from_group, canvas).plus_layers(links as f64),
            );
        }
        // A filter keeps the result of every primitive, its source and its result.
        let filter_layers: usize = group
            .filters()
            .iter()
            .map(|f| f.primitives().len() + 2)
            .max()
            .unwrap_or(0);
        // An isolated group is painted on a layer of its own.
        let own = if group.should_isolate() { 1.0 } else { 0.0 };
        for filter in group.filters() {
            cost = cost.plus_filter(filter, canvas_from_group, canvas);
        }
        cost.plus_layers(own + filter_layers as f64)
    }

    /// Nanoseconds for filters, and for those with windows, at `scale` texels along a user unit.
    pub(crate) fn filter_work_ns(&self, scale: f64) -> [f64; 2] {
        [
            self.filter_ns * scale.powi(2),
            self.window_ns * scale.powi(4),
        ]
    }

    /// The largest multiple of `base` texels along a user unit at which the filters of one patch
    /// stay within their time.
    pub(crate) fn filter_density(&self, base: f64) -> f64 {
        let [filters, windows] = self
            .filter_work_ns(base)
            .map(|ns| MAX_PATCH_FILTER_NS / ns.max(f64::MIN_POSITIVE));
        filters.sqrt().min(windows.powf(0.25))
    }

    fn of_paint(paint: &Paint, canvas_from_user: Affine, canvas: Canvas) -> Self {
        match paint {
            Paint::Pattern(pattern) => Self::of_pattern(pattern, canvas_from_user, canvas),
            Paint::Color(_) | Paint::LinearGradient(_) | Paint::RadialGradient(_) => {
                Self::default()
            }
        }
    }

    fn of_pattern(pattern: &Pattern, canvas_from_user: Affine, canvas: Canvas) -> Self {
        let [a, b, c, d, _, _] = (canvas_from_user * affine(pattern.transform())).as_coeffs();
        let (scale_x, scale_y) = (a.hypot(b), c.hypot(d));
        let rect = pattern.rect();
        let area = f64::from(rect.width()) * scale_x * f64::from(rect.height()) * scale_y;
        let canvas_from_tile = Affine::scale_non_uniform(scale_x, scale_y);
        let inner = Self::of_group(pattern.root(), canvas_from_tile, canvas);
        // This tile waits while the tiles of patterns in it are painted.
        Self {
            pattern_area: inner.pattern_area + area,
            ..inner
        }
    }

    /// The cost of two things that are painted one after the other: they share memory but not time.
    fn beside(self, other: Self) -> Self {
        Self {
            layers: self.layers.max(other.layers),
            pattern_area: self.pattern_area.max(other.pattern_area),
            filter_ns: self.filter_ns + other.filter_ns,
            window_ns: self.window_ns + other.window_ns,
        }
    }

    fn plus_filter(self, filter: &Filter, canvas_from_group: Affine, canvas: Canvas) -> Self {
        let rect = filter.rect().to_rect();
        let region = transformed_bounds(rect, canvas_from_group);
        // The region is painted on layers, whose size resvg bounds.
        let area = region.width().min(MAX_REGION_CANVASES * canvas[0])
            * region.height().min(MAX_REGION_CANVASES * canvas[1]);
        let [a, b, c, d, _, _] = canvas_from_group.as_coeffs();
        let (scale_x, scale_y) = (a.hypot(b), c.hypot(d));
        let mut cost = self;
        for primitive in filter.primitives() {
            let (texel_ns, window_area) = match primitive.kind() {
                Kind::Turbulence(fe) => (f64::from(fe.num_octaves()) * OCTAVE_NS, 0.0),
                Kind::ConvolveMatrix(fe) => {
                    let samples = f64::from(fe.matrix().columns()) * f64::from(fe.matrix().rows());
                    (samples * SAMPLE_NS, 0.0)
                }
                Kind::Morphology(fe) => {
                    let width = 2.0 * f64::from(fe.radius_x().get()) * scale_x;
                    let height = 2.0 * f64::from(fe.radius_y().get()) * scale_y;
                    (SAMPLE_NS, (width * height).min(area))
                }
                // `PRIMITIVE_NS` covers all others.
                _ => (0.0, 0.0),
            };
            cost.filter_ns += area * (texel_ns + PRIMITIVE_NS);
            cost.window_ns += area * window_area * SAMPLE_NS;
        }
        cost
    }

    fn plus_layers(self, layers: f64) -> Self {
        Self {
            layers: self.layers + layers,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cost(content: &str) -> Cost {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'>{content}</svg>"
        );
        let tree = usvg::Tree::from_str(&svg, &usvg::Options::default()).unwrap();
        Cost::of_group(tree.root(), Affine::IDENTITY, [100.0, 100.0])
    }

    fn filtered(primitives: &str) -> Cost {
        cost(&format!(
            "<filter id='f' x='0' y='0' width='1' height='1'>{primitives}</filter>\
             <rect width='50' height='40' filter='url(#f)'/>\
             <rect x='50' width='50' height='40' filter='url(#f)'/>"
        ))
    }

    #[test]
    fn filters_cost_time_for_each_region() {
        let octaves = filtered("<feTurbulence baseFrequency='1' numOctaves='7'/>");
        assert_eq!(octaves.filter_ns, 2.0 * 2000.0 * (700.0 + PRIMITIVE_NS));
        let window = filtered("<feMorphology radius='2 3'/>");
        assert_eq!(window.window_ns, 2.0 * 2000.0 * 24.0 * SAMPLE_NS);
        let whole = filtered("<feMorphology radius='2000'/>");
        assert_eq!(whole.window_ns, 2.0 * 2000.0 * 2000.0 * SAMPLE_NS);
    }

    #[test]
    fn tiles_of_nested_patterns_add_up() {
        let nested = cost(
            "<pattern id='a' width='10' height='10' patternUnits='userSpaceOnUse'>\
             <rect width='9' height='9' fill='url(#b)'/></pattern>\
             <pattern id='b' width='5' height='5' patternUnits='userSpaceOnUse'>\
             <rect width='3' height='3'/></pattern><rect width='90' height='90' fill='url(#a)'/>",
        );
        assert_eq!(nested.pattern_area, 125.0);
    }
}
