//! Where the samples of a pixel lie.

use std::ops::Range;

/// The samples of a picture, as pixels of a finer picture.
///
/// The finer picture of a turned pattern with `n` samples along a side is turned by `atan(1 / n)`
/// against the wanted picture and `sqrt(n^2 + 1)` times as fine: a step of one wanted pixel is the
/// step `(n, -1)` there. Since that is a whole number of fine pixels, all pixels have the same
/// `n^2 + 1` samples at the same places, and no two of them share a column or row of the wanted
/// picture: a vertical or horizontal edge has `n^2 + 1` different places, not `n`. (A rank-1
/// lattice; Sloan and Joe 1994.)
#[derive(Clone, Debug)]
pub(crate) struct SamplePattern {
    /// The matrix from pixels to fine pixels is `((n, t), (-t, n))`; `t` is 1 if turned, else 0.
    n: u32,
    t: u32,
    /// Rows and columns of the samples of pixel (0, 0).
    runs: Vec<(i64, Range<i64>)>,
}

impl SamplePattern {
    /// With `n` samples along a pixel's side.
    pub(crate) fn new(n: u32, turned: bool) -> Self {
        let mut pattern = Self {
            n,
            t: u32::from(turned),
            runs: Vec::new(),
        };
        let reach = i64::from(n) + 1;
        for row in -reach..=reach {
            let mut columns =
                (-reach..=reach).filter(|&column| pattern.in_first_pixel(column, row));
            if let Some(first) = columns.next() {
                // A pixel is convex, so the columns follow each other.
                let last = columns.next_back().unwrap_or(first);
                pattern.runs.push((row, first..last + 1));
            }
        }
        pattern
    }

    /// Whether the centre of a fine pixel lies in pixel (0, 0). Its left and top edges belong to it,
    /// its right and bottom edges to the next pixels, so that no sample counts twice.
    fn in_first_pixel(&self, column: i64, row: i64) -> bool {
        let [n, t] = [self.n, self.t].map(i64::from);
        // Twice the centre, so that all numbers are integers and the comparison is exact.
        let [x, y] = [2 * column + 1, 2 * row + 1];
        let side = 0..2 * (n * n + t * t);
        side.contains(&(n * x - t * y)) && side.contains(&(t * x + n * y))
    }

    /// Samples of a pixel.
    pub(crate) fn sample_count(&self) -> u32 {
        self.n * self.n + self.t * self.t
    }

    /// Width and height of the finer picture of `tile_px` pixels.
    pub(crate) fn fine_size(&self, tile_px: [u32; 2]) -> [u32; 2] {
        let [width, height] = tile_px;
        [
            self.n * width + self.t * height,
            self.n * height + self.t * width,
        ]
    }

    /// A vector in pixels as one in fine pixels.
    pub(crate) fn turn(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [n, t] = [self.n, self.t].map(f64::from);
        [n * x + t * y, n * y - t * x]
    }

    /// A point in pixels from the corner of a tile as one in the finer picture of the tile.
    pub(crate) fn fine_from_px(&self, point: [f64; 2], tile_px: [u32; 2]) -> [f64; 2] {
        let [x, y] = self.turn(point);
        [x, y + f64::from(self.t * tile_px[0])]
    }

    /// Corner of a tile's finer picture in that of the whole picture of `size_px`.
    pub(crate) fn fine_corner(
        &self,
        origin_px: [u32; 2],
        size_px: [u32; 2],
        tile_px: [u32; 2],
    ) -> [f64; 2] {
        let origin = origin_px.map(f64::from);
        let [x, y] = self.fine_from_px(origin, size_px);
        [x, y - f64::from(self.t * tile_px[0])]
    }

    /// Rows and columns of the samples of a pixel in the finer picture of its tile.
    pub(crate) fn samples_of(
        &self,
        [x, y]: [u32; 2],
        tile_px: [u32; 2],
    ) -> impl Iterator<Item = (usize, Range<usize>)> {
        let column = i64::from(self.n * x + self.t * y);
        let row = i64::from(self.n * y + self.t * tile_px[0]) - i64::from(self.t * x);
        // Never negative, since the finer picture holds all samples of its tile.
        let index = |place: i64| usize::try_from(place).unwrap_or_default();
        self.runs.iter().map(move |(at, columns)| {
            let columns = index(column + columns.start)..index(column + columns.end);
            (index(row + at), columns)
        })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn pixels_share_the_finer_picture_without_rest() {
        for (n, turned) in [(1, false), (16, false), (1, true), (2, true), (16, true)] {
            let pattern = SamplePattern::new(n, turned);
            let tile_px = [5, 3];
            let [width, height] = pattern.fine_size(tile_px);
            let mut seen = BTreeSet::new();
            for y in 0..tile_px[1] {
                for x in 0..tile_px[0] {
                    let samples = pattern.samples_of([x, y], tile_px);
                    let places = samples.flat_map(|(row, columns)| columns.map(move |c| (row, c)));
                    let before = seen.len();
                    seen.extend(places);
                    let added = u32::try_from(seen.len() - before).unwrap();
                    assert_eq!(added, pattern.sample_count(), "{n} {x} {y}");
                }
            }
            let fits =
                |&(row, column): &(usize, usize)| row < height as usize && column < width as usize;
            assert!(seen.iter().all(fits));
        }
    }

    #[test]
    fn a_turned_pixel_has_one_sample_a_column_and_a_row() {
        let pattern = SamplePattern::new(16, true);
        let mut across = BTreeSet::new();
        let mut down = BTreeSet::new();
        for (row, columns) in &pattern.runs {
            for column in columns.clone() {
                // As in `in_first_pixel`: twice the place in the pixel, in 257ths.
                let [x, y] = [2 * column + 1, 2 * row + 1];
                across.insert(16 * x - y);
                down.insert(x + 16 * y);
            }
        }
        assert_eq!([across.len(), down.len()], [257; 2]);
    }
}
