//! Where rectangles lie in pages.

use super::skyline::Skyline;

/// Widths of a page that are tried, as parts of the side of a square with the area of all rectangles.
const WIDTHS: [f64; 6] = [0.7, 0.85, 1.0, 1.15, 1.3, 1.5];

/// Where a rectangle of texels lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Index of the page.
    pub page: u32,
    /// Texels to its left and above it.
    pub corner: [u32; 2],
}

/// Places of rectangles in pages of one size.
#[derive(Clone, Debug)]
pub(super) struct Arrangement {
    pub(super) page: [u32; 2],
    pub(super) count: usize,
    /// In the order of the rectangles.
    pub(super) places: Vec<Place>,
}

/// One page as small as it gets or, where that is larger than `page_side`, as many of that size as it
/// takes. A rectangle that is larger makes the pages larger.
pub(super) fn arrange(sizes: &[[u32; 2]], page_side: u32) -> Arrangement {
    let largest = sizes.iter().flatten().copied().max().unwrap_or(1);
    let side = page_side.max(largest);
    // The tallest first, and of equals the widest.
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|&index| {
        let [width, height] = sizes[index];
        std::cmp::Reverse([height, width])
    });
    let single = widths(sizes, side).into_iter().filter_map(|width| {
        let arranged = in_pages(sizes, &order, [width, side]);
        let texels = u64::from(arranged.page[0]) * u64::from(arranged.page[1]);
        (arranged.count == 1).then_some((texels, arranged))
    });
    let smallest = single.min_by_key(|&(texels, _)| texels);
    smallest.map_or_else(
        || in_pages(sizes, &order, [side; 2]),
        |(_, arranged)| arranged,
    )
}

/// Widths that are tried for a single page, in texels: those of squares, and some in which the
/// largest rectangle has the next ones beside it or below.
fn widths(sizes: &[[u32; 2]], side: u32) -> Vec<u32> {
    let area: f64 = sizes
        .iter()
        .map(|&[w, h]| f64::from(w) * f64::from(h))
        .sum();
    let mut across: Vec<u32> = sizes.iter().map(|&[width, _]| width).collect();
    across.sort_unstable_by_key(|&width| std::cmp::Reverse(width));
    let widest = across.first().copied().unwrap_or(1);
    let beside = across.iter().take(3).scan(0, |sum: &mut u32, &width| {
        *sum = sum.saturating_add(width);
        Some(*sum)
    });
    let square = WIDTHS.map(|part| whole(area.sqrt() * part));
    let tried = beside.chain(square);
    tried.map(|width| width.clamp(widest, side)).collect()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts of floats saturate"
)]
fn whole(side: f64) -> u32 {
    side.ceil() as u32
}

/// Each rectangle in the first page that has room for it, of this width and at most this height.
fn in_pages(sizes: &[[u32; 2]], order: &[usize], [width, most]: [u32; 2]) -> Arrangement {
    let nowhere = Place {
        page: 0,
        corner: [0; 2],
    };
    let mut places = vec![nowhere; sizes.len()];
    let mut pages: Vec<Skyline> = Vec::new();
    for &index in order {
        let found = (0..).zip(&mut pages).find_map(|(page, skyline)| {
            let corner = skyline.place(sizes[index], most)?;
            Some(Place { page, corner })
        });
        places[index] = found.unwrap_or_else(|| {
            let mut skyline = Skyline::new(width);
            let corner = skyline.place(sizes[index], u32::MAX).unwrap_or([0; 2]);
            pages.push(skyline);
            let page = u32::try_from(pages.len() - 1).unwrap_or(u32::MAX);
            Place { page, corner }
        });
    }
    let height = pages.iter().map(Skyline::height).max().unwrap_or(1);
    let right = |(place, size): (&Place, &[u32; 2])| place.corner[0] + size[0];
    let taken = places.iter().zip(sizes).map(right).max().unwrap_or(1);
    Arrangement {
        page: [taken, height],
        count: pages.len().max(1),
        places,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texels::MAX_PAGE_SIDE;

    /// Each lies in its page, and none on another.
    fn check(sizes: &[[u32; 2]]) -> Arrangement {
        check_in(sizes, MAX_PAGE_SIDE)
    }

    fn check_in(sizes: &[[u32; 2]], page_side: u32) -> Arrangement {
        let arranged = arrange(sizes, page_side);
        assert_eq!(arranged.places.len(), sizes.len());
        for (index, (place, size)) in arranged.places.iter().zip(sizes).enumerate() {
            assert!((place.page as usize) < arranged.count, "{sizes:?}");
            let inside = (0..2).all(|axis| place.corner[axis] + size[axis] <= arranged.page[axis]);
            assert!(inside, "{sizes:?}: {place:?}");
            for (other, other_size) in arranged.places.iter().zip(sizes).skip(index + 1) {
                let apart = (0..2).any(|axis| {
                    place.corner[axis] + size[axis] <= other.corner[axis]
                        || other.corner[axis] + other_size[axis] <= place.corner[axis]
                });
                assert!(apart || place.page != other.page, "{place:?} {other:?}");
            }
        }
        arranged
    }

    /// Levels of an image of this size, with borders.
    fn chain(size: [u32; 2]) -> Vec<[u32; 2]> {
        let levels = 32 - size[0].max(size[1]).leading_zeros();
        let side = |side: u32, level: u32| side.div_ceil(1 << level) + 2;
        (0..levels).map(|k| size.map(|s| side(s, k))).collect()
    }

    #[test]
    fn nothing_is_one_page_of_one_texel() {
        let arranged = check(&[]);
        assert_eq!((arranged.page, arranged.count), ([1, 1], 1));
    }

    #[test]
    fn levels_of_an_image_fill_their_page() {
        for (size, most) in [
            ([256, 256], 1.15),
            ([512, 128], 1.15),
            ([128, 512], 1.15),
            ([100, 37], 1.3),
        ] {
            let sizes = chain(size);
            let arranged = check(&sizes);
            let area: u32 = sizes.iter().map(|[w, h]| w * h).sum();
            let page = arranged.page[0] * arranged.page[1];
            let waste = f64::from(page) / f64::from(area);
            assert_eq!(arranged.count, 1);
            assert!(waste < most, "{size:?}: {:?}, {waste}", arranged.page);
        }
    }

    #[test]
    fn many_rectangles_fill_their_page() {
        let mut state = 7_u32;
        let mut random = |most: u32| {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            1 + (state >> 16) % most
        };
        let sizes: Vec<[u32; 2]> = (0..300)
            .flat_map(|_| chain([random(300), random(200)]))
            .collect();
        let arranged = check(&sizes);
        let area: u64 = sizes.iter().map(|[w, h]| u64::from(w * h)).sum();
        let page = u64::from(arranged.page[0]) * u64::from(arranged.page[1]);
        assert!(10 * page < 11 * area, "{page} texels for {area}");
    }

    #[test]
    fn what_one_page_cannot_hold_goes_into_several() {
        let arranged = check(&[
            [MAX_PAGE_SIDE; 2],
            [MAX_PAGE_SIDE, 5000],
            [3000, 4000],
            [10, 10],
        ]);
        assert_eq!(arranged.count, 3);
        assert_eq!(arranged.page, [MAX_PAGE_SIDE; 2]);
    }

    #[test]
    fn pages_are_no_larger_than_asked_but_for_a_larger_rectangle() {
        let arranged = check_in(&[[100, 90]; 8], 256);
        assert!(arranged.count > 1 && arranged.page.iter().all(|&side| side <= 256));
        let arranged = check_in(&[[300, 40], [40, 280], [100, 100]], 256);
        assert!(arranged.page.iter().all(|&side| side <= 300));
    }
}
