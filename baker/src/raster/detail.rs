//! Halving a raster that is finer than its own detail.

use rayon::prelude::*;

use crate::raster::{mips::LinearImage, texel};

/// Codes by which a channel of the coarser raster, interpolated as lookups do, may differ. They are
/// codes of sRGB-encoded colour times alpha, as paints are composited: where hardly anything shows, a
/// stored code stands for much less.
const MAX_ERROR: f32 = 2.0;
/// Texels of a side below which halving gains nothing.
const MIN_SIDE: u32 = 16;

/// The image, halved as long as nobody could see it. Soft shadows and blurs need few texels.
pub(crate) fn fitted(image: LinearImage) -> LinearImage {
    let mut fitted = image;
    while fitted.size.iter().all(|&side| side >= MIN_SIDE) {
        // Compared with the level above and not with the original: every level is a halving of the
        // last.
        let half = fitted.reduced(fitted.size.map(|side| side.div_ceil(2)));
        if !stands_for(&half, &fitted) {
            break;
        }
        fitted = half;
    }
    fitted
}

/// Whether lookups in `coarse` return nearly the texels of `fine`.
fn stands_for(coarse: &LinearImage, fine: &LinearImage) -> bool {
    let rows = fine.texels.par_chunks_exact(fine.size[0] as usize);
    rows.enumerate().all(|(y, row)| {
        let v = place(y, fine.size[1], coarse.size[1]);
        row.iter().enumerate().all(|(x, &texel)| {
            let found = bilinear(coarse, [place(x, fine.size[0], coarse.size[0]), v]);
            let [a, b] = [texel, found].map(texel::composited_codes);
            a.iter().zip(b).all(|(a, b)| (a - b).abs() <= MAX_ERROR)
        })
    })
}

/// Where the centre of fine texel `index` lies among the coarse ones: between which two, and the
/// share of the second. At the ends both are the same texel.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "sides are a few thousand"
)]
fn place(index: usize, fine: u32, coarse: u32) -> (usize, usize, f32) {
    let at = (index as f32 + 0.5) * coarse as f32 / fine as f32 - 0.5;
    let last = coarse as usize - 1;
    let low = at.floor().max(0.0) as usize;
    // Before the first centre lookups clamp to it.
    let share = (at - at.floor()) * f32::from(u8::from(at > 0.0));
    (low.min(last), (low + 1).min(last), share)
}

fn bilinear(image: &LinearImage, [u, v]: [(usize, usize, f32); 2]) -> [f32; 4] {
    let width = image.size[0] as usize;
    let texel = |x: usize, y: usize| image.texels[y * width + x];
    let mix = |a: [f32; 4], b: [f32; 4], t: f32| -> [f32; 4] {
        std::array::from_fn(|i| a[i] + t * (b[i] - a[i]))
    };
    let upper = mix(texel(u.0, v.0), texel(u.1, v.0), u.2);
    let lower = mix(texel(u.0, v.1), texel(u.1, v.1), u.2);
    mix(upper, lower, v.2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(texel: impl Fn(f32, f32) -> [f32; 4]) -> LinearImage {
        let texels = (0..128_u16).flat_map(|y| (0..200_u16).map(move |x| (x, y)));
        LinearImage {
            size: [200, 128],
            texels: texels
                .map(|(x, y)| texel(f32::from(x) / 200.0, f32::from(y) / 128.0))
                .collect(),
        }
    }

    #[test]
    fn soft_pictures_need_few_texels_and_sharp_ones_all() {
        let soft = image(|x, y| {
            let far = (x - 0.5).hypot(y - 0.5);
            let alpha = (-16.0 * far * far).exp();
            [0.3 * alpha, 0.1 * alpha, 0.0, alpha]
        });
        let fitted = fitted(soft);
        assert!(fitted.size[0] <= 50, "{:?}", fitted.size);
        let sharp = image(|x, y| if x + y < 0.8 { [1.0; 4] } else { [0.0; 4] });
        assert_eq!(super::fitted(sharp.clone()), sharp);
        // One texel of detail is enough to keep them all.
        let dot = image(|x, y| {
            if x == 0.5 && y == 0.5 {
                [1.0; 4]
            } else {
                [0.0; 4]
            }
        });
        assert_eq!(super::fitted(dot.clone()), dot);
    }
}
