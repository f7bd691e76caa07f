//! Basic shapes of `clip-path` to elements of SVG (CSS Shapes 1).

use kurbo::Rect;

use super::number_text;
use super::transform::Transforms;
use crate::style::syntax::{Value, split, words};

/// The element that shows the shape `name(inner)` in a reference box; `None` where it is no shape.
pub(in crate::style) fn element(
    transforms: &Transforms<'_>,
    bounds: Rect,
    name: &str,
    inner: &[Value],
) -> Option<String> {
    let n = number_text;
    match name {
        "circle" | "ellipse" => {
            let (radii, place) = at(inner);
            let [x, y] = match place {
                Some(place) => transforms.place(place)?,
                None => [bounds.width() / 2.0, bounds.height() / 2.0],
            };
            let radius = |value, axis| radius(transforms, value, [x, y], name, axis);
            let (rx, ry) = match words(radii).as_slice() {
                [] => (radius(None, 0)?, radius(None, 1)?),
                [one] if name == "circle" => (radius(Some(*one), 0)?, radius(Some(*one), 0)?),
                [a, b] if name == "ellipse" => (radius(Some(*a), 0)?, radius(Some(*b), 1)?),
                _ => return None,
            };
            let (cx, cy) = (n(bounds.x0 + x), n(bounds.y0 + y));
            let (rx, ry) = (n(rx), n(ry));
            Some(format!(
                "<ellipse cx=\"{cx}\" cy=\"{cy}\" rx=\"{rx}\" ry=\"{ry}\"/>"
            ))
        }
        "inset" | "rect" | "xywh" => rounded(transforms, bounds, name, inner),
        "polygon" => {
            let mut parts = split(inner, ',');
            let first = parts
                .first()
                .and_then(|part| part.first())
                .and_then(Value::keyword);
            let rule = match first.as_deref() {
                Some(rule @ ("nonzero" | "evenodd")) => rule.to_owned(),
                _ => "nonzero".to_owned(),
            };
            if first.is_some() {
                parts.remove(0);
            }
            let points: Option<Vec<String>> = parts
                .iter()
                .map(|part| {
                    let [x, y] = words(part).try_into().ok()?;
                    let x = bounds.x0 + transforms.length(x, 0)?;
                    let y = bounds.y0 + transforms.length(y, 1)?;
                    Some(format!("{},{}", n(x), n(y)))
                })
                .collect();
            let points = points?.join(" ");
            Some(format!(
                "<polygon clip-rule=\"{rule}\" points=\"{points}\"/>"
            ))
        }
        "path" => {
            let parts = split(inner, ',');
            let (rule, path) = match parts.as_slice() {
                [[Value::String(path)]] => ("nonzero".to_owned(), path),
                [[rule], [Value::String(path)]] => match rule.keyword()?.as_str() {
                    rule @ ("nonzero" | "evenodd") => (rule.to_owned(), path),
                    _ => return None,
                },
                _ => return None,
            };
            let is_path = path
                .chars()
                .all(|c| c.is_ascii_alphanumeric() || " ,.-+\t\n\r".contains(c));
            let (x, y) = (n(bounds.x0), n(bounds.y0));
            is_path.then(|| {
                format!(
                    "<path transform=\"translate({x} {y})\" clip-rule=\"{rule}\" d=\"{path}\"/>"
                )
            })
        }
        _ => None,
    }
}

/// What stands before and after `at`.
fn at(inner: &[Value]) -> (&[Value], Option<&[Value]>) {
    let place = inner
        .iter()
        .position(|value| value.keyword().as_deref() == Some("at"));
    match place {
        Some(place) => (&inner[..place], Some(&inner[place + 1..])),
        None => (inner, None),
    }
}

fn radius(
    transforms: &Transforms<'_>,
    value: Option<&Value>,
    center: [f64; 2],
    shape: &str,
    axis: usize,
) -> Option<f64> {
    let [width, height] = transforms.size;
    let sides = |axis: usize| {
        let size = transforms.size[axis];
        [center[axis].abs(), (size - center[axis]).abs()]
    };
    let keyword = match value {
        None => Some("closest-side".to_owned()),
        Some(value) => value.keyword(),
    };
    let distances: Vec<f64> = match shape {
        "circle" => [sides(0), sides(1)].concat(),
        _ => sides(axis).to_vec(),
    };
    match keyword.as_deref() {
        Some("closest-side") => distances.into_iter().reduce(f64::min),
        Some("farthest-side") => distances.into_iter().reduce(f64::max),
        Some(_) => None,
        None => {
            let whole = match shape {
                "circle" => width.hypot(height) / std::f64::consts::SQRT_2,
                _ => transforms.size[axis],
            };
            transforms.units.quantity(value?)?.length_px(whole)
        }
    }
}

/// `inset()`, `rect()` and `xywh()`, whose corners may be round.
fn rounded(
    transforms: &Transforms<'_>,
    bounds: Rect,
    name: &str,
    inner: &[Value],
) -> Option<String> {
    let place = inner
        .iter()
        .position(|value| value.keyword().as_deref() == Some("round"));
    let (sides, corners) = match place {
        Some(place) => (&inner[..place], &inner[place + 1..]),
        None => (inner, &inner[inner.len()..]),
    };
    let [width, height] = transforms.size;
    let words_of_sides = words(sides);
    let [top, right, bottom, left] = match name {
        "xywh" => {
            let [x, y, w, h] = words_of_sides.try_into().ok()?;
            let (x, y) = (transforms.length(x, 0)?, transforms.length(y, 1)?);
            let (w, h) = (transforms.length(w, 0)?, transforms.length(h, 1)?);
            [y, width - x - w, height - y - h, x]
        }
        _ => {
            let four = four(&words_of_sides)?;
            let mut edges = [0.0; 4];
            for (index, (edge, value)) in edges.iter_mut().zip(four).enumerate() {
                // Top and bottom are measured along the height.
                let is_auto = value.keyword().as_deref() == Some("auto");
                let axis = 1 - index % 2;
                let far = index == 1 || index == 2;
                *edge = match (name, is_auto) {
                    ("rect", true) => 0.0,
                    ("rect", false) if far => {
                        transforms.size[axis] - transforms.length(value, axis)?
                    }
                    _ => transforms.length(value, axis)?,
                };
            }
            edges
        }
    };
    let (x, y) = (bounds.x0 + left, bounds.y0 + top);
    let (w, h) = (
        (width - left - right).max(0.0),
        (height - top - bottom).max(0.0),
    );
    let parts = corners
        .split(|value| value.is_delim('/'))
        .collect::<Vec<_>>();
    let horizontal = radii(transforms, parts.first().copied().unwrap_or_default(), 0)?;
    let vertical = match parts.get(1) {
        Some(part) => radii(transforms, part, 1)?,
        None => radii(transforms, parts.first().copied().unwrap_or_default(), 1)?,
    };
    Some(round_rect(
        Rect::new(x, y, x + w, y + h),
        horizontal,
        vertical,
    ))
}

/// Top, right, bottom and left, or the corners from the top left one on.
fn four<'a>(values: &[&'a Value]) -> Option<[&'a Value; 4]> {
    Some(match *values {
        [a] => [a; 4],
        [a, b] => [a, b, a, b],
        [a, b, c] => [a, b, c, b],
        [a, b, c, d] => [a, b, c, d],
        _ => return None,
    })
}

fn radii(transforms: &Transforms<'_>, values: &[Value], axis: usize) -> Option<[f64; 4]> {
    let words = words(values);
    if words.is_empty() {
        return Some([0.0; 4]);
    }
    let [a, b, c, d] = four(&words)?.map(|value| transforms.length(value, axis));
    Some([a?, b?, c?, d?].map(|radius| radius.max(0.0)))
}

fn round_rect(rect: Rect, rx: [f64; 4], ry: [f64; 4]) -> String {
    // CSS Backgrounds 3: radii that do not fit shrink together.
    let fit = |side: f64, a: f64, b: f64| if a + b > side { side / (a + b) } else { 1.0 };
    let (w, h) = (rect.width(), rect.height());
    let factor = [
        fit(w, rx[0], rx[1]),
        fit(w, rx[2], rx[3]),
        fit(h, ry[0], ry[3]),
        fit(h, ry[1], ry[2]),
    ];
    let factor = factor.into_iter().fold(1.0, f64::min);
    let (rx, ry) = (rx.map(|r| r * factor), ry.map(|r| r * factor));
    let n = number_text;
    let arc = |corner: usize, x: f64, y: f64| {
        format!(
            "A{} {} 0 0 1 {} {}",
            n(rx[corner]),
            n(ry[corner]),
            n(x),
            n(y)
        )
    };
    let path = [
        format!("M{} {}", n(rect.x0 + rx[0]), n(rect.y0)),
        format!("H{}", n(rect.x1 - rx[1])),
        arc(1, rect.x1, rect.y0 + ry[1]),
        format!("V{}", n(rect.y1 - ry[2])),
        arc(2, rect.x1 - rx[2], rect.y1),
        format!("H{}", n(rect.x0 + rx[3])),
        arc(3, rect.x0, rect.y1 - ry[3]),
        format!("V{}", n(rect.y0 + ry[0])),
        arc(0, rect.x0 + rx[0], rect.y0),
    ];
    format!("<path d=\"{}Z\"/>", path.concat())
}
