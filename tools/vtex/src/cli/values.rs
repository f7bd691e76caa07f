//! Values of options: how the text on the command line is read.

use std::time::Duration;

use clap::ValueEnum;
use vtex_truth::picture::View;

/// A colour, straight alpha, sRGB-encoded. A struct, so that clap does not see a list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Color(pub [f32; 4]);

/// A texture matrix. A struct, so that clap does not see a list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Matrix(pub [f32; 6]);

/// Pixels of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Size {
    /// The longer side; the other follows from what is shown.
    Longer(u32),
    /// Both sides.
    Exact([u32; 2]),
}

/// Most pixels along a side of a picture.
const MAX_SIDE_PX: u32 = 16_384;

pub(super) fn size(text: &str) -> Result<Size, String> {
    let side = |text: &str| match text.trim().parse() {
        Ok(side @ 1..=MAX_SIDE_PX) => Ok(side),
        _ => Err(format!("a side must be 1 to {MAX_SIDE_PX} pixels")),
    };
    match text.split_once(['x', 'X']) {
        Some((width, height)) => Ok(Size::Exact([side(width)?, side(height)?])),
        None => Ok(Size::Longer(side(text)?)),
    }
}

/// A number of bytes: digits, and K, M or G behind them for units of 1024.
pub(super) fn bytes(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let unit = |letter: char| match letter.to_ascii_uppercase() {
        'K' => Some(1 << 10),
        'M' => Some(1 << 20),
        'G' => Some(1 << 30),
        _ => None,
    };
    let (digits, unit) = match text.char_indices().next_back() {
        Some((at, letter)) if !letter.is_ascii_digit() => (&text[..at], unit(letter)),
        _ => (text, Some(1)),
    };
    let count = digits.parse::<u64>().ok().zip(unit);
    count
        .and_then(|(count, unit)| count.checked_mul(unit))
        .ok_or_else(|| {
            "expected a number of bytes, such as 65536, 64K, 4M or 2G, in units of 1024".to_owned()
        })
}

fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(number).collect();
    numbers
        .ok()
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| format!("expected {N} numbers, separated by commas"))
}

/// Farthest coordinate of a view, and the most that a view is magnified. Lookups take places as
/// `f32`: a view further out or smaller has so few of them that it shows flat steps.
const MAX_VIEW: f64 = 65_536.0;

pub(super) fn view(text: &str) -> Result<View, String> {
    let [u0, v0, u1, v1] = numbers(text)?;
    if u0 >= u1 || v0 >= v1 {
        return Err("left must be less than right, and top less than bottom".to_owned());
    }
    let view = View { u0, v0, u1, v1 };
    let farthest = [u0, v0, u1, v1]
        .map(f64::abs)
        .into_iter()
        .fold(1.0, f64::max);
    if farthest > MAX_VIEW {
        return Err(format!(
            "coordinates must lie between -{MAX_VIEW} and {MAX_VIEW}"
        ));
    }
    let least = farthest / MAX_VIEW;
    if view.extent().iter().any(|&side| side < least) {
        return Err(format!(
            "width and height of this view must be at least {least:e}"
        ));
    }
    Ok(view)
}

/// A finite number.
///
/// # Errors
/// A sentence when the text is none.
pub(super) fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(number) if f64::is_finite(number) => Ok(number),
        _ => Err("expected a number".to_owned()),
    }
}

/// Most stops that a picture is made brighter or darker.
const MAX_STOPS: f64 = 32.0;

/// Stops of an exposure.
#[expect(clippy::cast_possible_truncation, reason = "light is f32")]
pub(super) fn stops(text: &str) -> Result<f32, String> {
    match number(text)? {
        stops if stops.abs() <= MAX_STOPS => Ok(stops as f32),
        _ => Err(format!(
            "stops must lie between -{MAX_STOPS} and {MAX_STOPS}"
        )),
    }
}

/// An angle.
#[expect(clippy::cast_possible_truncation, reason = "angles are f32")]
pub(super) fn degrees(text: &str) -> Result<f32, String> {
    match number(text)? {
        degrees if degrees.abs() <= 360.0 => Ok(degrees as f32),
        _ => Err("degrees must lie between -360 and 360".to_owned()),
    }
}

/// Brightest sky: no more than the sun.
const MAX_RADIANCE: f64 = 1e10;

/// A radiance.
#[expect(clippy::cast_possible_truncation, reason = "light is f32")]
pub(super) fn level(text: &str) -> Result<f32, String> {
    match number(text)? {
        level if (0.0..=MAX_RADIANCE).contains(&level) => Ok(level as f32),
        _ => Err(format!("radiance must lie between 0 and {MAX_RADIANCE}")),
    }
}

/// Longest time limit: eleven days.
const MAX_SECONDS: f64 = 1e6;

/// A time of more than nothing.
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    match number(text)? {
        seconds if seconds > 0.0 && seconds <= MAX_SECONDS => Ok(Duration::from_secs_f64(seconds)),
        _ => Err(format!(
            "seconds must be more than 0 and at most {MAX_SECONDS}"
        )),
    }
}

#[expect(clippy::cast_possible_truncation, reason = "the format stores f32")]
pub(super) fn matrix(text: &str) -> Result<Matrix, String> {
    numbers(text).map(|matrix: [f64; 6]| Matrix(matrix.map(|number| number as f32)))
}

/// Parses a CSS colour (`#rgb`, `#rrggbbaa`, `rgb(...)`, `hsl(...)`, a name): straight alpha,
/// sRGB-encoded.
///
/// # Errors
/// A sentence when the text is no colour.
pub(super) fn color(text: &str) -> Result<Color, String> {
    let color: svgtypes::Color = text
        .trim()
        .parse()
        .map_err(|_| "not a CSS colour, such as #d03020 or navy".to_owned())?;
    let channels = [color.red, color.green, color.blue, color.alpha];
    Ok(Color(channels.map(|c| f32::from(c) / 255.0)))
}

/// What files are made for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Profile {
    /// Small files
    #[default]
    Size,
    /// Files that load four to thirty times as fast, for lookups of points, and are about three times as large, busy drawings six
    Load,
    /// The same, for lookups with the filter mode footprint
    LoadFootprints,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values() {
        assert_eq!(size("640x480"), Ok(Size::Exact([640, 480])));
        assert_eq!(size("512"), Ok(Size::Longer(512)));
        assert!(size("0").is_err() && size("9x").is_err());
        assert_eq!((bytes("70"), bytes(" 64k")), (Ok(70), Ok(65_536)));
        assert_eq!((bytes("4M"), bytes("2G")), (Ok(4 << 20), Ok(2 << 30)));
        for wrong in ["", "M", "4T", "-1", "1.5M", "99999999999G", "4\u{20ac}"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
        assert!(view("0,0,1").is_err() && view("1,0,0,1").is_err());
        let side = 1.0 / MAX_VIEW;
        assert!(view(&format!("0,0,{side},{side}")).is_ok());
        assert!(view(&format!("0,0,1,{}", 0.9 * side)).is_err());
        assert!(view("0,65535,1,65536").is_ok() && view("0,0,1,65537").is_err());
        assert!(view("100,0,100.001,1").is_err(), "few f32 there");
        assert_eq!(
            matrix("1,0,0,1,-.5,2"),
            Ok(Matrix([1.0, 0.0, 0.0, 1.0, -0.5, 2.0]))
        );
    }

    #[test]
    fn stops_and_seconds() {
        assert_eq!((stops("-1.5"), stops(" 32")), (Ok(-1.5), Ok(32.0)));
        assert!(stops("33").is_err() && stops("nan").is_err() && stops("").is_err());
        assert_eq!((degrees("-90"), level("0")), (Ok(-90.0), Ok(0.0)));
        assert!(degrees("361").is_err() && level("-1").is_err() && level("inf").is_err());
        assert_eq!(seconds("0.25"), Ok(Duration::from_millis(250)));
        for wrong in ["0", "-1", "inf", "nan", "2e6", "1m"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn colours_by_name_and_hex() {
        assert_eq!(color("red"), Ok(Color([1.0, 0.0, 0.0, 1.0])));
        assert_eq!(color("#00f8"), Ok(Color([0.0, 0.0, 1.0, 136.0 / 255.0])));
        assert!(color("reddish").is_err());
    }
}
