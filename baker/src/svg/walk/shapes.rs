//! Paths: a fill and a stroke each become a shape.

use kurbo::{Affine, BezPath};
use usvg::{Node, PaintOrder};
use vtex_format::WarningCode;

use super::{
    gradient::{self, has_too_many_stops},
    style::{fill_rule, stroke_style},
    walker::{Place, Walker},
};
use crate::{
    drawing::{FillRule, Paint, Shape, ShapeSource},
    geometry::stroke,
    svg::{
        path::{bez_path, close_subpaths},
        plan::PlanItem,
    },
};

impl<'a> Walker<'a, '_> {
    /// Adds a path as shapes, or as a subtree if no shape can have its paint.
    pub(super) fn path(&mut self, node: &'a Node, path: &'a usvg::Path, place: Place<'a>) {
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
        // No area to fill. A stroke may still show.
        if bounds.width() <= 0.0 || bounds.height() <= 0.0 {
            return;
        }
        let outline = place.canvas_from_user * close_subpaths(&bez_path(path.data()));
        let rule = fill_rule(fill.rule());
        let opacity = fill.opacity().get() * place.opacity;
        if let (usvg::Paint::Pattern(pattern), None) = (fill.paint(), self.options.fill_color) {
            return self.pattern(pattern, outline, rule, opacity, place);
        }
        let paint = self.paint(fill.paint(), self.options.fill_color, opacity, place);
        self.shape(outline, rule, paint, ShapeSource::Fill, place);
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

    /// The paint of a shape. The alpha of a replacement multiplies the shape's opacity.
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

    /// Adds a shape, if any of it shows.
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
        // Recoloured here, after the opacity is folded in: the change keeps alpha.
        let paint = match place.recolor {
            Some(recolor) => paint.mapped(|color| recolor.apply(color)),
            None => paint,
        };
        let bounds = outline.control_box();
        // Transforms of an SVG can overflow.
        if !outline.is_finite() || !self.shows(bounds) {
            return;
        }
        if self.is_too_far(&outline, place.element) {
            return;
        }
        self.element_count += outline.elements().len();
        let element = place.element.to_owned();
        self.show(PlanItem::Shape(Shape {
            outline,
            fill_rule,
            paint,
            source,
            element,
        }));
    }

    /// The feature of the path's first paint that is neither a colour nor a gradient of few stops.
    pub(super) fn foreign_paint(&self, path: &usvg::Path) -> Option<&'static str> {
        let fill = path.fill().filter(|_| self.options.fill_color.is_none());
        let stroke = path
            .stroke()
            .filter(|_| self.options.stroke_color.is_none());
        fill.and_then(|f| foreign(f.paint()))
            .or_else(|| stroke.and_then(|s| foreign(s.paint())))
    }

    /// The feature of a paint for which resvg has to paint the path.
    fn raster_paint(&self, path: &usvg::Path, place: Place<'_>) -> Option<&'static str> {
        self.foreign_paint(path)
            .filter(|&feature| feature != "pattern" || !self.expands_patterns(path, place))
    }
}

/// The feature of a paint that no shape can have directly. Patterns can often be expanded.
fn foreign(paint: &usvg::Paint) -> Option<&'static str> {
    match paint {
        usvg::Paint::Color(_) => None,
        usvg::Paint::LinearGradient(it) => has_too_many_stops(it).then_some("linearGradient"),
        usvg::Paint::RadialGradient(it) => has_too_many_stops(it).then_some("radialGradient"),
        usvg::Paint::Pattern(_) => Some("pattern"),
    }
}
