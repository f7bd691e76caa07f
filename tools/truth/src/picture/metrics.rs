//! Metrics: how far a picture is from the truth.
//!
//! Both pictures are composited over white in linear light and sRGB-encoded to the scale
//! \[0, 255\], without rounding. With `d` the difference of a channel of a pixel:
//!
//! - **PSNR** `= 10 log10(255^2 / mean(d^2))` in dB, the mean over all pixels and R, G, B; at most
//!   [`PSNR_CAP_DB`], which stands for "identical".
//! - **wrong pixels**: share of pixels with `max |d| > 8` in some channel.
//! - **max difference**: the largest `|d|`.
//!
//! Masks are compared by alpha, as opaque grey pictures.

use super::Picture;
use crate::srgb;

/// PSNR of equal pictures, dB. Real pictures that differ in one pixel by one step stay below.
pub const PSNR_CAP_DB: f64 = 120.0;
/// A pixel is wrong when a channel differs by more than this, of 255.
pub const WRONG_ABOVE: f32 = 8.0;

/// The figures of one comparison.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Difference {
    /// Peak signal-to-noise ratio, dB.
    pub psnr_db: f64,
    /// Share of wrong pixels, in \[0, 1\].
    pub wrong_share: f64,
    /// Largest difference of a channel, in \[0, 255\].
    pub max_difference: f32,
    /// The pixel with the largest difference.
    pub max_at_px: [u32; 2],
}

/// Compares two pictures of one size.
///
/// # Panics
/// When the sizes differ.
pub fn difference(truth: &Picture, picture: &Picture) -> Difference {
    assert_eq!(
        truth.size_px, picture.size_px,
        "pictures of one size are compared"
    );
    let [truth_rgb, picture_rgb] = [truth.over(1.0), picture.over(1.0)];
    let mut square_sum = 0.0_f64;
    let mut wrong = 0_u64;
    let mut worst = (0.0_f32, 0_u32);
    for (index, (a, b)) in (0_u32..).zip(truth_rgb.iter().zip(&picture_rgb)) {
        let steps: [f32; 3] = std::array::from_fn(|c| (a[c] - b[c]).abs() * 255.0);
        square_sum += steps
            .iter()
            .map(|&d| f64::from(d) * f64::from(d))
            .sum::<f64>();
        let largest = steps[0].max(steps[1]).max(steps[2]);
        wrong += u64::from(largest > WRONG_ABOVE);
        if largest > worst.0 {
            worst = (largest, index);
        }
    }
    let count = truth_rgb.len() as f64;
    let mean = square_sum / (3.0 * count);
    Difference {
        psnr_db: (10.0 * (255.0 * 255.0 / mean).log10()).min(PSNR_CAP_DB),
        wrong_share: wrong as f64 / count,
        max_difference: worst.0,
        max_at_px: [worst.1 % truth.size_px[0], worst.1 / truth.size_px[0]],
    }
}

/// The difference of two pictures of one size as a picture: sRGB codes, multiplied by `gain`, on
/// black.
///
/// # Panics
/// When the sizes differ.
pub fn difference_picture(truth: &Picture, picture: &Picture, gain: f32) -> Picture {
    assert_eq!(
        truth.size_px, picture.size_px,
        "pictures of one size are compared"
    );
    let [truth_rgb, picture_rgb] = [truth.over(1.0), picture.over(1.0)];
    let pixel = |(a, b): (&[f32; 3], &[f32; 3])| {
        let apart = |c: usize| srgb::decode((gain * (a[c] - b[c]).abs()).min(1.0));
        [apart(0), apart(1), apart(2), 1.0]
    };
    Picture {
        size_px: truth.size_px,
        pixels: truth_rgb.iter().zip(&picture_rgb).map(pixel).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(codes: &[u8]) -> Picture {
        let pixel = |&code: &u8| {
            let linear = srgb::decode(f32::from(code) / 255.0);
            [linear, linear, linear, 1.0]
        };
        Picture {
            size_px: [u32::try_from(codes.len()).unwrap(), 1],
            pixels: codes.iter().map(pixel).collect(),
        }
    }

    #[test]
    fn known_differences() {
        let truth = grey(&[100, 100, 100, 100]);
        assert!(difference(&truth, &truth).psnr_db >= PSNR_CAP_DB);
        let found = difference(&truth, &grey(&[100, 110, 100, 100]));
        // mean square 100 / 4 = 25: 10 log10(65025 / 25) = 34.15 dB.
        assert!((found.psnr_db - 34.151).abs() < 0.01, "{found:?}");
        assert!((found.wrong_share - 0.25).abs() < 1e-12, "{found:?}");
        assert_eq!(found.max_at_px, [1, 0]);
        assert!(difference(&truth, &grey(&[92, 108, 100, 101])).wrong_share < 1e-12);
        let shown = difference_picture(&truth, &grey(&[100, 110, 100, 100]), 4.0);
        let codes: Vec<u8> = shown.to_straight_srgb().into_iter().step_by(4).collect();
        assert_eq!(codes, [0, 40, 0, 0]);
    }
}
