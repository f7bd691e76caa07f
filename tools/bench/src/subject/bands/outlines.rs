//! Outlines of a parsed SVG as lines and quadratics in uv.

use kurbo::{CubicBez, Point};
use resvg::tiny_skia::{Path, PathSegment, PathStroker, Transform};
use resvg::usvg::{self, BlendMode, Node, Paint, PaintOrder};
use vtex_shaders::srgb;

/// How far a quadratic may be from its cubic, in uv: a sixteenth of a texel of 4096.
const ACCURACY: f64 = 1.0 / 65536.0;

/// First end, control point, last end. The control point of a line is its first end.
pub(super) type Curve = [[f32; 2]; 3];

/// An outline with one colour.
pub(super) struct Outline {
    /// Linear light, premultiplied.
    pub(super) color: [f32; 4],
    pub(super) even_odd: bool,
    /// None is empty; each is closed.
    pub(super) contours: Vec<Vec<Curve>>,
}

/// All fills and strokes, back to front, and what is left out.
pub(super) fn outlines(tree: &usvg::Tree) -> (Vec<Outline>, Vec<&'static str>) {
    let canvas = tree.size();
    let mut walk = Walk {
        uv: Transform::from_scale(1.0 / canvas.width(), 1.0 / canvas.height()),
        outlines: Vec::new(),
        left_out: Vec::new(),
    };
    walk.group(tree.root(), 1.0);
    (walk.outlines, walk.left_out)
}

struct Walk {
    uv: Transform,
    outlines: Vec<Outline>,
    left_out: Vec<&'static str>,
}

impl Walk {
    fn leave_out(&mut self, what: &'static str) {
        if !self.left_out.contains(&what) {
            self.left_out.push(what);
        }
    }

    fn group(&mut self, group: &usvg::Group, opacity: f32) {
        let own = group.opacity().get();
        let missing = [
            (group.clip_path().is_some(), "clips"),
            (group.mask().is_some(), "masks"),
            (!group.filters().is_empty(), "filters"),
            (group.blend_mode() != BlendMode::Normal, "blend modes"),
            (
                own < 1.0,
                "groups as one (their opacity goes to each shape)",
            ),
        ];
        for (_, what) in missing.iter().filter(|(is_there, _)| *is_there) {
            self.leave_out(what);
        }
        for node in group.children() {
            match node {
                Node::Group(group) => self.group(group, opacity * own),
                Node::Path(path) => self.path(path, opacity * own),
                Node::Text(text) => self.group(text.flattened(), opacity * own),
                Node::Image(_) => self.leave_out("images"),
            }
        }
    }

    fn path(&mut self, path: &usvg::Path, opacity: f32) {
        if !path.is_visible() {
            return;
        }
        match path.paint_order() {
            PaintOrder::FillAndStroke => {
                self.fill(path, opacity);
                self.stroke(path, opacity);
            }
            PaintOrder::StrokeAndFill => {
                self.stroke(path, opacity);
                self.fill(path, opacity);
            }
        }
    }

    fn fill(&mut self, path: &usvg::Path, opacity: f32) {
        if let Some(fill) = path.fill() {
            let even_odd = fill.rule() == usvg::FillRule::EvenOdd;
            let opacity = opacity * fill.opacity().get();
            let outline = path.data().clone();
            self.add(
                outline,
                path.abs_transform(),
                even_odd,
                (fill.paint(), opacity),
            );
        }
    }

    fn stroke(&mut self, path: &usvg::Path, opacity: f32) {
        let Some(stroke) = path.stroke() else { return };
        let to_canvas = path.abs_transform();
        // As fine as a raster of 4096 draws it.
        let texels = to_canvas.post_concat(self.uv).post_scale(4096.0, 4096.0);
        let scale = PathStroker::compute_resolution_scale(&texels);
        let pen = stroke.to_tiny_skia();
        let dashed = pen.dash.as_ref().map(|dash| path.data().dash(dash, scale));
        let outline = match &dashed {
            Some(Some(dashed)) => dashed.stroke(&pen, scale),
            Some(None) => None,
            None => path.data().stroke(&pen, scale),
        };
        if let Some(outline) = outline {
            let opacity = opacity * stroke.opacity().get();
            self.add(outline, to_canvas, false, (stroke.paint(), opacity));
        }
    }

    fn add(&mut self, path: Path, to_canvas: Transform, even_odd: bool, paint: (&Paint, f32)) {
        let Some(color) = self.color(paint.0, paint.1) else {
            return;
        };
        if let Some(path) = path.transform(to_canvas.post_concat(self.uv)) {
            self.outlines.push(Outline {
                color,
                even_odd,
                contours: contours(&path),
            });
        }
    }

    fn color(&mut self, paint: &Paint, opacity: f32) -> Option<[f32; 4]> {
        let bytes = |color: usvg::Color| {
            [color.red, color.green, color.blue].map(|byte| f32::from(byte) / 255.0)
        };
        let stops = match paint {
            Paint::Color(color) => return Some(premultiplied(bytes(*color), opacity)),
            Paint::LinearGradient(gradient) => gradient.stops(),
            Paint::RadialGradient(gradient) => gradient.stops(),
            Paint::Pattern(_) => {
                self.leave_out("patterns");
                return None;
            }
        };
        self.leave_out("gradients (the mean of their stops instead)");
        let mut mean = [0.0; 4];
        for stop in stops {
            let color = premultiplied(bytes(stop.color()), opacity * stop.opacity().get());
            let share = 1.0 / stops.len() as f32;
            (0..4).for_each(|channel| mean[channel] += share * color[channel]);
        }
        Some(mean)
    }
}

/// Linear light from encoded values.
fn premultiplied(encoded: [f32; 3], opacity: f32) -> [f32; 4] {
    let [r, g, b] = encoded.map(|value| opacity * srgb::decode(value));
    [r, g, b, opacity]
}

fn contours(path: &Path) -> Vec<Vec<Curve>> {
    let point = |p: resvg::tiny_skia::Point| [p.x, p.y];
    let mut contours: Vec<Vec<Curve>> = vec![Vec::new()];
    let [mut start, mut pen] = [[0.0; 2]; 2];
    for segment in path.segments() {
        let from = pen;
        let contour = contours.last_mut();
        let Some(contour) = contour else { continue };
        match segment {
            PathSegment::MoveTo(to) => {
                close(contour, start);
                start = point(to);
                pen = start;
                contours.push(Vec::new());
            }
            PathSegment::LineTo(to) => {
                pen = point(to);
                contour.push([from, from, pen]);
            }
            PathSegment::QuadTo(control, to) => {
                pen = point(to);
                contour.push([from, point(control), pen]);
            }
            PathSegment::CubicTo(a, b, to) => {
                pen = point(to);
                add_cubic(contour, [from, point(a), point(b), pen]);
            }
            PathSegment::Close => {
                close(contour, start);
                pen = start;
                contours.push(Vec::new());
            }
        }
    }
    if let Some(contour) = contours.last_mut() {
        close(contour, start);
    }
    contours.retain(|contour| !contour.is_empty());
    contours
}

/// A fill closes what the drawing leaves open.
fn close(contour: &mut Vec<Curve>, start: [f32; 2]) {
    if let Some(&[.., end]) = contour.last()
        && end != start
    {
        contour.push([end, end, start]);
    }
}

fn add_cubic(contour: &mut Vec<Curve>, points: [[f32; 2]; 4]) {
    let [p0, p1, p2, p3] = points.map(|[x, y]| Point::new(f64::from(x), f64::from(y)));
    #[expect(clippy::cast_possible_truncation, reason = "the GPU has binary32")]
    let rounded = |point: Point| [point.x as f32, point.y as f32];
    let mut from = points[0];
    for (_, end, quad) in CubicBez::new(p0, p1, p2, p3).to_quads(ACCURACY) {
        // Ends meet exactly: the next curve begins with the bits of this one's end.
        let to = if end >= 1.0 {
            points[3]
        } else {
            rounded(quad.p2)
        };
        contour.push([from, rounded(quad.p1), to]);
        from = to;
    }
}
