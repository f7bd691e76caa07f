//! Colours of CSS Color 4 and 5, computed to the sRGB bytes that usvg takes.

use color::{ColorSpaceTag, DynamicColor, Flags, Srgb};

use super::color_function;
use super::length::{Quantity, Units};
use super::number_text;
use crate::style::syntax::Value;

/// A colour as it is written, before the colour of text is known.
#[derive(Clone, Copy, Debug)]
pub(in crate::style) enum Color {
    Current,
    Known(DynamicColor),
}

/// What a colour may refer to.
#[derive(Clone, Copy)]
pub(in crate::style) struct Surroundings<'a> {
    pub(in crate::style) units: Units<'a>,
    /// The value of `color`.
    pub(in crate::style) current: DynamicColor,
    /// Whether the colour scheme is dark without a choice.
    pub(in crate::style) is_dark: bool,
}

impl Surroundings<'_> {
    /// Reads a colour; `None` where CSS knows none.
    pub(in crate::style) fn color(&self, value: &Value) -> Option<Color> {
        match value {
            Value::Hash(hex) => {
                let is_hex = hex.bytes().all(|byte| byte.is_ascii_hexdigit());
                let color = color::parse_color(&format!("#{hex}")).ok()?;
                is_hex.then_some(Color::Known(color))
            }
            Value::Ident(name) => self.named(&name.to_ascii_lowercase()),
            Value::Function(name, inner) => color_function::read(self, name, inner),
            _ => None,
        }
    }

    /// As [`Self::color`], with `currentColor` as the colour that it is here.
    pub(in crate::style) fn resolved(&self, value: &Value) -> Option<DynamicColor> {
        match self.color(value)? {
            Color::Current => Some(self.current),
            Color::Known(color) => Some(color),
        }
    }

    fn named(&self, name: &str) -> Option<Color> {
        if name == "currentcolor" {
            return Some(Color::Current);
        }
        if let Some([light, dark]) = system(name) {
            let [r, g, b] = if self.is_dark { dark } else { light };
            let bytes = [r, g, b].map(|byte: u8| f32::from(byte) / 255.0);
            return Some(Color::Known(srgb([bytes[0], bytes[1], bytes[2], 1.0])));
        }
        by_name(name).map(Color::Known)
    }

    /// A component of a colour: a number, or a percentage of `whole`.
    pub(in crate::style) fn component(&self, value: &Value, whole: f64) -> Option<f64> {
        match self.units.quantity(value)? {
            Quantity::Number(number) => Some(number),
            Quantity::Length(0.0, percent) => Some(percent * whole / 100.0),
            _ => None,
        }
    }

    pub(in crate::style) fn hue(&self, value: &Value) -> Option<f64> {
        match self.units.quantity(value)? {
            Quantity::Number(degrees) | Quantity::Degrees(degrees) => Some(degrees),
            Quantity::Length(..) => None,
        }
    }
}

/// A colour by its name in lower case.
pub(in crate::style) fn by_name(name: &str) -> Option<DynamicColor> {
    let is_word = name.bytes().all(|byte| byte.is_ascii_lowercase());
    // The crate knows one spelling of the two.
    is_word.then(|| color::parse_color(&name.replace("grey", "gray")).ok())?
}

/// A colour in sRGB with an alpha that is not multiplied in.
pub(in crate::style) fn srgb(components: [f32; 4]) -> DynamicColor {
    DynamicColor {
        cs: ColorSpaceTag::Srgb,
        flags: Flags::default(),
        components,
    }
}

/// System colours on a light and a dark page, as Chromium on Linux has them.
fn system(name: &str) -> Option<[[u8; 3]; 2]> {
    const BLACK: [u8; 3] = [0, 0, 0];
    const WHITE: [u8; 3] = [255, 255, 255];
    Some(match name {
        "canvas" | "window" | "background" | "appworkspace" => [WHITE, [18, 18, 18]],
        "field" => [WHITE, [59, 59, 59]],
        "canvastext"
        | "windowtext"
        | "captiontext"
        | "infotext"
        | "menutext"
        | "fieldtext"
        | "buttontext"
        | "inactivecaptiontext" => [BLACK, WHITE],
        "linktext" | "-webkit-link" => [[0, 0, 238], [158, 158, 255]],
        "visitedtext" => [[85, 26, 139], [208, 173, 240]],
        "activetext" => [[255, 0, 0], [255, 158, 158]],
        "buttonface" | "threedface" | "buttonhighlight" | "threedhighlight"
        | "threedlightshadow" | "buttonshadow" | "threedshadow" | "threeddarkshadow" => {
            [[239, 239, 239], [107, 107, 107]]
        }
        "buttonborder" | "activeborder" | "inactiveborder" | "windowframe" => [BLACK, BLACK],
        "graytext" => [[128, 128, 128], [128, 128, 128]],
        "highlight" | "selecteditem" => [[0, 120, 215], [0, 120, 215]],
        "highlighttext" | "selecteditemtext" => [WHITE, WHITE],
        "accentcolor" => [[0, 117, 255], [0, 117, 255]],
        "accentcolortext" => [WHITE, WHITE],
        "mark" => [[255, 255, 0], [255, 255, 0]],
        "marktext" => [BLACK, BLACK],
        "activecaption" | "inactivecaption" | "infobackground" | "menu" | "scrollbar" => {
            [WHITE, [18, 18, 18]]
        }
        _ => return None,
    })
}

/// The colour as usvg reads it. What lies outside of sRGB is clipped, as browsers do it.
pub(in crate::style) fn dialect(color: DynamicColor) -> String {
    let components = color.to_alpha_color::<Srgb>().components;
    let [r, g, b, alpha] = components.map(|c| {
        if c.is_finite() {
            c.clamp(0.0, 1.0)
        } else {
            0.0
        }
    });
    let [r, g, b] = [r, g, b].map(byte);
    if alpha >= 1.0 {
        return format!("#{r:02x}{g:02x}{b:02x}");
    }
    format!("rgba({r}, {g}, {b}, {})", number_text(f64::from(alpha)))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a rounded number from 0 to 255"
)]
fn byte(component: f32) -> u8 {
    // Half a step of f32 must not turn 127.5 of `rgb()` around.
    (component * 255.0 + 1e-4).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::syntax::parse;

    #[test]
    fn colors_are_those_of_chromium() {
        let surroundings = Surroundings {
            units: Units {
                font_size_px: 16.0,
                root_font_size_px: 16.0,
                canvas_px: [100.0, 100.0],
                names: &[],
            },
            current: srgb([1.0, 0.0, 0.0, 1.0]),
            is_dark: false,
        };
        let cases = [
            ("RED", "#ff0000"),
            ("#f008", "rgba(255, 0, 0, 0.533333)"),
            ("rgb(0 0 255 / 50%)", "rgba(0, 0, 255, 0.5)"),
            ("rgb(10%, 20%, 30%)", "#1a334d"),
            (
                "rgba(128.5, 20.25, 200.75, .75)",
                "rgba(129, 20, 201, 0.75)",
            ),
            ("hsl(120deg 100% 25%)", "#008000"),
            ("hsla(.5turn, 100%, 50%, 1)", "#00ffff"),
            ("hwb(0 0% 0% / calc(1 / 4))", "rgba(255, 0, 0, 0.25)"),
            ("light-dark(rgb(1, 2, 3), #fff)", "#010203"),
            ("color(srgb 1 .5 0)", "#ff8000"),
            ("color-mix(in srgb, red, blue)", "#800080"),
            ("color-mix(in srgb, red 25%, blue)", "#4000bf"),
            (
                "color-mix(in srgb, currentColor 50%, transparent)",
                "rgba(255, 0, 0, 0.5)",
            ),
            (
                "color-mix(in srgb, red 20%, blue 20%)",
                "rgba(128, 0, 128, 0.4)",
            ),
            ("rgb(from #123456 b g r)", "#563412"),
            ("rgb(from red r g b / 50%)", "rgba(255, 0, 0, 0.5)"),
            ("hsl(from red calc(h + 120) s l)", "#00ff00"),
            ("oklch(from white l c h)", "#ffffff"),
            ("CanvasText", "#000000"),
            ("lightGrey", "#d3d3d3"),
            ("darkslategrey", "#2f4f4f"),
        ];
        for (css, wanted) in cases {
            let values = parse(css).unwrap();
            let found = surroundings.resolved(&values[0]).map(dialect);
            assert_eq!(found.as_deref(), Some(wanted), "{css}");
        }
        for css in [
            "rgb(1 2)",
            "#12",
            "#12345g",
            "rgb(1, 2 3)",
            "hsl(1, 2, 3, 4, 5)",
            "lab(a b c)",
        ] {
            let values = parse(css).unwrap();
            assert!(surroundings.color(&values[0]).is_none(), "{css}");
        }
    }
}
