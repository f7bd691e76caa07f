//! Gradients that are mixed in linear light, which usvg does not know: more stops make them so.

use color::{AlphaColor, DynamicColor, LinearSrgb, Srgb};
use usvg::roxmltree::Node;

use super::Boxes;
use crate::style::syntax;
use crate::style::value::color::{Surroundings, dialect};
use crate::style::value::length::{Quantity, Units};
use crate::style::value::number_text;

/// Parts of the way between two stops, which are shorter towards both ends, where sRGB is steepest
/// for dark colours. Each is mixed in sRGB, off by at most 1.6 steps of 255.
const PARTS: u8 = 32;

impl Boxes<'_> {
    /// Puts stops between those of `node`, if it is such a gradient.
    pub(super) fn mix_in_linear_light(&mut self, node: Node<'_, '_>) {
        if !matches!(node.tag_name().name(), "linearGradient" | "radialGradient") {
            return;
        }
        let mut outer = node.ancestors();
        let space = outer.find_map(|outer| self.attribute(outer, "color-interpolation"));
        if !space.is_some_and(|space| space.eq_ignore_ascii_case("linearRGB")) {
            return;
        }
        let stops = node
            .children()
            .filter(|child| child.tag_name().name() == "stop");
        let stops: Option<Vec<_>> = stops.map(|stop| Some((stop, self.stop(stop)?))).collect();
        let stops = stops.unwrap_or_default();
        for pair in stops.windows(2) {
            let [(_, (from, before)), (stop, (to, after))] = pair else {
                continue;
            };
            let [a, b] = [before, after].map(|color| color.to_alpha_color::<LinearSrgb>());
            let between = (1..PARTS).map(|part| {
                let quarter = std::f32::consts::FRAC_PI_2 * f32::from(part) / f32::from(PARTS);
                let share = quarter.sin().powi(2);
                let color = mixed(a, b, share);
                let offset = from + (to - from) * f64::from(share);
                let (offset, color) = (number_text(offset), dialect(color));
                format!("<stop offset=\"{offset}\" stop-color=\"{color}\" stop-opacity=\"1\"/>")
            });
            let between: String = between.collect();
            if let Some(Some(styled)) = self.styled.get_mut(stop.id().get_usize()) {
                styled.before = between;
            }
        }
    }

    /// Offset and colour of a stop.
    fn stop(&self, node: Node<'_, '_>) -> Option<(f64, DynamicColor)> {
        let styled = self.of(node)?;
        let around = Surroundings {
            units: Units {
                font_size_px: 16.0,
                root_font_size_px: 16.0,
                canvas_px: self.canvas_px,
                names: &[],
            },
            current: styled.inherited.current,
            is_dark: false,
        };
        let quantity = |name: &str, first: f64| match self.attribute(node, name) {
            None => Some(first),
            Some(text) => match around.units.quantity(syntax::parse(text).ok()?.first()?)? {
                Quantity::Number(number) => Some(number),
                Quantity::Length(_, percent) => Some(percent / 100.0),
                Quantity::Degrees(_) => None,
            },
        };
        let text = self.attribute(node, "stop-color").unwrap_or("black");
        let color = around.resolved(syntax::parse(text).ok()?.first()?)?;
        #[expect(clippy::cast_possible_truncation, reason = "from 0 to 1")]
        let opacity = quantity("stop-opacity", 1.0)?.clamp(0.0, 1.0) as f32;
        let offset = quantity("offset", 0.0)?.clamp(0.0, 1.0);
        Some((offset, color.multiply_alpha(opacity)))
    }
}

/// Channels and alpha mixed each by itself, as gradients of SVG are.
fn mixed(a: AlphaColor<LinearSrgb>, b: AlphaColor<LinearSrgb>, share: f32) -> DynamicColor {
    let mut components = a.components;
    for (from, to) in components.iter_mut().zip(b.components) {
        *from += (to - *from) * share;
    }
    let mixed = AlphaColor::<LinearSrgb>::new(components);
    DynamicColor::from_alpha_color(mixed.convert::<Srgb>())
}
