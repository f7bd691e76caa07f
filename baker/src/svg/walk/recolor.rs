//! Filters that only change colours: they are applied to paints, so their content stays vector.
//!
//! This is exact for a `feColorMatrix` (Filter Effects 1, sec. 9.6) that keeps alpha. Such a matrix
//! is linear in premultiplied colour and alpha, and so is compositing; in sRGB-encoded values it
//! makes no difference which comes first. A filter in linear light is exact only if no colours are
//! mixed: shapes have solid colours, and there is one shape or all are opaque.

use usvg::filter::{ColorInterpolation, ColorMatrix, ColorMatrixKind, Filter, Input, Kind};
use usvg::{BlendMode, Group, Node};

use crate::drawing::color;

/// A change of colours that keeps alpha.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Recolor {
    /// Rows for red, green and blue; the last column is added.
    rows: [[f32; 4]; 3],
    /// Whether it applies to linear light.
    linear: bool,
}

impl Recolor {
    /// The change that the filters of a group make, if they do nothing else.
    pub(super) fn of(group: &Group) -> Option<Self> {
        let [filter] = group.filters() else {
            return None;
        };
        let recolor = Self::of_filter(filter)?;
        let contents = Contents::of(group);
        let region = filter.rect().to_rect();
        let drawn = group.stroke_bounding_box();
        // A filter region cuts off what lies outside of it.
        let inside = region.left() <= drawn.left()
            && region.top() <= drawn.top()
            && region.right() >= drawn.right()
            && region.bottom() >= drawn.bottom();
        let unmixed = contents.solid && (contents.opaque || contents.shapes <= 1);
        (contents.plain && inside && (!recolor.linear || unmixed)).then_some(recolor)
    }

    fn of_filter(filter: &Filter) -> Option<Self> {
        let [primitive] = filter.primitives() else {
            return None;
        };
        let Kind::ColorMatrix(matrix) = primitive.kind() else {
            return None;
        };
        Some(Self {
            rows: rows(matrix)?,
            linear: primitive.color_interpolation() == ColorInterpolation::LinearRGB,
        })
    }

    /// The changed colour: straight alpha, sRGB-encoded.
    pub(super) fn apply(&self, [r, g, b, a]: [f32; 4]) -> [f32; 4] {
        let from = if self.linear {
            [r, g, b].map(color::decode)
        } else {
            [r, g, b]
        };
        let changed = self.rows.map(|row| {
            // Filter Effects clamps results to [0, 1].
            let value = row[0] * from[0] + row[1] * from[1] + row[2] * from[2] + row[3];
            value.clamp(0.0, 1.0)
        });
        let [r, g, b] = if self.linear {
            changed.map(color::encode)
        } else {
            changed
        };
        [r, g, b, a]
    }
}

/// The matrix of a primitive, if it reads the group and keeps alpha.
fn rows(matrix: &ColorMatrix) -> Option<[[f32; 4]; 3]> {
    if *matrix.input() != Input::SourceGraphic {
        return None;
    }
    // `saturate` and `hueRotate` keep luminance, and scale or rotate the rest.
    let mixed = |cos: f32, sin: f32| {
        const LIGHT: [f32; 3] = [0.213, 0.715, 0.072];
        const TURN: [[f32; 3]; 3] = [
            [-0.213, -0.715, 0.928],
            [0.143, 0.140, -0.283],
            [-0.787, 0.715, 0.072],
        ];
        let entry = |row: usize, column: usize| {
            let own = if row == column { 1.0 } else { 0.0 };
            LIGHT[column] + cos * (own - LIGHT[column]) + sin * TURN[row][column]
        };
        [0, 1, 2].map(|row| [entry(row, 0), entry(row, 1), entry(row, 2), 0.0])
    };
    match matrix.kind() {
        ColorMatrixKind::Matrix(values) => {
            let row = |first: usize| {
                let [r, g, b, a, constant] = *values.get(first..)?.first_chunk()?;
                // Alpha must not enter: the change has to work on straight colours.
                (a == 0.0).then_some([r, g, b, constant])
            };
            let keeps_alpha = values.get(15..20)? == [0.0, 0.0, 0.0, 1.0, 0.0];
            keeps_alpha.then_some([row(0)?, row(5)?, row(10)?])
        }
        ColorMatrixKind::Saturate(amount) => Some(mixed(amount.get(), 0.0)),
        ColorMatrixKind::HueRotate(degrees) => {
            let (sin, cos) = degrees.to_radians().sin_cos();
            Some(mixed(cos, sin))
        }
        ColorMatrixKind::LuminanceToAlpha => None,
    }
}

/// What a group contains.
#[derive(Clone, Copy, Debug)]
struct Contents {
    /// Fills and strokes.
    shapes: usize,
    /// Whether there are only shapes, composited normally.
    plain: bool,
    /// Whether each has one colour.
    solid: bool,
    /// Whether all are opaque.
    opaque: bool,
}

impl Contents {
    fn of(group: &Group) -> Self {
        let mut contents = Self {
            shapes: 0,
            plain: true,
            solid: true,
            opaque: true,
        };
        contents.add(group);
        contents
    }

    fn add(&mut self, group: &Group) {
        for node in group.children() {
            match node {
                Node::Group(inner) => {
                    self.plain &=
                        inner.filters().is_empty() && inner.blend_mode() == BlendMode::Normal;
                    self.opaque &= inner.opacity() == usvg::Opacity::ONE && inner.mask().is_none();
                    self.add(inner);
                }
                Node::Path(path) if path.is_visible() => {
                    let fill = path.fill().map(|fill| (fill.paint(), fill.opacity()));
                    let stroke = path.stroke();
                    let stroke = stroke.map(|stroke| (stroke.paint(), stroke.opacity()));
                    for (paint, opacity) in [fill, stroke].into_iter().flatten() {
                        self.shapes += 1;
                        self.opaque &= opacity == usvg::Opacity::ONE;
                        self.solid &= matches!(paint, usvg::Paint::Color(_));
                        self.plain &= !matches!(paint, usvg::Paint::Pattern(_));
                    }
                }
                Node::Path(_) => {}
                Node::Image(_) => self.plain = false,
                Node::Text(text) => self.add(text.flattened()),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recolored(body: &str, color: [f32; 4]) -> Option<[f32; 4]> {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><filter id='f' \
             color-interpolation-filters='sRGB'>{body}</filter>\
             <g filter='url(#f)'><rect x='2' y='2' width='5' height='5'/></g></svg>"
        );
        let tree = usvg::Tree::from_str(&svg, &usvg::Options::default()).unwrap();
        let Node::Group(group) = &tree.root().children()[0] else {
            panic!("a group")
        };
        Recolor::of(group).map(|recolor| recolor.apply(color))
    }

    #[test]
    fn saturation_and_hue_mix_channels() {
        let grey = recolored(
            "<feColorMatrix type='saturate' values='0'/>",
            [1.0, 0.0, 0.0, 0.5],
        );
        assert_eq!(grey, Some([0.213, 0.213, 0.213, 0.5]));
        let turned = recolored(
            "<feColorMatrix type='hueRotate' values='120'/>",
            [1.0, 0.0, 0.0, 1.0],
        );
        let [r, g, b, _] = turned.unwrap();
        assert!(g > 0.4 && r < 0.1 && b < 0.1, "{turned:?}");
        let same = recolored(
            "<feColorMatrix type='hueRotate' values='0'/>",
            [0.2, 0.3, 0.4, 1.0],
        );
        let off = same
            .unwrap()
            .into_iter()
            .zip([0.2, 0.3, 0.4, 1.0])
            .map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f32::max) < 1e-6);
    }

    #[test]
    fn what_changes_alpha_or_place_is_no_recolouring() {
        for body in [
            "<feColorMatrix type='luminanceToAlpha'/>",
            "<feColorMatrix values='1 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 0 .5 0'/>",
            "<feOffset dx='1'/>",
            "<feColorMatrix type='saturate' values='.5'/><feOffset dx='1'/>",
        ] {
            assert_eq!(recolored(body, [1.0; 4]), None, "{body}");
        }
    }
}
