//! The walk over a usvg tree in painter's order.

mod clip;
mod fold;
mod gradient;
mod group;
mod pattern;
mod recolor;
mod style;

use kurbo::{Affine, BezPath, Rect};
use usvg::{Group, ImageKind, Node, PaintOrder};
use vtex_format::{MAX_FRAMES, WarningCode};

use crate::{
    BakeError,
    drawing::{
        FillRule, Paint, Shape, ShapeSource,
        tree::{self, Tree},
    },
    geometry::stroke::{self, StrokeQuality},
    raster::native::{self, Native},
    svg::{
        Plan, Step, Subtree,
        path::{affine, bez_path, close_subpaths, transformed_bounds},
        walk::{
            gradient::has_too_many_stops,
            group::{Effects, holds_open_blend},
            recolor::Recolor,
            style::stroke_style,
        },
    },
    warning::Warnings,
};

/// Canvas sizes that a shape may reach beyond the canvas. usvg's coordinates are f32: further out
/// they are sixteenths of a canvas apart. A rectangle may still mean a ground without end, but the
/// arcs of a circle are noise there, and millions of them.
const MAX_REACH: f64 = 1_048_576.0;
/// Path elements of a shape that may reach further.
const MAX_FAR_ELEMENTS: usize = 256;
/// Path elements of all outlines together, strokes expanded; the stages that follow hold several
/// copies of each.
const MAX_OUTLINE_ELEMENTS: usize = 1 << 22;
/// Frames of an evaluator that groups and clips around an item may take; the rest is for what a list
/// of one cell adds.
const MAX_DEPTH: u32 = MAX_FRAMES - 2;

/// What of the options changes geometry and colours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WalkOptions {
    /// Pixels along the canvas' longer side at the largest zoom, for which strokes must be right.
    pub(crate) longer_side_px: f64,
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
    let canvas = Rect::new(0.0, 0.0, canvas_size[0], canvas_size[1]);
    let mut walker = Walker {
        options,
        warnings,
        canvas,
        window: canvas,
        quality: StrokeQuality {
            canvas_longer_side: canvas_size[0].max(canvas_size[1]),
            longer_side_px: options.longer_side_px,
        },
        steps: Vec::new(),
        nodes: Vec::new(),
        element_count: 0,
    };
    let place = Place {
        canvas_from_user: Affine::IDENTITY,
        opacity: 1.0,
        depth: 0,
        recolor: None,
        element: "",
    };
    walker.children(tree.root(), place);
    if walker.element_count > MAX_OUTLINE_ELEMENTS {
        return Err(BakeError::Limit(format!(
            "outlines have more than {MAX_OUTLINE_ELEMENTS} path elements"
        )));
    }
    native::share_out(walker.steps.iter_mut().filter_map(|step| match step {
        Step::Raster(subtree) => Some(&mut subtree.native),
        Step::Shape(_) | Step::Clip(_) => None,
    }));
    Ok(Plan {
        canvas_size,
        steps: walker.steps,
        tree: Tree {
            roots: walker.nodes,
        },
    })
}

/// The steps so far, and the nodes of the group that is being walked.
pub(super) struct Walker<'a, 'w> {
    pub(super) options: WalkOptions,
    pub(super) warnings: &'w Warnings,
    pub(super) canvas: Rect,
    /// What outlines have to meet to be kept: the canvas, unless they are copied elsewhere.
    pub(super) window: Rect,
    quality: StrokeQuality,
    pub(super) steps: Vec<Step<'a>>,
    pub(super) nodes: Vec<tree::Node>,
    /// Path elements of all outlines so far; past the limit nothing more is made.
    pub(super) element_count: usize,
}

/// What ancestors hand down.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) canvas_from_user: Affine,
    /// Of folded groups. Below 1 everything further down is plain, see [`Walker::folds`].
    pub(super) opacity: f32,
    /// Frames that evaluators need for the groups around it.
    pub(super) depth: u32,
    /// What a filter around it does to colours.
    recolor: Option<Recolor>,
    pub(super) element: &'a str,
}

impl<'a> Place<'a> {
    fn named(self, id: &'a str) -> Self {
        Self {
            element: if id.is_empty() { self.element } else { id },
            ..self
        }
    }

    /// Inside a group that takes so many frames; `None` when there are too many.
    pub(super) fn deeper(self, frames: u32) -> Option<Self> {
        let depth = self.depth.saturating_add(frames);
        (depth <= MAX_DEPTH).then_some(Self { depth, ..self })
    }
}

impl<'a> Walker<'a, '_> {
    pub(super) fn children(&mut self, group: &'a Group, place: Place<'a>) {
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
            Node::Image(image) => match image.kind() {
                _ if !image.is_visible() => {}
                ImageKind::SVG(tree) => self.nested(node, tree, place),
                _ => {
                    let native = Native::of(image, place.canvas_from_user);
                    self.raster_with(node, place, "image", native);
                }
            },
            Node::Text(text) => self.group(node, text.flattened(), place),
        }
    }

    fn path(&mut self, node: &'a Node, path: &'a usvg::Path, place: Place<'a>) {
        if !path.is_visible() {
            return;
        }
        if let Some(feature) = self.raster_paint(path, place) {
            return self.raster(node, place, feature);
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

    fn fill(&mut self, path: &'a usvg::Path, place: Place<'a>) {
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
        if let (usvg::Paint::Pattern(pattern), None) = (fill.paint(), self.options.fill_color) {
            return self.pattern(pattern, outline, fill_rule, opacity, place);
        }
        let paint = self.paint(fill.paint(), self.options.fill_color, opacity, place);
        self.shape(outline, fill_rule, paint, ShapeSource::Fill, place);
    }

    fn stroke(&mut self, path: &'a usvg::Path, place: Place<'a>) {
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
        if let (usvg::Paint::Pattern(pattern), None) = (stroke.paint(), self.options.stroke_color) {
            let rule = FillRule::NonZero;
            return self.pattern(pattern, expanded.outline, rule, opacity, place);
        }
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
        let paint = match place.recolor {
            Some(recolor) => paint.mapped(|color| recolor.apply(color)),
            None => paint,
        };
        let bounds = outline.control_box();
        if !outline.is_finite() || !self.shows(bounds) {
            return;
        }
        if self.is_too_far(&outline, place.element) {
            return;
        }
        self.element_count += outline.elements().len();
        let element = place.element.to_owned();
        self.show(Step::Shape(Shape {
            outline,
            fill_rule,
            paint,
            source,
            element,
        }));
    }

    /// Whether a shape is left out because of its reach; warns.
    pub(super) fn is_too_far(&self, outline: &BezPath, element: &str) -> bool {
        let bounds = outline.control_box();
        let reach = MAX_REACH * self.quality.canvas_longer_side;
        let far = bounds.abs().width().max(bounds.abs().height()) > reach;
        let left_out = far && outline.elements().len() > MAX_FAR_ELEMENTS;
        if left_out {
            let message = "a shape reaches too far beyond the canvas and is left out";
            self.warnings
                .push(WarningCode::PathFallback, "path", element, message);
        }
        left_out
    }

    /// Number that the next item gets.
    pub(super) fn next_item(&self) -> u32 {
        u32::try_from(self.steps.len()).unwrap_or(u32::MAX)
    }

    /// Adds an item, which shows nothing by itself.
    pub(super) fn add(&mut self, step: Step<'a>) -> u32 {
        let item = self.next_item();
        self.steps.push(step);
        item
    }

    /// Adds an item that is painted here.
    pub(super) fn show(&mut self, step: Step<'a>) {
        let item = self.add(step);
        self.nodes.push(tree::Node::Item(item));
    }

    /// An SVG in an `image`, which blends with nothing outside.
    fn nested(&mut self, node: &'a Node, tree: &'a usvg::Tree, place: Place<'a>) {
        if !holds_open_blend(tree.root()) {
            return self.children(tree.root(), place);
        }
        let Some(inner) = place.deeper(1) else {
            return self.raster(node, place, "nesting");
        };
        let effects = Effects {
            isolated: true,
            ..Effects::default()
        };
        self.scope(self.next_item(), effects, |walker| {
            walker.children(tree.root(), inner);
        });
    }

    pub(super) fn raster(&mut self, node: &'a Node, place: Place<'a>, feature: &'static str) {
        self.raster_with(node, place, feature, None);
    }

    fn raster_with(
        &mut self,
        node: &'a Node,
        place: Place<'a>,
        feature: &'static str,
        native: Option<Native>,
    ) {
        let bounds = layer_bounds(node, place.canvas_from_user);
        if !bounds.is_finite() || !self.shows(bounds) {
            return;
        }
        self.show(Step::Raster(Subtree {
            node,
            canvas_from_parent: place.canvas_from_user,
            bounds,
            native,
            feature,
            element: own_id(node).unwrap_or(place.element).to_owned(),
        }));
    }

    pub(super) fn shows(&self, bounds: Rect) -> bool {
        bounds.x0 < self.window.x1
            && bounds.x1 > self.window.x0
            && bounds.y0 < self.window.y1
            && bounds.y1 > self.window.y0
    }

    /// The first paint of a visible path that no shape can have.
    pub(super) fn foreign_paint(&self, path: &usvg::Path) -> Option<&'static str> {
        let fill = path.fill().filter(|_| self.options.fill_color.is_none());
        let stroke = path
            .stroke()
            .filter(|_| self.options.stroke_color.is_none());
        fill.and_then(|f| foreign(f.paint()))
            .or_else(|| stroke.and_then(|s| foreign(s.paint())))
    }

    /// What of a path's paints resvg has to draw.
    fn raster_paint(&self, path: &usvg::Path, place: Place<'_>) -> Option<&'static str> {
        self.foreign_paint(path)
            .filter(|&feature| feature != "pattern" || !self.expands_patterns(path, place))
    }
}

fn foreign(paint: &usvg::Paint) -> Option<&'static str> {
    match paint {
        usvg::Paint::Color(_) => None,
        usvg::Paint::LinearGradient(it) => has_too_many_stops(it).then_some("linearGradient"),
        usvg::Paint::RadialGradient(it) => has_too_many_stops(it).then_some("radialGradient"),
        usvg::Paint::Pattern(_) => Some("pattern"),
    }
}

/// The id of a node, or of the one that it stands for: usvg puts groups around what has effects and
/// leaves the id inside.
fn own_id(node: &Node) -> Option<&str> {
    let inner = match node {
        Node::Group(group) => match group.children() {
            [only] if group.id().is_empty() => own_id(only),
            _ => None,
        },
        _ => None,
    };
    inner.or_else(|| Some(node.id()).filter(|id| !id.is_empty()))
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
