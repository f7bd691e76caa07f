//! Functions that make colours: `rgb()` to `color()`, `color-mix()`, `light-dark()`.

use color::{ColorSpaceTag as Space, DynamicColor, Flags, HueDirection, Missing};

use super::color::{Color, Surroundings};
use super::length::Units;
use crate::style::syntax::{Value, split, trim, words};

/// Reads the function `name(inner)`.
pub(super) fn read(around: &Surroundings<'_>, name: &str, inner: &[Value]) -> Option<Color> {
    match name {
        "light-dark" => {
            let parts = split(inner, ',');
            let [[light], [dark]] = parts.as_slice() else {
                return None;
            };
            // Both must be colours, whichever is taken.
            let (light, dark) = (around.color(light)?, around.color(dark)?);
            Some(if around.is_dark { dark } else { light })
        }
        "color-mix" => mix(around, inner).map(Color::Known),
        "color" => in_space(around, inner).map(Color::Known),
        _ => components(around, name, inner).map(Color::Known),
    }
}

/// Names of the components of a space, and what 100% of each is.
type Layout = [(&'static str, f64); 3];

/// The space of a function, its components, and whether numbers in it are hundredths of usvg's.
fn layout(name: &str) -> Option<(Space, Layout)> {
    Some(match name {
        "rgb" | "rgba" => (Space::Srgb, [("r", 255.0), ("g", 255.0), ("b", 255.0)]),
        "hsl" | "hsla" => (Space::Hsl, [("h", 360.0), ("s", 100.0), ("l", 100.0)]),
        "hwb" => (Space::Hwb, [("h", 360.0), ("w", 100.0), ("b", 100.0)]),
        "lab" => (Space::Lab, [("l", 100.0), ("a", 125.0), ("b", 125.0)]),
        "lch" => (Space::Lch, [("l", 100.0), ("c", 150.0), ("h", 360.0)]),
        "oklab" => (Space::Oklab, [("l", 1.0), ("a", 0.4), ("b", 0.4)]),
        "oklch" => (Space::Oklch, [("l", 1.0), ("c", 0.4), ("h", 360.0)]),
        _ => return None,
    })
}

fn components(around: &Surroundings<'_>, name: &str, inner: &[Value]) -> Option<DynamicColor> {
    let (space, layout) = layout(name)?;
    let inner = trim(inner);
    let is_legacy = inner.iter().any(|value| value.is_delim(','));
    if is_legacy {
        let parts = split(inner, ',');
        let parts: Option<Vec<&Value>> = parts
            .iter()
            .map(|part| match part {
                [value] => Some(value),
                _ => None,
            })
            .collect();
        let parts = parts?;
        let (three, alpha) = match parts.as_slice() {
            [a, b, c] => ([*a, *b, *c], None),
            [a, b, c, alpha] => ([*a, *b, *c], Some(*alpha)),
            _ => return None,
        };
        let allows_commas = matches!(name, "rgb" | "rgba" | "hsl" | "hsla");
        return allows_commas.then(|| make(around, space, layout, three, alpha))?;
    }
    let (origin, rest) = origin(around, inner)?;
    let (three, alpha) = three_and_alpha(&rest)?;
    relative(around, origin, space, layout, three, alpha)
}

/// A space of three amounts of light by its name.
fn light_space(name: &str) -> Option<Space> {
    Some(match name {
        "srgb" => Space::Srgb,
        "srgb-linear" => Space::LinearSrgb,
        "display-p3" => Space::DisplayP3,
        "a98-rgb" => Space::A98Rgb,
        "prophoto-rgb" => Space::ProphotoRgb,
        "rec2020" => Space::Rec2020,
        "xyz" | "xyz-d65" => Space::XyzD65,
        "xyz-d50" => Space::XyzD50,
        _ => return None,
    })
}

/// `color(space a b c / alpha)`.
fn in_space(around: &Surroundings<'_>, inner: &[Value]) -> Option<DynamicColor> {
    let (origin, rest) = origin(around, trim(inner))?;
    let (name, rest) = rest.split_first()?;
    let space = light_space(&name.keyword()?)?;
    let names = match space {
        Space::XyzD50 | Space::XyzD65 => ["x", "y", "z"],
        _ => ["r", "g", "b"],
    };
    let (three, alpha) = three_and_alpha(rest)?;
    relative(
        around,
        origin,
        space,
        names.map(|name| (name, 1.0)),
        three,
        alpha,
    )
}

/// The colour behind `from`, and the other words.
fn origin<'a>(
    around: &Surroundings<'_>,
    inner: &'a [Value],
) -> Option<(Option<DynamicColor>, Vec<&'a Value>)> {
    let words = words(inner);
    match words.split_first() {
        Some((first, [color, rest @ ..])) if first.keyword().as_deref() == Some("from") => {
            Some((Some(around.resolved(color)?), rest.to_vec()))
        }
        _ => Some((None, words)),
    }
}

type Written<'a> = ([&'a Value; 3], Option<&'a Value>);

fn three_and_alpha<'a>(words: &[&'a Value]) -> Option<Written<'a>> {
    match words {
        [a, b, c] => Some(([a, b, c], None)),
        [a, b, c, slash, alpha] if slash.is_delim('/') => Some(([a, b, c], Some(alpha))),
        _ => None,
    }
}

/// As [`make`], with the components of `origin` as names and its alpha as the default.
fn relative(
    around: &Surroundings<'_>,
    origin: Option<DynamicColor>,
    space: Space,
    layout: Layout,
    three: [&Value; 3],
    alpha: Option<&Value>,
) -> Option<DynamicColor> {
    let Some(origin) = origin else {
        return make(around, space, layout, three, alpha);
    };
    let [a, b, c, opacity] = origin.convert(space).components.map(f64::from);
    let scale = if space == Space::Srgb && layout[0].1 > 1.0 {
        255.0
    } else {
        1.0
    };
    let [(first, _), (second, _), (third, _)] = layout;
    let names = [
        (first, a * scale),
        (second, b * scale),
        (third, c * scale),
        ("alpha", opacity),
    ];
    let named = Surroundings {
        units: Units {
            names: &names,
            ..around.units
        },
        ..*around
    };
    let default = Value::Number(opacity);
    make(
        &named,
        space,
        layout,
        three,
        Some(alpha.unwrap_or(&default)),
    )
}

fn make(
    around: &Surroundings<'_>,
    space: Space,
    layout: Layout,
    three: [&Value; 3],
    alpha: Option<&Value>,
) -> Option<DynamicColor> {
    let mut missing = Missing::default();
    let is_none = |value: &Value| value.keyword().as_deref() == Some("none");
    let mut numbers = [0.0; 4];
    for (index, (value, (name, whole))) in three.into_iter().zip(layout).enumerate() {
        if is_none(value) {
            missing.insert(index);
            continue;
        }
        let number = match name {
            "h" => around.hue(value)?,
            _ => around.component(value, whole)?,
        };
        numbers[index] = match (space, name) {
            (Space::Srgb, _) if whole > 1.0 => (number / whole).clamp(0.0, 1.0),
            (Space::Lab | Space::Lch | Space::Oklab | Space::Oklch, "l") => {
                number.clamp(0.0, whole)
            }
            (Space::Hsl, "s") | (_, "c") => number.max(0.0),
            _ => number,
        };
    }
    numbers[3] = match alpha {
        None => 1.0,
        Some(value) if is_none(value) => {
            missing.insert(3);
            0.0
        }
        Some(value) => around.component(value, 1.0)?.clamp(0.0, 1.0),
    };
    #[expect(
        clippy::cast_possible_truncation,
        reason = "colours have less than 24 bits"
    )]
    let components = numbers.map(|number| number as f32);
    Some(DynamicColor {
        cs: space,
        flags: Flags::from_missing(missing),
        components,
    })
}

/// `color-mix(in space, a 30%, b)`.
fn mix(around: &Surroundings<'_>, inner: &[Value]) -> Option<DynamicColor> {
    let parts = split(inner, ',');
    let (method, colors) = match parts.as_slice() {
        [method, a, b] => (words(method), [*a, *b]),
        // CSS Color 5: Oklab where no space is named.
        [a, b] => (Vec::new(), [*a, *b]),
        _ => return None,
    };
    let (space, hue) = space(&method)?;
    let [first, second] = colors.map(|part| weighted(around, part));
    let ((first, p), (second, q)) = (first?, second?);
    let (p, q) = match (p, q) {
        (Some(p), Some(q)) => (p, q),
        (Some(p), None) => (p, 100.0 - p),
        (None, Some(q)) => (100.0 - q, q),
        (None, None) => (50.0, 50.0),
    };
    let sum = p + q;
    let in_range = |p: f64| (0.0..=100.0).contains(&p);
    if !in_range(p) || !in_range(q) || sum <= 0.0 {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "shares from 0 to 1")]
    let (share, alpha) = ((q / sum) as f32, (sum / 100.0).min(1.0) as f32);
    let mixed = first.interpolate(second, space, hue).eval(share);
    Some(mixed.multiply_alpha(alpha))
}

/// A colour and its percentage, in either order.
fn weighted(around: &Surroundings<'_>, part: &[Value]) -> Option<(DynamicColor, Option<f64>)> {
    let percent = |value: &Value| match around.units.quantity(value)? {
        super::length::Quantity::Length(0.0, percent) => Some(percent),
        _ => None,
    };
    match words(part).as_slice() {
        [color] => Some((around.resolved(color)?, None)),
        [a, b] => match around.resolved(a) {
            Some(color) => Some((color, Some(percent(b)?))),
            None => Some((around.resolved(b)?, Some(percent(a)?))),
        },
        _ => None,
    }
}

/// The space and the way around the hues of `in space longer hue`.
fn space(method: &[&Value]) -> Option<(Space, HueDirection)> {
    let (first, rest) = match method.split_first() {
        None => return Some((Space::Oklab, HueDirection::Shorter)),
        Some((first, rest)) => (first.keyword()?, rest),
    };
    let (space, way) = rest.split_first()?;
    let name = space.keyword()?;
    let space = match name.as_str() {
        "lab" => Space::Lab,
        "oklab" => Space::Oklab,
        "hsl" => Space::Hsl,
        "hwb" => Space::Hwb,
        "lch" => Space::Lch,
        "oklch" => Space::Oklch,
        other => light_space(other)?,
    };
    let hue = match way {
        [] => HueDirection::Shorter,
        [way, word] if word.keyword()? == "hue" => match way.keyword()?.as_str() {
            "shorter" => HueDirection::Shorter,
            "longer" => HueDirection::Longer,
            "increasing" => HueDirection::Increasing,
            "decreasing" => HueDirection::Decreasing,
            _ => return None,
        },
        _ => return None,
    };
    (first == "in").then_some((space, hue))
}
