//! What depends on the box of an element: matrices about an origin, and shapes that clip.

mod filter;
mod gradient;
mod stroke;

use kurbo::{Affine, BezPath, Rect, Shape as _};
use std::rc::Rc;
use usvg::roxmltree::{Document, Node};

use super::compute::Styled;
use super::syntax::{self, Value, words};
use super::value::length::Units;
use super::value::number_text;
use super::value::shape;
use super::value::transform::Transforms;

/// Most elements that are visited to find the boxes of groups.
const MAX_VISITS: usize = 1 << 22;

/// Bytes of path data that are read in the time of a visit.
const BYTES_A_VISIT: usize = 64;

/// Elements of a document with their attributes as they will be written.
pub(super) struct Boxes<'a> {
    pub(super) styled: &'a mut [Option<Styled>],
    pub(super) root_font_size_px: f64,
    pub(super) canvas_px: [f64; 2],
    /// Definitions to be added.
    pub(super) definitions: Vec<String>,
    pub(super) visits: usize,
}

impl Boxes<'_> {
    /// Writes matrices, filters and clips into the attributes; returns what could not be, as node, feature
    /// and message.
    pub(super) fn finish<'d>(
        &mut self,
        document: &'d Document<'_>,
    ) -> Vec<(Node<'d, 'd>, &'static str, &'static str)> {
        let mut failed = Vec::new();
        let nodes: Vec<Node<'_, '_>> = document
            .descendants()
            .filter(|n| super::elements::is_svg(*n))
            .collect();
        // Children first: the box of a group depends on their matrices.
        for &node in nodes.iter().rev() {
            let Some(styled) = self.of(node) else {
                continue;
            };
            let (has_transform, has_clip) = (!styled.transforms.is_empty(), styled.clip.is_some());
            let steps = styled.filter.clone();
            if has_transform && !self.transform(node) {
                failed.push((
                    node,
                    "transform",
                    "the transform is not in the plane, or its box is not known",
                ));
            }
            if has_clip && !self.clip(node) {
                failed.push((node, "clip-path", "the shape that clips is not understood"));
            }
            if let Some(steps) = steps {
                self.filter(node, &steps);
            }
        }
        // With all matrices known.
        for node in nodes {
            self.mix_in_linear_light(node);
            if node.has_attribute("pathLength") {
                let _ = self.path_length(node);
            }
            if self.keeps_stroke(node) && self.unscaled_stroke(node).is_none() {
                failed.push((node, "vector-effect", "the stroke scales with its element"));
            }
        }
        failed
    }

    fn of(&self, node: Node<'_, '_>) -> Option<&Styled> {
        self.styled.get(node.id().get_usize())?.as_ref()
    }

    /// The attribute as it will be written.
    fn attribute<'b>(&'b self, node: Node<'b, '_>, name: &str) -> Option<&'b str> {
        match self.of(node).and_then(|styled| styled.attributes.get(name)) {
            Some(text) => text.as_deref(),
            None => node.attribute(name),
        }
    }

    fn write(&mut self, node: Node<'_, '_>, name: &str, text: Option<String>) {
        if let Some(Some(styled)) = self.styled.get_mut(node.id().get_usize()) {
            styled.attributes.insert(name.into(), text);
        }
    }

    fn transforms(&self, node: Node<'_, '_>, size: [f64; 2]) -> Transforms<'static> {
        let font_size_px = self
            .of(node)
            .map_or(16.0, |styled| styled.inherited.font_size_px);
        let units = Units {
            font_size_px,
            root_font_size_px: self.root_font_size_px,
            canvas_px: self.canvas_px,
            names: &[],
        };
        Transforms { units, size }
    }

    /// The viewport that `node` is in.
    fn viewport(&self, node: Node<'_, '_>) -> [f64; 2] {
        let parent = node.parent_element().and_then(|parent| self.of(parent));
        parent.map_or(self.canvas_px, |styled| styled.inherited.viewport)
    }

    fn transform(&mut self, node: Node<'_, '_>) -> bool {
        match self.matrix(node) {
            Some(matrix) => {
                let name = match node.tag_name().name() {
                    "linearGradient" | "radialGradient" => "gradientTransform",
                    "pattern" => "patternTransform",
                    _ => "transform",
                };
                let numbers = matrix.as_coeffs().map(number_text).join(" ");
                self.write(node, name, Some(format!("matrix({numbers})")));
                self.write(node, "transform-origin", None);
                true
            }
            None => false,
        }
    }

    fn matrix(&mut self, node: Node<'_, '_>) -> Option<Affine> {
        let property = |boxes: &Self, name: &str| -> Option<Rc<[Value]>> {
            let value = boxes.of(node)?.transforms.get(name)?;
            (!value.is_empty()).then(|| Rc::clone(value))
        };
        let keyword = property(self, "transform-box").and_then(|v| v.first()?.keyword());
        let bounds = match keyword.as_deref() {
            Some("fill-box" | "content-box") => self.bounds(node)?,
            Some("stroke-box" | "border-box") => self.stroke_bounds(node)?,
            _ => {
                let [width, height] = self.viewport(node);
                Rect::new(0.0, 0.0, width, height)
            }
        };
        let transforms = self.transforms(node, [bounds.width(), bounds.height()]);
        let origin = match property(self, "transform-origin") {
            Some(values) => transforms.place(&values)?,
            None => match node.attribute("transform-origin").map(syntax::parse) {
                Some(Ok(values)) => transforms.place(syntax::trim(&values))?,
                _ => [0.0; 2],
            },
        };
        let (x, y) = (bounds.x0 + origin[0], bounds.y0 + origin[1]);
        let mut matrix = Affine::translate((x, y));
        if let Some(values) = property(self, "translate") {
            matrix *= transforms.translate(&values)?;
        }
        if let Some(values) = property(self, "rotate") {
            matrix *= transforms.rotate(&values)?;
        }
        if let Some(values) = property(self, "scale") {
            matrix *= transforms.scale(&values)?;
        }
        let has_property = self.of(node)?.transforms.contains_key("transform");
        matrix *= match (property(self, "transform"), node.attribute("transform")) {
            (Some(values), _) => transforms.list(&values)?,
            (None, Some(text)) if !has_property => attribute_matrix(text)?,
            _ => Affine::IDENTITY,
        };
        Some(matrix * Affine::translate((-x, -y)))
    }

    fn clip(&mut self, node: Node<'_, '_>) -> bool {
        let Some(values) = self.of(node).and_then(|styled| styled.clip.clone()) else {
            return false;
        };
        let list = words(&values);
        let shape = list.iter().find_map(|value| match value {
            Value::Function(name, inner) => Some((name, inner)),
            _ => None,
        });
        let reference = list.iter().find_map(|value| value.keyword());
        let bounds = match reference.as_deref() {
            Some("view-box") => {
                let [width, height] = self.viewport(node);
                Some(Rect::new(0.0, 0.0, width, height))
            }
            Some("fill-box" | "content-box" | "padding-box") => self.bounds(node),
            _ => self.stroke_bounds(node),
        };
        let (Some((name, inner)), Some(bounds)) = (shape, bounds) else {
            return false;
        };
        let transforms = self.transforms(node, [bounds.width(), bounds.height()]);
        let Some(element) = shape::element(&transforms, bounds, name, inner) else {
            return false;
        };
        // No id in a file is likely to be this one, and the first of two counts.
        let id = format!("vtex-style-clip-{}", self.definitions.len());
        self.definitions
            .push(format!("<clipPath id=\"{id}\">{element}</clipPath>"));
        self.write(node, "clip-path", Some(format!("url(#{id})")));
        true
    }

    fn stroke_bounds(&mut self, node: Node<'_, '_>) -> Option<Rect> {
        let bounds = self.bounds(node)?;
        let inherited = |name: &str| node.ancestors().find_map(|n| self.attribute(n, name));
        let is_stroked = inherited("stroke").is_some_and(|paint| paint != "none");
        let width = inherited("stroke-width").map_or(Some(1.0), super::elements::px);
        let margin = if is_stroked {
            width.unwrap_or(1.0) / 2.0
        } else {
            0.0
        };
        Some(bounds.inflate(margin, margin))
    }

    /// The box of what an element fills, in its own coordinates; `None` where only a renderer
    /// knows it.
    fn bounds(&mut self, node: Node<'_, '_>) -> Option<Rect> {
        if !matches!(node.tag_name().name(), "g" | "a" | "svg" | "switch") {
            return self.own_bounds(node);
        }
        let mut all: Option<Rect> = None;
        // Nodes with the matrix from their parent's coordinates to those of the group.
        let mut open: Vec<(Node<'_, '_>, Affine)> = node
            .children()
            .map(|child| (child, Affine::IDENTITY))
            .collect();
        while let Some((child, outer)) = open.pop() {
            self.visits += 1 + self.attribute(child, "d").map_or(0, str::len) / BYTES_A_VISIT;
            if self.visits > MAX_VISITS {
                return None;
            }
            if !super::elements::is_svg(child) || self.attribute(child, "display") == Some("none") {
                continue;
            }
            let matrix = match self.attribute(child, "transform") {
                Some(text) => outer * attribute_matrix(text)?,
                None => outer,
            };
            match child.tag_name().name() {
                "g" | "a" => open.extend(child.children().map(|inner| (inner, matrix))),
                "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon" | "path"
                | "image" => {
                    let bounds = matrix.transform_rect_bbox(self.own_bounds(child)?);
                    all = Some(all.map_or(bounds, |all| all.union(bounds)));
                }
                "text" | "use" | "svg" | "switch" | "foreignObject" => return None,
                _ => {}
            }
        }
        all
    }

    fn own_bounds(&self, node: Node<'_, '_>) -> Option<Rect> {
        let [width, height] = self.viewport(node);
        let diagonal = width.hypot(height) / std::f64::consts::SQRT_2;
        let transforms = self.transforms(node, [width, height]);
        let length = |name: &str, whole: f64| -> Option<f64> {
            let Some(text) = self.attribute(node, name) else {
                return Some(0.0);
            };
            let values = syntax::parse(text).ok()?;
            let [value] = words(&values).try_into().ok()?;
            transforms.units.quantity(value)?.length_px(whole)
        };
        let (x, y) = (|name| length(name, width), |name| length(name, height));
        match node.tag_name().name() {
            "rect" | "image" => {
                let (x0, y0) = (x("x")?, y("y")?);
                Some(Rect::new(x0, y0, x0 + x("width")?, y0 + y("height")?))
            }
            "circle" => {
                let (cx, cy, r) = (x("cx")?, y("cy")?, length("r", diagonal)?);
                Some(Rect::new(cx - r, cy - r, cx + r, cy + r))
            }
            "ellipse" => {
                let radius = |name, whole, other, other_whole| {
                    let is_auto = self.attribute(node, name).is_none_or(|text| text == "auto");
                    if is_auto {
                        length(other, other_whole)
                    } else {
                        length(name, whole)
                    }
                };
                let (cx, cy) = (x("cx")?, y("cy")?);
                let (rx, ry) = (
                    radius("rx", width, "ry", height)?,
                    radius("ry", height, "rx", width)?,
                );
                Some(Rect::new(cx - rx, cy - ry, cx + rx, cy + ry))
            }
            "line" => Some(Rect::new(x("x1")?, y("y1")?, x("x2")?, y("y2")?).abs()),
            "polyline" | "polygon" => {
                let values = syntax::parse(self.attribute(node, "points")?).ok()?;
                let numbers: Vec<f64> = values
                    .iter()
                    .filter_map(|value| match value {
                        Value::Number(number) => Some(*number),
                        _ => None,
                    })
                    .collect();
                let points = numbers.chunks_exact(2).filter_map(|pair| match pair {
                    [x, y] => Some(Rect::new(*x, *y, *x, *y)),
                    _ => None,
                });
                points.reduce(|all, point| all.union(point))
            }
            "path" => {
                let path = BezPath::from_svg(self.attribute(node, "d")?).ok()?;
                (!path.is_empty()).then(|| path.bounding_box())
            }
            _ => None,
        }
    }
}

/// A matrix as SVG writes it in an attribute.
fn attribute_matrix(text: &str) -> Option<Affine> {
    let matrix: svgtypes::Transform = text.parse().ok()?;
    Some(Affine::new([
        matrix.a, matrix.b, matrix.c, matrix.d, matrix.e, matrix.f,
    ]))
}
