//! The definitions of filters that usvg and resvg do not draw rightly by themselves.

use kurbo::{Affine, Rect};
use usvg::roxmltree::Node;

use super::{Boxes, attribute_matrix};
use crate::style::value::filter::{Step, primitives};
use crate::style::value::number_text as n;

impl Boxes<'_> {
    /// Writes the filter of `node`, with a definition for each step that needs one.
    pub(super) fn filter(&mut self, node: Node<'_, '_>, steps: &[Step]) {
        let reach: f64 = steps.iter().map(Step::reach).sum();
        let region = match self.region(node, reach) {
            Some(region) => format!(
                "filterUnits=\"userSpaceOnUse\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"",
                n(region.x0),
                n(region.y0),
                n(region.width()),
                n(region.height())
            ),
            None => "x=\"-.5\" y=\"-.5\" width=\"2\" height=\"2\"".to_owned(),
        };
        let mut list = Vec::new();
        for step in steps {
            let content = match step {
                Step::Text(text) => {
                    list.push(text.clone());
                    continue;
                }
                Step::Blur(deviation) => {
                    format!("<feGaussianBlur stdDeviation=\"{}\"/>", n(*deviation))
                }
                Step::Shadow(shadow) => {
                    let flood = format!("flood-color=\"{}\"", shadow.color);
                    let deviation = n(shadow.deviation);
                    primitives("", &flood, &deviation, &shadow.offset.map(n), "")
                }
            };
            let id = format!("vtex-style-filter-{}", self.definitions.len());
            self.definitions.push(format!(
                "<filter id=\"{id}\" {region} color-interpolation-filters=\"sRGB\">{content}</filter>"
            ));
            list.push(format!("url(#{id})"));
        }
        self.write(node, "filter", Some(list.join(" ")));
    }

    /// What the filter of `node` can reach, in its coordinates.
    fn region(&mut self, node: Node<'_, '_>, reach: f64) -> Option<Rect> {
        match self.stroke_bounds(node) {
            Some(bounds) => {
                // Markers lie outside; usvg's own filters have half a box for them.
                let half = bounds.inflate(bounds.width() / 2.0, bounds.height() / 2.0);
                Some(half.union(bounds.inflate(reach, reach)))
            }
            None => Some(self.canvas(node)?.inflate(reach, reach)),
        }
    }

    /// The matrix from inside `node` to the root's coordinates; `None` where another viewport lies
    /// between them, or where it is shown elsewhere.
    pub(super) fn matrix_to_root(&self, node: Node<'_, '_>) -> Option<Affine> {
        let mut matrix = Affine::IDENTITY;
        for outer in node.ancestors() {
            match outer.tag_name().name() {
                "svg" if outer.parent_element().is_none() => break,
                "g" | "a" | "text" | "use" | "switch" => {}
                _ => return None,
            }
            if let Some(text) = self.attribute(outer, "transform") {
                matrix = attribute_matrix(text)? * matrix;
            }
        }
        Some(matrix)
    }

    /// The canvas in the coordinates of `node`; `None` where another viewport lies between them.
    fn canvas(&self, node: Node<'_, '_>) -> Option<Rect> {
        let matrix = self.matrix_to_root(node)?;
        let root = node.document().root_element();
        let canvas = match root.attribute("viewBox") {
            Some(text) => {
                let view: svgtypes::ViewBox = text.parse().ok()?;
                Rect::from_origin_size((view.x, view.y), (view.w, view.h))
            }
            None => Rect::from_origin_size((0.0, 0.0), (self.canvas_px[0], self.canvas_px[1])),
        };
        let is_flat = matrix.determinant().abs() < 1e-12;
        (!is_flat).then(|| matrix.inverse().transform_rect_bbox(canvas))
    }
}
