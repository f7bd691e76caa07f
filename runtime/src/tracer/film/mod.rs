//! The picture as it is read back.

mod tone;

pub use tone::ToneMap;

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
                let [r, g, b] = tone_map.display(straight).map(byte);
                [r, g, b, byte(alpha)]
            })
            .collect()
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
    fn exposure_comes_before_the_tone_map() {
        let bytes = film([0.045, 0.045, 0.045, 1.0]).to_srgb8_with(4.0, ToneMap::AgX);
        assert_eq!(bytes, [128, 128, 128, 255]);
    }
}
