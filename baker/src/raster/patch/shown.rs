//! The part of a picture in which anything shows.

/// Left, top, right, bottom in texels; the last two are one past the last texel.
pub(super) type Texels = [u32; 4];

/// The smallest part of rows of `width` texels that holds all of those that show, with one texel more
/// on each side as far as there is one, so that lookups fade out. `None` when nothing shows.
pub(super) fn shown_part<T>(
    texels: &[T],
    width: usize,
    shows: impl Fn(&T) -> bool,
) -> Option<Texels> {
    let mut columns: Option<(usize, usize)> = None;
    let mut rows: Option<(usize, usize)> = None;
    for (y, row) in texels.chunks_exact(width).enumerate() {
        let Some(first) = row.iter().position(&shows) else {
            continue;
        };
        let last = row.iter().rposition(&shows).unwrap_or(first);
        columns = Some(columns.map_or((first, last), |(a, b)| (a.min(first), b.max(last))));
        rows = Some(rows.map_or((y, y), |(a, _)| (a, y)));
    }
    let ((left, right), (top, bottom)) = (columns?, rows?);
    let height = texels.len() / width;
    let low = |place: usize| index(place.saturating_sub(1));
    let high = |place: usize, end: usize| index((place + 2).min(end));
    Some([
        low(left),
        low(top),
        high(right, width),
        high(bottom, height),
    ])
}

/// Sides of pictures are far below 2^32.
fn index(place: usize) -> u32 {
    u32::try_from(place).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::shown_part;

    #[test]
    fn one_texel_more_on_each_side() {
        let picture = |shown: [usize; 2]| {
            let mut texels = [false; 8 * 5];
            for place in shown {
                texels[place] = true;
            }
            shown_part(&texels, 8, |&texel| texel)
        };
        assert_eq!(picture([10, 28]), Some([1, 0, 6, 5]));
        assert_eq!(picture([0, 39]), Some([0, 0, 8, 5]));
        assert_eq!(shown_part(&[false; 40], 8, |&texel| texel), None);
    }
}
