//! The walk over a usvg tree in painter's order.

use kurbo::{Affine, BezPath, Cap, Join, Rect};
use usvg::{BlendMode, Group, ImageKind, Node, PaintOrder};
use vtex_format::WarningCode;

use crate::BakeError;
use crate::drawing::{FillRule, Paint, Shape, ShapeSource};
use crate::stroke::{self, StrokeQuality, StrokeStyle};
use crate::svg::gradient::{self, has_too_many_stops};
use crate::svg::path::{affine, bez_path, close_subpaths, transformed_bounds};
use crate::svg::{Plan, Step, Subtree};
use crate::warning::Warnings;

/// Canvas sizes that a shape may reach beyond the canvas. usvg's coordinates are f32: further out
/// they are sixteenths of a canvas apart. A rectangle may still mean a ground without end, but the
/// arcs of a circle are noise there, and millions of them.
const MAX_REACH: f64 = 1_048_576.0;
/// Path elements of a shape that may reach further.
const MAX_FAR_ELEMENTS: usize = 256;
/// Path elements of all outlines together, strokes expanded; the stages that follow hold several
/// copies of each.
const MAX_OUTLINE_ELEMENTS: usize = 1 << 22;
/// Shapes of a translucent group that are compared with each other for overlap.
const MAX_FOLDED_SHAPES: usize = 64;

/// What of the options changes geometry and colours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WalkOptions {
    /// Largest magnification that strokes must stand.
    pub(crate) max_zoom: f64,
    /// Replaces fills.
    pub(crate) fill_color: Option<[f32; 4]>,
    /// Replaces strokes.
    pub(crate) stroke_color: Option<[f32; 4]>,
}

/// Sorts the tree into shapes and subtrees. What lies outside the canvas is left out.
///
/// # Errors
/// [`BakeError::Limit`] when outlines have too many elements together.
pub(crate) fn plan<'a>(
    tree: &'a usvg::Tree,
    options: WalkOptions,
    warnings: &Warnings,
) -> Result<Plan<'a>, BakeError> {
    let canvas_size = [tree.size().width(), tree.size().height()].map(f64::from);
    let mut walker = Walker {
        options,
        warnings,
        canvas: Rect::new(0.0, 0.0, canvas_size[0], canvas_size[1]),
        quality: StrokeQuality {
            canvas_longer_side: canvas_size[0].max(canvas_size[1]),
            max_zoom: options.max_zoom,
        },
        steps: Vec::new(),
        element_count: 0,
    };
    let place = Place {
        canvas_from_user: Affine::IDENTITY,
        opacity: 1.0,
        element: "",
    };
    walker.children(tree.root(), place);
    if walker.element_count > MAX_OUTLINE_ELEMENTS {
        return Err(BakeError::Limit(format!(
            "outlines have more than {MAX_OUTLINE_ELEMENTS} path elements"
        )));
    }
    Ok(Plan {
        canvas_size,
        steps: walker.steps,
    })
}

struct Walker<'a, 'w> {
    options: WalkOptions,
    warnings: &'w Warnings,
    canvas: Rect,
    quality: StrokeQuality,
    steps: Vec<Step<'a>>,
    /// Path elements of all shapes so far; past the limit nothing more is made.
    element_count: usize,
}

/// What ancestors hand down.
#[derive(Clone, Copy)]
struct Place<'a> {
    canvas_from_user: Affine,
    /// Of folded groups. Below 1 everything further down is plain, see [`Walker::folds`].
    opacity: f32,
    element: &'a str,
}

impl<'a> Place<'a> {
    fn named(self, id: &'a str) -> Self {
        Self {
            element: if id.is_empty() { self.element } else { id },
            ..self
        }
    }
}

impl<'a> Walker<'a, '_> {
    fn children(&mut self, group: &'a Group, place: Place<'a>) {
        for node in group.children() {
            if self.element_count > MAX_OUTLINE_ELEMENTS {
                return;
            }
            self.node(node, place);
        }
    }

    fn node(&mut self, node: &'a Node, place: Place<'a>) {
        let place = place.named(node.id());
        match node {
            Node::Group(group) => self.group(node, group, place),
            Node::Path(path) => self.path(node, path, place),
            Node::Image(image) => {
                if image.is_visible() {
                    self.raster(node, place, "image", false);
                }
            }
            Node::Text(text) => match self.first_foreign(text.flattened()) {
                Some(feature) => self.raster(node, place, feature, false),
                None => {
                    let canvas_from_user =
                        place.canvas_from_user * affine(text.flattened().transform());
                    self.children(
                        text.flattened(),
                        Place {
                            canvas_from_user,
                            ..place
                        },
                    );
                }
            },
        }
    }

    fn group(&mut self, node: &'a Node, group: &'a Group, place: Place<'a>) {
        if group.blend_mode() != BlendMode::Normal {
            return self.raster(node, place, "mix-blend-mode", true);
        }
        if let Some(feature) = effect(group) {
            return self.raster(node, place, feature, false);
        }
        if group.isolate() && holds_open_blend(group) {
            return self.raster(node, place, "isolation", false);
        }
        let mut opacity = place.opacity;
        if group.opacity() != usvg::Opacity::ONE {
            if opacity >= 1.0 && !self.folds(group) {
                return self.raster(node, place, "opacity", false);
            }
            opacity *= group.opacity().get();
        }
        let canvas_from_user = place.canvas_from_user * affine(group.transform());
        self.children(
            group,
            Place {
                canvas_from_user,
                opacity,
                ..place
            },
        );
    }

    fn path(&mut self, node: &'a Node, path: &'a usvg::Path, place: Place<'a>) {
        if !path.is_visible() {
            return;
        }
        if let Some(feature) = self.foreign_paint(path) {
            return self.raster(node, place, feature, false);
        }
        match path.paint_order() {
            PaintOrder::FillAndStroke => {
                self.fill(path, place);
                self.stroke(path, place);
            }
            PaintOrder::StrokeAndFill => {
                self.stroke(path, place);
                self.fill(path, place);
            }
        }
    }

    fn fill(&mut self, path: &usvg::Path, place: Place<'a>) {
        let bounds = path.data().bounds();
        let Some(fill) = path.fill() else { return };
        if bounds.width() <= 0.0 || bounds.height() <= 0.0 {
            return;
        }
        let outline = place.canvas_from_user * close_subpaths(&bez_path(path.data()));
        let fill_rule = match fill.rule() {
            usvg::FillRule::NonZero => FillRule::NonZero,
            usvg::FillRule::EvenOdd => FillRule::EvenOdd,
        };
        let opacity = fill.opacity().get() * place.opacity;
        let paint = self.paint(fill.paint(), self.options.fill_color, opacity, place);
        self.shape(outline, fill_rule, paint, ShapeSource::Fill, place);
    }

    fn stroke(&mut self, path: &usvg::Path, place: Place<'a>) {
        let Some(stroke) = path.stroke() else { return };
        let style = stroke_style(stroke);
        let line = bez_path(path.data());
        let Some(expanded) = stroke::expand(&line, &style, place.canvas_from_user, self.quality)
        else {
            return;
        };
        if expanded.opacity < 1.0 {
            let message = "too many dashes, drawn as a continuous line of their mean opacity";
            let code = WarningCode::PathFallback;
            self.warnings
                .push(code, "stroke-dasharray", place.element, message);
        }
        if stroke.linejoin() == usvg::LineJoin::MiterClip {
            let message = "miter-clip joins are drawn as miter joins";
            let code = WarningCode::PathFallback;
            self.warnings
                .push(code, "stroke-linejoin", place.element, message);
        }
        let opacity = stroke.opacity().get() * place.opacity * expanded.opacity;
        let paint = self.paint(stroke.paint(), self.options.stroke_color, opacity, place);
        self.shape(
            expanded.outline,
            FillRule::NonZero,
            paint,
            ShapeSource::Stroke,
            place,
        );
    }

    /// A replacement's own alpha multiplies the opacity of the shape.
    fn paint(
        &self,
        paint: &usvg::Paint,
        replacement: Option<[f32; 4]>,
        opacity: f32,
        place: Place<'a>,
    ) -> Option<Paint> {
        if let Some([r, g, b, a]) = replacement {
            return Some(Paint::Solid([r, g, b, a * opacity]));
        }
        let uv_from_canvas =
            Affine::scale_non_uniform(1.0 / self.canvas.width(), 1.0 / self.canvas.height());
        let uv_from_user = uv_from_canvas * place.canvas_from_user;
        match paint {
            usvg::Paint::Color(c) => {
                let [r, g, b] = [c.red, c.green, c.blue].map(|v| f32::from(v) / 255.0);
                Some(Paint::Solid([r, g, b, opacity]))
            }
            usvg::Paint::LinearGradient(it) => gradient::linear(it, opacity, uv_from_user),
            usvg::Paint::RadialGradient(it) => gradient::radial(it, opacity, uv_from_user),
            usvg::Paint::Pattern(_) => None,
        }
    }

    fn shape(
        &mut self,
        outline: BezPath,
        fill_rule: FillRule,
        paint: Option<Paint>,
        source: ShapeSource,
        place: Place<'a>,
    ) {
        let Some(paint) = paint.filter(Paint::shows) else {
            return;
        };
        let bounds = outline.control_box();
        if !outline.is_finite() || !self.shows(bounds) {
            return;
        }
        let reach = MAX_REACH * self.quality.canvas_longer_side;
        let far = bounds.abs().width().max(bounds.abs().height()) > reach;
        if far && outline.elements().len() > MAX_FAR_ELEMENTS {
            let message = "a shape reaches too far beyond the canvas and is left out";
            self.warnings
                .push(WarningCode::PathFallback, "path", place.element, message);
            return;
        }
        self.element_count += outline.elements().len();
        let element = place.element.to_owned();
        self.steps.push(Step::Shape(Shape {
            outline,
            fill_rule,
            paint,
            source,
            element,
        }));
    }

    fn raster(&mut self, node: &'a Node, place: Place<'a>, feature: &'static str, blends: bool) {
        let bounds = layer_bounds(node, place.canvas_from_user);
        if !bounds.is_finite() || !self.shows(bounds) {
            return;
        }
        self.steps.push(Step::Raster(Subtree {
            node,
            canvas_from_parent: place.canvas_from_user,
            bounds,
            blends,
            feature,
            element: place.element.to_owned(),
        }));
    }

    fn shows(&self, bounds: Rect) -> bool {
        bounds.x0 < self.canvas.x1
            && bounds.x1 > self.canvas.x0
            && bounds.y0 < self.canvas.y1
            && bounds.y1 > self.canvas.y0
    }

    /// The first paint of a visible path that no shape can have.
    fn foreign_paint(&self, path: &usvg::Path) -> Option<&'static str> {
        let fill = path.fill().filter(|_| self.options.fill_color.is_none());
        let stroke = path
            .stroke()
            .filter(|_| self.options.stroke_color.is_none());
        fill.and_then(|f| foreign(f.paint()))
            .or_else(|| stroke.and_then(|s| foreign(s.paint())))
    }

    /// The first thing in a group that is not a shape, opacity of groups included.
    fn first_foreign(&self, group: &Group) -> Option<&'static str> {
        group.children().iter().find_map(|node| match node {
            Node::Group(child) => effect(child)
                .or_else(|| (child.blend_mode() != BlendMode::Normal).then_some("mix-blend-mode"))
                .or_else(|| (child.opacity() != usvg::Opacity::ONE).then_some("opacity"))
                .or_else(|| self.first_foreign(child)),
            Node::Path(path) if path.is_visible() => self.foreign_paint(path),
            Node::Path(_) => None,
            Node::Image(image) => image.is_visible().then_some("image"),
            Node::Text(text) => self.first_foreign(text.flattened()),
        })
    }

    /// Whether multiplying the group's opacity into its shapes gives the same picture: all of it
    /// is shapes, and no two of them overlap.
    fn folds(&self, group: &Group) -> bool {
        let mut shapes = Vec::new();
        let own = affine(group.transform());
        self.gather(group, own, &mut shapes) && disjoint(&shapes)
    }

    /// Bounds of every shape; `false` when there is anything else or there are too many.
    fn gather(&self, group: &Group, transform: Affine, shapes: &mut Vec<Rect>) -> bool {
        group.children().iter().all(|node| match node {
            Node::Group(child) => {
                effect(child).is_none()
                    && child.blend_mode() == BlendMode::Normal
                    && self.gather(child, transform * affine(child.transform()), shapes)
            }
            Node::Path(path) if path.is_visible() => {
                let bounds = transformed_bounds(path.stroke_bounding_box(), transform);
                let parts =
                    usize::from(path.fill().is_some()) + usize::from(path.stroke().is_some());
                shapes.extend(std::iter::repeat_n(bounds, parts));
                shapes.len() <= MAX_FOLDED_SHAPES && self.foreign_paint(path).is_none()
            }
            Node::Path(_) => true,
            Node::Image(image) => !image.is_visible(),
            Node::Text(text) => {
                self.first_foreign(text.flattened()).is_none() && {
                    let inner = affine(text.flattened().transform());
                    self.gather(text.flattened(), transform * inner, shapes)
                }
            }
        })
    }
}

fn disjoint(shapes: &[Rect]) -> bool {
    let meet = |a: &Rect, b: &Rect| a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
    shapes
        .iter()
        .enumerate()
        .all(|(i, a)| shapes[..i].iter().all(|b| !meet(a, b)))
}

/// What makes a group's picture more than the sum of its shapes, opacity and blending aside.
fn effect(group: &Group) -> Option<&'static str> {
    if !group.filters().is_empty() {
        Some("filter")
    } else if group.mask().is_some() {
        Some("mask")
    } else if group.clip_path().is_some() {
        Some("clipPath")
    } else {
        None
    }
}

/// Whether something in the group blends with what is behind it inside the group.
fn holds_open_blend(group: &Group) -> bool {
    group.children().iter().any(|node| match node {
        Node::Group(child) => {
            child.blend_mode() != BlendMode::Normal
                || (!child.should_isolate() && holds_open_blend(child))
        }
        _ => false,
    })
}

fn foreign(paint: &usvg::Paint) -> Option<&'static str> {
    match paint {
        usvg::Paint::Color(_) => None,
        usvg::Paint::LinearGradient(it) => has_too_many_stops(it).then_some("linearGradient"),
        usvg::Paint::RadialGradient(it) => has_too_many_stops(it).then_some("radialGradient"),
        usvg::Paint::Pattern(_) => Some("pattern"),
    }
}

fn stroke_style(stroke: &usvg::Stroke) -> StrokeStyle {
    StrokeStyle {
        width: f64::from(stroke.width().get()),
        cap: match stroke.linecap() {
            usvg::LineCap::Butt => Cap::Butt,
            usvg::LineCap::Round => Cap::Round,
            usvg::LineCap::Square => Cap::Square,
        },
        join: match stroke.linejoin() {
            usvg::LineJoin::Miter | usvg::LineJoin::MiterClip => Join::Miter,
            usvg::LineJoin::Round => Join::Round,
            usvg::LineJoin::Bevel => Join::Bevel,
        },
        miter_limit: f64::from(stroke.miterlimit().get()),
        dashes: stroke
            .dasharray()
            .unwrap_or_default()
            .iter()
            .copied()
            .map(f64::from)
            .collect(),
        dash_offset: f64::from(stroke.dashoffset()),
    }
}

/// What a node may touch. usvg's `abs_*` boxes are not used: they are wrong inside the groups it
/// makes for colour glyphs.
fn layer_bounds(node: &Node, canvas_from_parent: Affine) -> Rect {
    match node {
        Node::Group(group) => {
            let canvas_from_group = canvas_from_parent * affine(group.transform());
            transformed_bounds(group.layer_bounding_box().to_rect(), canvas_from_group)
        }
        Node::Image(image) => match image.kind() {
            // A nested SVG may draw outside its viewport when `overflow` says so.
            ImageKind::SVG(tree) => {
                let inner = transformed_bounds(
                    tree.root().layer_bounding_box().to_rect(),
                    canvas_from_parent,
                );
                inner.union(transformed_bounds(image.bounding_box(), canvas_from_parent))
            }
            _ => transformed_bounds(image.bounding_box(), canvas_from_parent),
        },
        Node::Path(_) | Node::Text(_) => {
            transformed_bounds(node.stroke_bounding_box(), canvas_from_parent)
        }
    }
}
