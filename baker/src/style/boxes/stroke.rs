//! Strokes that depend on the shape that they follow: `pathLength`, and `non-scaling-stroke`.

use kurbo::{Affine, BezPath, Circle, Ellipse, Line, Point, RoundedRect, Shape as _};
use usvg::roxmltree::Node;

use super::{Boxes, attribute_matrix};
use crate::style::elements::{px, view_box};
use crate::style::syntax::{self, Value, words};
use crate::style::value::number_text;

/// How exactly curves are measured, in user units.
const EXACT: f64 = 1e-3;

/// Properties whose lengths are along or across a stroke, and their first values.
const LENGTHS: [(&str, &str); 3] = [
    ("stroke-width", "1"),
    ("stroke-dasharray", "none"),
    ("stroke-dashoffset", "0"),
];

impl Boxes<'_> {
    /// Writes dashes as long as `pathLength` makes them.
    pub(super) fn path_length(&mut self, node: Node<'_, '_>) -> Option<()> {
        let written: f64 = node.attribute("pathLength")?.trim().parse().ok()?;
        if written.is_nan() || written <= 0.0 {
            return None;
        }
        let factor = self.outline(node)?.perimeter(EXACT) / written;
        for (name, _) in LENGTHS.into_iter().skip(1) {
            if let Some(text) = self.nearest(node, name) {
                let scaled = scaled(text, factor)?;
                self.write(node, name, Some(scaled));
            }
        }
        Some(())
    }

    /// Whether the stroke of `node` is not to scale with it.
    pub(super) fn keeps_stroke(&self, node: Node<'_, '_>) -> bool {
        // Of groups it says nothing, and children do not inherit it.
        let is_group = matches!(node.tag_name().name(), "g" | "a" | "svg" | "use" | "switch");
        let effect = self.attribute(node, "vector-effect");
        !is_group && effect.is_some_and(|effect| effect.eq_ignore_ascii_case("non-scaling-stroke"))
    }

    /// Makes the stroke of `node` as wide as on the canvas at its natural scale; `None` where the
    /// matrix to the canvas is not known, or other things are drawn in the shape's coordinates.
    pub(super) fn unscaled_stroke(&mut self, node: Node<'_, '_>) -> Option<()> {
        let outer = self.matrix_to_root(node.parent_element()?)?;
        let own = match self.attribute(node, "transform") {
            Some(text) => attribute_matrix(text)?,
            None => Affine::IDENTITY,
        };
        let matrix = outer * own;
        let [a, b, c, d, _, _] = matrix.as_coeffs();
        let size = matrix.determinant().abs().sqrt();
        if size.is_nan() || size < 1e-9 {
            return None;
        }
        let close = |x: f64, y: f64| (x - y).abs() < 1e-6 * size;
        let is_even = (close(a, d) && close(b, -c)) || (close(a, -d) && close(b, c));
        let scale = self.root_scale(node)?;
        let factor = if is_even {
            1.0 / (scale * size)
        } else {
            1.0 / scale
        };
        if !is_even {
            let is_plain = |name: &str| {
                let text = self.nearest(node, name).unwrap_or("none");
                !text.contains("url(")
            };
            let names = [
                "fill",
                "stroke",
                "clip-path",
                "mask",
                "filter",
                "marker-start",
                "marker-mid",
                "marker-end",
            ];
            if !names.into_iter().all(is_plain) {
                return None;
            }
            // The shape goes to the root's coordinates, where its stroke is even.
            let path = matrix * self.outline(node)?;
            let back = outer.inverse().as_coeffs().map(number_text).join(" ");
            self.write(node, "d", Some(path.to_svg()));
            self.write(node, "transform", Some(format!("matrix({back})")));
            if let Some(Some(styled)) = self.styled.get_mut(node.id().get_usize()) {
                styled.is_path = true;
            }
        }
        for (name, first) in LENGTHS {
            let text = self.nearest(node, name).unwrap_or(first);
            let scaled = scaled(text, factor)?;
            self.write(node, name, Some(scaled));
        }
        Some(())
    }

    /// The nearest value of an inherited property.
    fn nearest<'b>(&'b self, node: Node<'b, '_>, name: &str) -> Option<&'b str> {
        let mut outer = node.ancestors();
        outer.find_map(|node| self.attribute(node, name).filter(|text| *text != "inherit"))
    }

    /// Pixels of a user unit of the root.
    fn root_scale(&self, node: Node<'_, '_>) -> Option<f64> {
        let root = node.document().root_element();
        if !root.has_attribute("viewBox") {
            return Some(1.0);
        }
        let [width, height] = view_box(root)?;
        let scale = f64::min(self.canvas_px[0] / width, self.canvas_px[1] / height);
        (scale.is_finite() && scale > 0.0).then_some(scale)
    }

    /// The outline of a shape, in its own coordinates.
    fn outline(&self, node: Node<'_, '_>) -> Option<BezPath> {
        let bounds = || self.own_bounds(node);
        Some(match node.tag_name().name() {
            "rect" => {
                let radius = |name: &str| self.attribute(node, name).and_then(px);
                let (rx, ry) = (radius("rx"), radius("ry"));
                match (rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0)) {
                    (0.0, _) | (_, 0.0) => bounds()?.to_path(EXACT),
                    (rx, ry) if (rx - ry).abs() < 1e-9 => {
                        RoundedRect::from_rect(bounds()?, rx).to_path(EXACT)
                    }
                    _ => return None,
                }
            }
            "circle" => {
                let bounds = bounds()?;
                Circle::new(bounds.center(), bounds.width() / 2.0).to_path(EXACT)
            }
            "ellipse" => Ellipse::from_rect(bounds()?).to_path(EXACT),
            "line" => {
                let place = |name: &str| match self.attribute(node, name) {
                    Some(text) => px(text),
                    None => Some(0.0),
                };
                let from = Point::new(place("x1")?, place("y1")?);
                Line::new(from, Point::new(place("x2")?, place("y2")?)).to_path(EXACT)
            }
            name @ ("polyline" | "polygon") => {
                let points = self.attribute(node, "points")?;
                let end = if name == "polygon" { "Z" } else { "" };
                BezPath::from_svg(&format!("M{points}{end}")).ok()?
            }
            "path" => BezPath::from_svg(self.attribute(node, "d")?).ok()?,
            _ => return None,
        })
    }
}

/// Lengths times a factor; shares of the viewport and `none` stay.
fn scaled(text: &str, factor: f64) -> Option<String> {
    let values = syntax::parse(text).ok()?;
    let words = words(&values);
    let words = words.into_iter().filter(|value| !value.is_delim(','));
    let texts: Option<Vec<String>> = words
        .map(|value| match value {
            Value::Percent(_) | Value::Ident(_) => Some(syntax::text(std::slice::from_ref(value))),
            value => {
                let length = px(&syntax::text(std::slice::from_ref(value)))?;
                Some(number_text(length * factor))
            }
        })
        .collect();
    Some(texts?.join(" "))
}
