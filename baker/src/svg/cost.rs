//! What painting a subtree asks of memory, known before resvg allocates any of it.

use kurbo::Affine;
use usvg::{Group, ImageKind, Node, Paint, Pattern};

use crate::svg::path::affine;

/// Memory needs of a subtree, to be scaled by the texels it is painted at.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Cost {
    /// Layers of the subtree's size that exist at the same time.
    pub(crate) layers: f64,
    /// Area of the largest pattern tile, in square user units of the canvas.
    pub(crate) pattern_area: f64,
}

impl Cost {
    /// Of a node whose parent has the given transform.
    pub(crate) fn of_node(node: &Node, canvas_from_parent: Affine) -> Self {
        match node {
            Node::Group(group) => Self::of_group(group, canvas_from_parent),
            Node::Path(path) => {
                let fill = path.fill().map(usvg::Fill::paint);
                let stroke = path.stroke().map(usvg::Stroke::paint);
                let paints = fill.into_iter().chain(stroke);
                paints
                    .map(|p| Self::of_paint(p, canvas_from_parent))
                    .fold(Self::default(), Self::max)
            }
            Node::Image(image) => match image.kind() {
                ImageKind::SVG(tree) => {
                    Self::of_group(tree.root(), canvas_from_parent).plus_layers(1.0)
                }
                _ => Self::default(),
            },
            Node::Text(text) => Self::of_group(text.flattened(), canvas_from_parent),
        }
    }

    fn of_group(group: &Group, canvas_from_parent: Affine) -> Self {
        let canvas_from_group = canvas_from_parent * affine(group.transform());
        let children = group
            .children()
            .iter()
            .map(|n| Self::of_node(n, canvas_from_group));
        let mut cost = children.fold(Self::default(), Self::max);
        // A mask or clip path is painted while the group's own layer waits.
        if let Some(mask) = group.mask() {
            let links = std::iter::successors(Some(mask), |m| m.mask()).count();
            let inner = Self::of_group(mask.root(), canvas_from_group);
            cost = cost.max(inner.plus_layers(links as f64));
        }
        if let Some(clip) = group.clip_path() {
            let links = std::iter::successors(Some(clip), |c| c.clip_path()).count();
            cost =
                cost.max(Self::of_group(clip.root(), canvas_from_group).plus_layers(links as f64));
        }
        // Filters keep named results besides source and result.
        let filter_layers: usize = group
            .filters()
            .iter()
            .map(|f| f.primitives().len() + 2)
            .max()
            .unwrap_or(0);
        let own = if group.should_isolate() { 1.0 } else { 0.0 };
        cost.plus_layers(own + filter_layers as f64)
    }

    fn of_paint(paint: &Paint, canvas_from_user: Affine) -> Self {
        match paint {
            Paint::Pattern(pattern) => Self::of_pattern(pattern, canvas_from_user),
            Paint::Color(_) | Paint::LinearGradient(_) | Paint::RadialGradient(_) => {
                Self::default()
            }
        }
    }

    fn of_pattern(pattern: &Pattern, canvas_from_user: Affine) -> Self {
        let [a, b, c, d, _, _] = (canvas_from_user * affine(pattern.transform())).as_coeffs();
        let (scale_x, scale_y) = (a.hypot(b), c.hypot(d));
        let rect = pattern.rect();
        let area = f64::from(rect.width()) * scale_x * f64::from(rect.height()) * scale_y;
        let inner = Self::of_group(pattern.root(), Affine::scale_non_uniform(scale_x, scale_y));
        inner.max(Self {
            layers: 0.0,
            pattern_area: area,
        })
    }

    fn max(self, other: Self) -> Self {
        Self {
            layers: self.layers.max(other.layers),
            pattern_area: self.pattern_area.max(other.pattern_area),
        }
    }

    fn plus_layers(self, layers: f64) -> Self {
        Self {
            layers: self.layers + layers,
            ..self
        }
    }
}
