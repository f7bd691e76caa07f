//! What an element is, and how large viewports are.

use usvg::roxmltree::Node;

use super::syntax::{self, Value, words};
use super::value::length::Units;

/// Whether usvg takes a node for an element of SVG.
pub(super) fn is_svg(node: Node<'_, '_>) -> bool {
    let namespace = node.tag_name().namespace();
    node.is_element() && matches!(namespace, None | Some("http://www.w3.org/2000/svg"))
}

/// Width and height of what `vw` and media queries are about.
pub(super) fn canvas_of(root: Node<'_, '_>) -> [f64; 2] {
    let size = |name: &str| root.attribute(name).and_then(px).filter(|&px| px > 0.0);
    let view = view_box(root).unwrap_or([100.0; 2]);
    let [width, height] = [size("width"), size("height")];
    [
        width
            .or(height.map(|height| height * view[0] / view[1]))
            .unwrap_or(view[0]),
        height
            .or(width.map(|width| width * view[1] / view[0]))
            .unwrap_or(view[1]),
    ]
}

/// What percentages in an `svg` are of.
pub(super) fn viewport_of(svg: Node<'_, '_>) -> Option<[f64; 2]> {
    let size = |name: &str| svg.attribute(name).and_then(px);
    view_box(svg).or_else(|| Some([size("width")?, size("height")?]))
}

/// Width and height of the `viewBox`, both greater than 0.
pub(super) fn view_box(svg: Node<'_, '_>) -> Option<[f64; 2]> {
    let view: svgtypes::ViewBox = svg.attribute("viewBox")?.parse().ok()?;
    (view.w > 0.0 && view.h > 0.0).then_some([view.w, view.h])
}

/// The text of a length in user units, where usvg reads a number.
pub(super) fn px(text: &str) -> Option<f64> {
    let values = syntax::parse(text).ok()?;
    let [value] = words(&values).try_into().ok()?;
    let units = Units {
        font_size_px: 16.0,
        root_font_size_px: 16.0,
        canvas_px: [0.0; 2],
        names: &[],
    };
    match value {
        Value::Percent(_) => None,
        value => units.quantity(value)?.length_px(0.0),
    }
}

/// Whether a node is a `foreignObject` whose content is to be drawn: within a `switch`, what stands
/// after it is its picture.
pub(super) fn is_label(node: Node<'_, '_>) -> bool {
    if !is_svg(node) || node.tag_name().name() != "foreignObject" {
        return false;
    }
    let is_switch = |outer: &Node<'_, '_>| outer.tag_name().name() == "switch";
    let has_other = || {
        let mut after = node.next_siblings().skip(1);
        after.any(|other| is_svg(other) && other.tag_name().name() != "foreignObject")
    };
    let in_switch = node.parent_element().is_some_and(|outer| is_switch(&outer));
    !(in_switch && has_other()) && node.children().any(|child| child.is_element())
}
