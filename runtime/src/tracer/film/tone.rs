//! Tone maps: how light of any strength becomes the colour of a display.

#![expect(clippy::doc_markdown, reason = "AgX is a name")]

use vtex_shaders::srgb;

/// How linear light becomes a colour of the display.
///
/// Each takes any number: negative light and NaN are black, light without end is the brightest that
/// the display has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    /// Cut off: colours up to 1 stay what they are.
    #[default]
    Clip,
    /// AgX without a look \[AgX\]: ten stops below mid grey and six and a half above, and strong
    /// colours fade towards white. Mid grey, 0.18, is half way up the display's scale.
    AgX,
    /// ACES, reference rendering and output transforms in Hill's fit \[ACES\]: more contrast, and
    /// darker. Mid grey, 0.18, becomes 0.106.
    Aces,
}

impl ToneMap {
    /// The sRGB-encoded colour of linear light with Rec. 709 primaries, channels in `0..=1`.
    #[must_use]
    pub fn display(self, light: [f32; 3]) -> [f32; 3] {
        // Of a number and NaN `max` returns the number.
        let light = light.map(|c| c.max(0.0));
        let shown = match self {
            Self::Clip => light.map(|c| srgb::encode(c.min(1.0))),
            Self::AgX => agx(light),
            Self::Aces => aces(light),
        };
        shown.map(|c| c.clamp(0.0, 1.0))
    }
}

/// Mid grey: the light of which the scales of AgX count stops.
const MID_GREY: f32 = 0.18;
/// Stops of light below mid grey, and above, that AgX tells apart.
const STOPS: [f32; 2] = [10.0, 6.5];
/// What AgX moves the primaries towards white by, so that strong colours have room to fade.
const INSET: f32 = 0.2;
/// Shares of the Rec. 709 primaries in white as points of the chromaticity diagram weigh them,
/// by `X + Y + Z`.
const WHITE: [f32; 3] = [0.212_005_36, 0.392_182_5, 0.395_812_14];

/// \[AgX\]: towards white, a sigmoid of the logarithm, and back. What comes out is encoded for the display.
fn agx(light: [f32; 3]) -> [f32; 3] {
    let shown = towards_white(light, INSET).map(|c| {
        let stops = (c / MID_GREY).log2();
        sigmoid(((stops + STOPS[0]) / (STOPS[0] + STOPS[1])).clamp(0.0, 1.0))
    });
    // The inverse of the inset: the same map with this share.
    towards_white(shown, -INSET / (1.0 - INSET))
}

/// Mixes a colour with the grey of which its primaries would have the same weight in white. In the
/// chromaticity diagram that moves the primaries by `share` of their way to white.
fn towards_white(color: [f32; 3], share: f32) -> [f32; 3] {
    let grey: f32 = color.iter().zip(WHITE).map(|(c, weight)| c * weight).sum();
    color.map(|c| (1.0 - share) * c + share * grey)
}

/// The curve of \[AgX\]: slope 2 at mid grey, which becomes a half; 0 stays 0 and 1 stays 1. In the
/// exact form, of which renderers on GPUs use a polynomial that leaves black grey.
fn sigmoid(x: f32) -> f32 {
    const SLOPE: f32 = 2.0;
    let pivot = STOPS[0] / (STOPS[0] + STOPS[1]);
    let (reach, power) = if x < pivot {
        (pivot, 3.0)
    } else {
        (1.0 - pivot, 3.25)
    };
    let distance = x - pivot;
    // The bend that takes the line through the pivot to a half at the end of its reach.
    let bend = (SLOPE * reach / 0.5).powf(power) - 1.0;
    let bent = 1.0 + bend * (distance.abs() / reach).powf(power);
    0.5 + SLOPE * distance * bent.powf(-1.0 / power)
}

/// \[ACES\]: sRGB to the space of the reference rendering transform, saturation included.
const ACES_FROM_SRGB: [[f32; 3]; 3] = [
    [0.59719, 0.35458, 0.04823],
    [0.07600, 0.90834, 0.01566],
    [0.02840, 0.13383, 0.83777],
];
/// \[ACES\]: from the space of the output transform to linear sRGB.
const SRGB_FROM_ACES: [[f32; 3]; 3] = [
    [1.60475, -0.53108, -0.07367],
    [-0.10208, 1.10813, -0.00605],
    [-0.00327, -0.07276, 1.07602],
];

fn aces(light: [f32; 3]) -> [f32; 3] {
    // The curve is flat long before this; its squares would pass the largest number.
    const MOST: f32 = 65_504.0;
    let curved = product(&ACES_FROM_SRGB, light.map(|c| c.min(MOST))).map(|v| {
        let above = v * (v + 0.024_578_6) - 0.000_090_537;
        let below = v * (0.983_729 * v + 0.432_951) + 0.238_081;
        above / below
    });
    product(&SRGB_FROM_ACES, curved).map(|c| srgb::encode(c.clamp(0.0, 1.0)))
}

fn product(rows: &[[f32; 3]; 3], color: [f32; 3]) -> [f32; 3] {
    rows.map(|row| row.iter().zip(color).map(|(a, c)| a * c).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [ToneMap; 3] = [ToneMap::Clip, ToneMap::AgX, ToneMap::Aces];

    fn grey(map: ToneMap, light: f32) -> f32 {
        let [r, g, b] = map.display([light; 3]);
        // The rows of the matrices have five digits.
        assert!((r - g).abs() < 2e-4 && (g - b).abs() < 2e-4, "{map:?}");
        g
    }

    #[test]
    fn black_is_black_and_enough_light_is_white() {
        for map in ALL {
            assert!(grey(map, 0.0) < 1e-6, "{map:?}: {}", grey(map, 0.0));
            assert!(grey(map, 1e4) > 0.999, "{map:?}: {}", grey(map, 1e4));
        }
    }

    #[test]
    fn more_light_is_never_darker() {
        for map in ALL {
            let mut before = grey(map, 0.0);
            for step in 0..=2000 {
                let shown = grey(map, (step as f32 / 50.0 - 20.0).exp2());
                assert!(shown >= before - 1e-6, "{map:?}: step {step}");
                before = shown;
            }
        }
    }

    #[test]
    fn mid_grey_is_where_it_is_published() {
        let wanted = [
            (ToneMap::Clip, 0.461_36),
            (ToneMap::AgX, 0.5),
            // The output transform takes 0.18 to 0.1056 of white.
            (ToneMap::Aces, 0.358_46),
        ];
        for (map, wanted) in wanted {
            let shown = grey(map, MID_GREY);
            assert!((shown - wanted).abs() < 1e-3, "{map:?}: {shown}");
        }
    }

    #[test]
    fn any_number_gives_a_colour() {
        let numbers = [
            0.0,
            -1.0,
            1.0,
            f32::MIN_POSITIVE,
            f32::MAX,
            f32::MIN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::NAN,
        ];
        for map in ALL {
            for r in numbers {
                for g in numbers {
                    let shown = map.display([r, g, 0.5]);
                    let inside = shown.iter().all(|c| (0.0..=1.0).contains(c));
                    assert!(inside, "{map:?}: {r} {g}: {shown:?}");
                }
            }
            let black = map.display([f32::NAN, -9.0, f32::NEG_INFINITY]);
            assert!(black.iter().all(|&c| c < 1e-6), "{map:?}: {black:?}");
        }
    }

    /// The matrices that \[AgX\] lists follow from the inset of 0.2.
    #[test]
    fn inset_and_outset_are_the_published_ones() {
        let inset = [
            [0.842_401, 0.042_401, 0.042_401],
            [0.078_436, 0.878_436, 0.078_436],
            [0.079_162, 0.079_162, 0.879_162],
        ];
        for (channel, wanted) in inset.into_iter().enumerate() {
            let mut unit = [0.0; 3];
            unit[channel] = 1.0;
            let inside = towards_white(unit, INSET);
            let back = towards_white(inside, -INSET / (1.0 - INSET));
            for (((inside, wanted), back), unit) in inside.iter().zip(wanted).zip(back).zip(unit) {
                assert!((inside - wanted).abs() < 1e-6, "{inside} {wanted}");
                assert!((back - unit).abs() < 1e-6, "{back} {unit}");
            }
        }
    }

    /// Values of the polynomial of degree six in wide use, which is within 0.006 of the curve.
    #[test]
    fn the_curve_is_that_of_agx() {
        let polynomial = |x: f32| {
            let coefficients = [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232];
            coefficients.iter().fold(0.0, |sum, c| sum * x + c)
        };
        for step in 0..=100 {
            let x = step as f32 / 100.0;
            let (exact, near) = (sigmoid(x), polynomial(x));
            assert!((exact - near).abs() < 6e-3, "{x}: {exact} {near}");
        }
    }

    #[test]
    fn a_bright_red_fades_with_agx_and_stays_red_when_clipped() {
        let red = [50.0, 0.5, 0.5];
        assert!(ToneMap::Clip.display(red)[1] < 0.75);
        let [r, g, b] = ToneMap::AgX.display(red);
        assert!(r > 0.99 && g > 0.75 && b > 0.75, "{r} {g} {b}");
    }
}
