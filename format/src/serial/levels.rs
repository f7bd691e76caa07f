//! The order of `MIPS` sections in a file.

/// `(level, image)` in file order: the highest level first, images ascending within it.
pub(crate) fn level_order(
    level_counts: impl Iterator<Item = u32> + Clone,
) -> impl Iterator<Item = (u32, usize)> {
    let highest = level_counts.clone().max().unwrap_or(0);
    (0..highest).rev().flat_map(move |level| {
        let images = level_counts.clone().enumerate();
        images.filter_map(move |(image, count)| (level < count).then_some((level, image)))
    })
}
