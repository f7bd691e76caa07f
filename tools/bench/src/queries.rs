//! The lookups that every rival answers: same points, same footprints, same order.

use vtex_shaders::layout::BatchQuery;

/// Pixels of a window's longer side.
const WINDOW_PX: u32 = 512;
/// Screen order is by square tiles of this many pixels, as path tracers and rasterisers work.
const TILE_PX: u32 = 8;
/// Windows along each side of the canvas at 8x.
pub(crate) const ZOOM: u32 = 8;

/// A named batch of lookups.
#[derive(Clone, Debug)]
pub(crate) struct QuerySet {
    /// Short, for a column.
    pub(crate) name: &'static str,
    pub(crate) queries: Vec<BatchQuery>,
}

/// A canvas as a screen sees it at 1x: its longer side spans [`WINDOW_PX`] pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screen {
    size_px: [f32; 2],
}

impl Screen {
    /// `canvas_size` in user units, both positive.
    pub(crate) fn new(canvas_size: [f32; 2]) -> Self {
        let pixels_a_unit = pixels(WINDOW_PX) / canvas_size[0].max(canvas_size[1]);
        Self {
            size_px: canvas_size.map(|side| (side * pixels_a_unit).max(1.0)),
        }
    }

    /// The whole canvas in its 512 pixels.
    pub(crate) fn whole(self, count: usize) -> QuerySet {
        self.window("1x", 1.0, [0.0, 0.0], count)
    }

    /// The canvas at 181 pixels: level 1.5 of a 512-texel mip chain, so that both levels count.
    pub(crate) fn minified(self, count: usize) -> QuerySet {
        self.window(
            "1/2.8x",
            std::f32::consts::FRAC_1_SQRT_2 / 2.0,
            [0.0, 0.0],
            count,
        )
    }

    /// A window of 512 pixels at 8x, its corner at `origin_uv`.
    pub(crate) fn close(self, origin_uv: [f32; 2], count: usize) -> QuerySet {
        self.window("8x", pixels(ZOOM), origin_uv, count)
    }

    /// Points anywhere on the canvas with the footprint of 8x: what paths that have bounced see.
    pub(crate) fn scattered(self, count: usize) -> QuerySet {
        let footprint = self.pixel_uv(pixels(ZOOM));
        let query = |index| {
            let bits = scramble(index);
            let uv = [unit(bits), unit(scramble(bits ^ 0x9e37_79b9))];
            BatchQuery {
                uv,
                footprint,
                ..BatchQuery::default()
            }
        };
        let queries = (0..).map(query).take(count).collect();
        QuerySet {
            name: "random",
            queries,
        }
    }

    /// One pixel at `zoom` as two axes in uv.
    fn pixel_uv(self, zoom: f32) -> [f32; 4] {
        let [width, height] = self.size_px;
        [1.0 / (width * zoom), 0.0, 0.0, 1.0 / (height * zoom)]
    }

    /// Pixels of a window in screen order, jittered, frame after frame until there are `count`.
    fn window(self, name: &'static str, zoom: f32, origin: [f32; 2], count: usize) -> QuerySet {
        let footprint = self.pixel_uv(zoom);
        let size = self.size_px.map(|side| whole_pixels(side * zoom));
        let mut queries = Vec::with_capacity(count);
        let mut frame = 0;
        while queries.len() < count {
            let free = count - queries.len();
            queries.extend(
                screen_order(size)
                    .take(free)
                    .enumerate()
                    .map(|(index, [x, y])| {
                        let seed = scramble(low_bits(index) ^ scramble(frame));
                        let at = [pixels(x) + unit(seed), pixels(y) + unit(scramble(seed))];
                        let uv = [
                            origin[0] + at[0] * footprint[0],
                            origin[1] + at[1] * footprint[3],
                        ];
                        BatchQuery {
                            uv,
                            footprint,
                            ..BatchQuery::default()
                        }
                    }),
            );
            frame += 1;
        }
        QuerySet { name, queries }
    }
}

/// Pixels of a screen, tile by tile; tiles at the right and lower edges may be cut.
fn screen_order([width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    let tiles = [width.div_ceil(TILE_PX), height.div_ceil(TILE_PX)];
    let tile_pixels = move |tile: u32| {
        let [x0, y0] = [tile % tiles[0] * TILE_PX, tile / tiles[0] * TILE_PX];
        (0..TILE_PX * TILE_PX).map(move |i| [x0 + i % TILE_PX, y0 + i / TILE_PX])
    };
    (0..tiles[0] * tiles[1])
        .flat_map(tile_pixels)
        .filter(move |&[x, y]| x < width && y < height)
}

/// A bijection on 32 bits without visible pattern (Wellons, "Prospecting for hash functions").
fn scramble(mut bits: u32) -> u32 {
    bits ^= bits >> 16;
    bits = bits.wrapping_mul(0x7feb_352d);
    bits ^= bits >> 15;
    bits = bits.wrapping_mul(0x846c_a68b);
    bits ^ (bits >> 16)
}

/// In [0, 1): 24 bits, what an f32 holds exactly.
fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 / (1 << 24) as f32
}

/// Pixel counts are far below 2^24.
fn pixels(count: u32) -> f32 {
    count as f32
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between 1 and WINDOW_PX after the clamp"
)]
fn whole_pixels(side: f32) -> u32 {
    side.round().clamp(1.0, pixels(WINDOW_PX)) as u32
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a seed; every bit pattern will do"
)]
fn low_bits(index: usize) -> u32 {
    index as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn screen_order_visits_each_pixel_once() {
        let size = [19, 10];
        let mut seen: Vec<[u32; 2]> = screen_order(size).collect();
        assert_eq!(
            seen[..9],
            [
                [0, 0],
                [1, 0],
                [2, 0],
                [3, 0],
                [4, 0],
                [5, 0],
                [6, 0],
                [7, 0],
                [0, 1]
            ]
        );
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), 190);
    }

    #[test]
    fn windows_stay_on_the_canvas() {
        let screen = Screen::new([300.0, 100.0]);
        let sets = [
            screen.whole(300_000),
            screen.minified(300_000),
            screen.close([0.875, 0.5], 300_000),
            screen.scattered(300_000),
        ];
        for set in sets {
            assert_eq!(set.queries.len(), 300_000, "{}", set.name);
            let outside = set.queries.iter().flat_map(|query| query.uv);
            assert!(
                outside.into_iter().all(|x| (0.0..=1.0001).contains(&x)),
                "{}",
                set.name
            );
        }
    }

    #[test]
    fn close_windows_see_a_texel_of_4096() {
        let set = Screen::new([2.0, 1.0]).close([0.0, 0.0], 1);
        assert_eq!(
            set.queries[0].footprint,
            [1.0 / 4096.0, 0.0, 0.0, 1.0 / 2048.0]
        );
    }
}
