//! CSS transforms to matrices (CSS Transforms 1 and 2, as far as they are flat).

use kurbo::Affine;

use super::length::{Quantity, Units};
use crate::style::syntax::{Value, split, words};

/// Reads transforms whose percentages are of a box of `size`.
#[derive(Clone, Copy)]
pub(in crate::style) struct Transforms<'a> {
    pub(in crate::style) units: Units<'a>,
    pub(in crate::style) size: [f64; 2],
}

impl Transforms<'_> {
    /// The value of `transform`; `None` where it is none or leaves the plane.
    pub(in crate::style) fn list(&self, values: &[Value]) -> Option<Affine> {
        let words = words(values);
        if let [word] = words.as_slice()
            && word.keyword().as_deref() == Some("none")
        {
            return Some(Affine::IDENTITY);
        }
        words
            .into_iter()
            .try_fold(Affine::IDENTITY, |matrix, value| match value {
                Value::Function(name, inner) => Some(matrix * self.function(name, inner)?),
                _ => None,
            })
    }

    fn function(&self, name: &str, inner: &[Value]) -> Option<Affine> {
        let parts = split(inner, ',');
        let arguments: Option<Vec<&Value>> = parts
            .iter()
            .map(|part| match part {
                [value] => Some(value),
                _ => None,
            })
            .collect();
        let arguments = arguments?;
        let x = |value: &Value| self.length(value, 0);
        let y = |value: &Value| self.length(value, 1);
        let angle = |value: &Value| self.units.degrees(value).map(f64::to_radians);
        Some(match (name, arguments.as_slice()) {
            ("translate", [a]) | ("translatex", [a]) => Affine::translate((x(a)?, 0.0)),
            ("translate", [a, b]) => Affine::translate((x(a)?, y(b)?)),
            ("translatey", [a]) => Affine::translate((0.0, y(a)?)),
            ("translatez", [_]) => Affine::IDENTITY,
            ("translate3d", [a, b, _]) => Affine::translate((x(a)?, y(b)?)),
            ("scale", [a]) => Affine::scale(self.factor(a)?),
            ("scale", [a, b]) | ("scale3d", [a, b, _]) => {
                Affine::scale_non_uniform(self.factor(a)?, self.factor(b)?)
            }
            ("scalex", [a]) => Affine::scale_non_uniform(self.factor(a)?, 1.0),
            ("scaley", [a]) => Affine::scale_non_uniform(1.0, self.factor(a)?),
            ("scalez", [_]) => Affine::IDENTITY,
            ("rotate" | "rotatez", [a]) => Affine::rotate(angle(a)?),
            ("skew", [a]) | ("skewx", [a]) => Affine::skew(angle(a)?.tan(), 0.0),
            ("skew", [a, b]) => Affine::skew(angle(a)?.tan(), angle(b)?.tan()),
            ("skewy", [a]) => Affine::skew(0.0, angle(a)?.tan()),
            ("matrix", numbers) => {
                let numbers: Option<Vec<f64>> = numbers
                    .iter()
                    .map(|value| self.units.number(value))
                    .collect();
                Affine::new(numbers?.try_into().ok()?)
            }
            _ => return None,
        })
    }

    /// The value of the property `translate`.
    pub(in crate::style) fn translate(&self, values: &[Value]) -> Option<Affine> {
        Some(match words(values).as_slice() {
            [word] if word.keyword().as_deref() == Some("none") => Affine::IDENTITY,
            [a] => Affine::translate((self.length(a, 0)?, 0.0)),
            [a, b] | [a, b, _] => Affine::translate((self.length(a, 0)?, self.length(b, 1)?)),
            _ => return None,
        })
    }

    /// The value of the property `rotate`, about the axis that stands on the plane.
    pub(in crate::style) fn rotate(&self, values: &[Value]) -> Option<Affine> {
        let angle = |value: &Value| self.units.degrees(value).map(f64::to_radians);
        let is_z = |value: &Value| value.keyword().as_deref() == Some("z");
        Some(match words(values).as_slice() {
            [word] if word.keyword().as_deref() == Some("none") => Affine::IDENTITY,
            [a] => Affine::rotate(angle(a)?),
            [axis, a] | [a, axis] if is_z(axis) => Affine::rotate(angle(a)?),
            _ => return None,
        })
    }

    /// The value of the property `scale`.
    pub(in crate::style) fn scale(&self, values: &[Value]) -> Option<Affine> {
        Some(match words(values).as_slice() {
            [word] if word.keyword().as_deref() == Some("none") => Affine::IDENTITY,
            [a] => Affine::scale(self.factor(a)?),
            [a, b] | [a, b, _] => Affine::scale_non_uniform(self.factor(a)?, self.factor(b)?),
            _ => return None,
        })
    }

    /// The place that `transform-origin` or a `<position>` names, from the corner of the box.
    pub(in crate::style) fn place(&self, values: &[Value]) -> Option<[f64; 2]> {
        let words = words(values);
        let keyword = |value: &Value| value.keyword();
        let share = |name: &str| match name {
            "left" | "top" => Some(0.0),
            "center" => Some(0.5),
            "right" | "bottom" => Some(1.0),
            _ => None,
        };
        let at = |value: &Value, axis: usize| match keyword(value) {
            Some(name) => Some(share(&name)? * self.size[axis]),
            None => self.length(value, axis),
        };
        let is_vertical =
            |value: &Value| matches!(keyword(value).as_deref(), Some("top" | "bottom"));
        let is_horizontal =
            |value: &Value| matches!(keyword(value).as_deref(), Some("left" | "right"));
        Some(match words.as_slice() {
            [a] if is_vertical(a) => [self.size[0] / 2.0, at(a, 1)?],
            [a] => [at(a, 0)?, self.size[1] / 2.0],
            [a, b] | [a, b, _] if is_vertical(a) || is_horizontal(b) => [at(b, 0)?, at(a, 1)?],
            [a, b] | [a, b, _] => [at(a, 0)?, at(b, 1)?],
            [a, x, b, y] => {
                let side = |name: &Value, offset: &Value, axis: usize| {
                    let share = share(&keyword(name)?)?;
                    let offset = self.length(offset, axis)?;
                    Some(if share > 0.5 {
                        self.size[axis] - offset
                    } else {
                        offset
                    })
                };
                match is_vertical(a) {
                    true => [side(b, y, 0)?, side(a, x, 1)?],
                    false => [side(a, x, 0)?, side(b, y, 1)?],
                }
            }
            _ => return None,
        })
    }

    /// A length along an axis.
    pub(in crate::style) fn length(&self, value: &Value, axis: usize) -> Option<f64> {
        self.units.quantity(value)?.length_px(self.size[axis])
    }

    fn factor(&self, value: &Value) -> Option<f64> {
        match self.units.quantity(value)? {
            Quantity::Number(number) => Some(number),
            Quantity::Length(0.0, percent) => Some(percent / 100.0),
            _ => None,
        }
    }
}
