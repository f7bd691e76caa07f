//! The picture as it is read back.

use vtex_shaders::srgb;

/// Mean of the samples so far.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Row by row from the top: linear radiance premultiplied by alpha, Rec. 709 primaries.
    /// Alpha is 1 unless [`Background::Transparent`](crate::Background) was asked for.
    pub pixels: Vec<[f32; 4]>,
    /// Samples a pixel that were averaged.
    pub samples: u32,
}

/// How radiance above 1 becomes a display value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    /// Cut off: colours up to 1 stay what they are.
    #[default]
    Clip,
    /// `x (1 + x / 16) / (1 + x)` of the luminance, Reinhard et al. 2002 eq. 4 with white at 4:
    /// for scenes with lights in view.
    Reinhard,
}

impl Film {
    /// Straight-alpha sRGB, four bytes a pixel, at exposure 1 with [`ToneMap::Clip`].
    pub fn to_srgb8(&self) -> Vec<u8> {
        self.to_srgb8_with(1.0, ToneMap::Clip)
    }

    /// Straight-alpha sRGB, four bytes a pixel; radiance is multiplied by `exposure` first.
    pub fn to_srgb8_with(&self, exposure: f32, tone_map: ToneMap) -> Vec<u8> {
        self.pixels
            .iter()
            .flat_map(|pixel| {
                let alpha = pixel[3].clamp(0.0, 1.0);
                let scale = if alpha > 0.0 { exposure / alpha } else { 0.0 };
                let straight = [pixel[0] * scale, pixel[1] * scale, pixel[2] * scale];
                let [r, g, b] = tone_map.apply(straight).map(|c| byte(srgb::encode(c)));
                [r, g, b, byte(alpha)]
            })
            .collect()
    }
}

impl ToneMap {
    fn apply(self, color: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Clip => color,
            Self::Reinhard => {
                // Of the luminance, not of each channel: bright colours keep their hue.
                let luminance = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
                color.map(|c| c * (1.0 + luminance / 16.0) / (1.0 + luminance))
            }
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the value lies in 0..=255"
)]
fn byte(unit: f32) -> u8 {
    (unit.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film(pixel: [f32; 4]) -> Film {
        Film {
            size: [1, 1],
            pixels: vec![pixel],
            samples: 1,
        }
    }

    #[test]
    fn premultiplied_radiance_becomes_straight_srgb() {
        let bytes = film([0.25, 0.5, 0.0, 0.5]).to_srgb8();
        // 0.5 linear is 188 in sRGB, half alpha rounds up.
        assert_eq!(bytes, [188, 255, 0, 128]);
    }

    #[test]
    fn nothing_is_transparent_black_and_much_is_white() {
        assert_eq!(film([0.0; 4]).to_srgb8(), [0, 0, 0, 0]);
        assert_eq!(film([9.0, 9.0, 9.0, 1.0]).to_srgb8(), [255; 4]);
    }

    #[test]
    fn reinhard_keeps_white_at_four() {
        let bytes = film([4.0, 4.0, 4.0, 1.0]).to_srgb8_with(1.0, ToneMap::Reinhard);
        assert_eq!(bytes, [255; 4]);
    }
}
