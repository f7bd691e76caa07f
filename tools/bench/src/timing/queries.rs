//! The lookups that every rival answers: same points, same footprints, same order.
//!
//! Kernels compute their queries from a few numbers (`wgsl/root.wgsl`), since a tracer has them in
//! registers too. Reading them from memory would cost more than the cheaper lookups.

use vtex_shaders::layout::BatchQuery;

/// Pixels of a window's longer side.
const WINDOW_PX: u32 = 512;
/// Screen order is by square tiles of this many pixels, as path tracers and rasterisers work.
const TILE_PX: u32 = 8;
/// Tiles along a block: 64 pixels.
const BLOCK_TILES: u32 = 8;
/// Along both axes one block out of this many is part of a frame of [`Screen::tour`].
const TOUR_STRIDE: u32 = 8;
/// Invocations of a workgroup, as `wgsl/root.wgsl` has them, and workgroups side by side.
const WORKGROUP: u32 = 256;
const GROUP_COLUMNS: u32 = 1024;
/// Magnification of the close windows: a pixel is a texel of a 4096^2 raster.
const CLOSE_ZOOM: f32 = 8.0;
/// 176 of 512 pixels: level 1.54 of a 512-texel mip chain, so that two levels count.
const MINIFIED_ZOOM: f32 = 0.34375;

/// A batch of lookups, as `wgsl/root.wgsl` makes them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuerySet {
    /// Short, for a column.
    pub(crate) name: &'static str,
    record: QueryRecord,
    /// How often each pixel is looked up, each time with another jitter.
    frames: u32,
}

/// Numbers from which query `i` follows, 40 bytes and 8 of padding.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct QueryRecord {
    /// Upper left corner in uv.
    origin: [f32; 2],
    /// A pixel in uv, which is the footprint.
    pixel: [f32; 2],
    /// Multiples of [`TILE_PX`].
    size_px: [u32; 2],
    /// 1: anywhere in the unit square instead of in screen order.
    scattered: u32,
    /// From block to block of [`BLOCK_TILES`] tiles, in blocks: 1 where they follow each other.
    stride: u32,
    /// Filled in by [`QuerySet::record`]: the lookups of a run, and 1 if their results are written.
    lookups: u32,
    keeps: u32,
    padding: [u32; 2],
}

impl QuerySet {
    /// Lookups of one run.
    pub(crate) fn len(&self) -> usize {
        let [width, height] = self.record.size_px;
        (width * height * self.frames) as usize
    }

    /// What kernels read: whether to write the results is the caller's to say.
    pub(crate) fn record(&self, keeps: bool) -> QueryRecord {
        QueryRecord {
            lookups: u32::try_from(self.len()).unwrap_or(u32::MAX),
            keeps: u32::from(keeps),
            ..self.record
        }
    }

    /// Enough workgroups for all lookups, and a few more: along an axis there may be 65,535.
    pub(crate) fn workgroups(&self) -> [u32; 2] {
        let count = u32::try_from(self.len())
            .unwrap_or(u32::MAX)
            .div_ceil(WORKGROUP);
        let columns = count.min(GROUP_COLUMNS);
        [columns, count.div_ceil(columns.max(1))]
    }

    /// The same pixels, no more than `most` lookups if one frame is no more.
    pub(crate) fn shorter(mut self, most: usize) -> Self {
        let pixels = self.len() / self.frames as usize;
        let frames = u32::try_from(most / pixels.max(1)).unwrap_or(u32::MAX);
        self.frames = self.frames.min(frames.max(1));
        self
    }

    /// Width and height of the window in uv.
    pub(crate) fn extent_uv(&self) -> [f32; 2] {
        let QueryRecord { pixel, size_px, .. } = self.record;
        [size_px[0] as f32 * pixel[0], size_px[1] as f32 * pixel[1]]
    }

    /// Query `index` as the kernels have it.
    pub(crate) fn query(&self, index: u32) -> BatchQuery {
        let QueryRecord {
            origin,
            pixel,
            size_px,
            scattered,
            stride,
            ..
        } = self.record;
        let seed = scramble(index);
        let jitter = [unit(seed), unit(scramble(seed ^ 0x9e37_79b9))];
        let tile = index / (TILE_PX * TILE_PX);
        let lane = index % (TILE_PX * TILE_PX);
        let [columns, rows] = size_px.map(|side| side / TILE_PX);
        let frame = tile / (columns * rows);
        // Each frame takes other blocks of those that the stride leaves out.
        let shift = [frame * 3 % stride, frame * 5 % stride];
        let place = [tile % columns, tile / columns % rows];
        let corner = [0, 1].map(|axis| {
            let block = place[axis] / BLOCK_TILES * stride + shift[axis];
            (block * BLOCK_TILES + place[axis] % BLOCK_TILES) * TILE_PX
        });
        let at = [corner[0] + lane % TILE_PX, corner[1] + lane / TILE_PX];
        let place = |axis: usize| origin[axis] + (at[axis] as f32 + jitter[axis]) * pixel[axis];
        let uv = if scattered == 1 {
            jitter
        } else {
            [place(0), place(1)]
        };
        BatchQuery {
            uv,
            footprint: [pixel[0], 0.0, 0.0, pixel[1]],
            ..BatchQuery::default()
        }
    }

    /// The queries one after the other.
    pub(crate) fn queries(&self) -> Vec<BatchQuery> {
        (0..)
            .take(self.len())
            .map(|index| self.query(index))
            .collect()
    }
}

/// A canvas as a screen sees it at 1x: its longer side spans [`WINDOW_PX`] pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screen {
    size_px: [f32; 2],
}

impl Screen {
    /// `canvas_size` in user units, both positive.
    pub(crate) fn new(canvas_size: [f32; 2]) -> Self {
        let pixels_a_unit = WINDOW_PX as f32 / canvas_size[0].max(canvas_size[1]);
        Self {
            size_px: canvas_size.map(|side| (side * pixels_a_unit).max(1.0)),
        }
    }

    /// The whole canvas in its 512 pixels.
    pub(crate) fn whole(self, count: usize) -> QuerySet {
        self.window("1x", 1.0, [0.0, 0.0], count)
    }

    /// The whole canvas in 176 pixels.
    pub(crate) fn minified(self, count: usize) -> QuerySet {
        self.window("1/2.9x", MINIFIED_ZOOM, [0.0, 0.0], count)
    }

    /// A window of 512 pixels at 8x, its corner at `origin_uv`.
    pub(crate) fn close(self, origin_uv: [f32; 2], count: usize) -> QuerySet {
        self.window("8x", CLOSE_ZOOM, origin_uv, count)
    }

    /// Blocks of 64 x 64 pixels at 8x from everywhere on the canvas: the mean over all that a close
    /// viewer passes.
    pub(crate) fn tour(self, count: usize) -> QuerySet {
        let mut set = self.window("8x, all", CLOSE_ZOOM, [0.0, 0.0], count);
        let zoomed = self.size_px.map(|side| side * CLOSE_ZOOM);
        let stride_px = TILE_PX * BLOCK_TILES * TOUR_STRIDE;
        let blocks = zoomed.map(|side| whole_tiles((side / stride_px as f32).floor(), 1));
        let tiles = blocks.map(|count| count * BLOCK_TILES);
        set.record.size_px = tiles.map(|count| count * TILE_PX);
        set.record.stride = TOUR_STRIDE;
        let pixels = (tiles[0] * tiles[1] * TILE_PX * TILE_PX) as usize;
        set.frames = u32::try_from(count / pixels).unwrap_or(u32::MAX).max(1);
        set
    }

    /// Points anywhere on the canvas with the footprint of 8x: what paths that have bounced see.
    pub(crate) fn scattered(self, count: usize) -> QuerySet {
        let mut set = self.window("8x, random", CLOSE_ZOOM, [0.0, 0.0], count);
        set.record.scattered = 1;
        set
    }

    /// Corners of windows that tile the canvas at 8x.
    pub(crate) fn close_corners(self) -> impl Iterator<Item = [f32; 2]> {
        let windows = self
            .size_px
            .map(|side| whole_tiles(side * CLOSE_ZOOM / WINDOW_PX as f32, 1));
        let [columns, rows] = windows;
        let corner = |index: u32, count: u32| index as f32 / count as f32;
        (0..rows)
            .flat_map(move |y| (0..columns).map(move |x| [corner(x, columns), corner(y, rows)]))
    }

    fn window(self, name: &'static str, zoom: f32, origin: [f32; 2], count: usize) -> QuerySet {
        let zoomed = self.size_px.map(|side| side * zoom);
        let size_px =
            zoomed.map(|side| (whole_tiles(side / TILE_PX as f32, 1) * TILE_PX).min(WINDOW_PX));
        let record = QueryRecord {
            origin,
            pixel: zoomed.map(f32::recip),
            size_px,
            scattered: 0,
            stride: 1,
            lookups: 0,
            keeps: 0,
            padding: [0; 2],
        };
        let pixels = (size_px[0] * size_px[1]) as usize;
        let frames = u32::try_from(count / pixels).unwrap_or(u32::MAX).max(1);
        QuerySet {
            name,
            record,
            frames,
        }
    }
}

/// Points on the canvas and a little around it, with footprints of any size and direction.
pub(crate) fn random_queries(count: usize) -> Vec<BatchQuery> {
    /// Of the canvas, on each side.
    const MARGIN: f32 = 0.05;
    /// The smallest footprint is 2 to the minus this of the canvas.
    const OCTAVES: f32 = 16.0;
    let mut seed = 0_u32;
    let mut next = || {
        seed = seed.wrapping_add(1);
        unit(scramble(seed))
    };
    let query = |_| {
        let uv = [next(), next()].map(|at| at * (1.0 + 2.0 * MARGIN) - MARGIN);
        let width = (-OCTAVES * next()).exp2();
        BatchQuery {
            uv,
            footprint: [(); 4].map(|()| width * (2.0 * next() - 1.0)),
            ..BatchQuery::default()
        }
    };
    (0..count).map(query).collect()
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

/// Rounds a count of tiles up; at least `least`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a positive count; the cast saturates"
)]
fn whole_tiles(count: f32, least: u32) -> u32 {
    (count.ceil() as u32).max(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn screen_order_visits_each_pixel_once_a_frame() {
        let set = Screen::new([3.0, 1.0]).window("", 0.0625, [0.0, 0.0], 1000);
        assert_eq!(
            (set.record.size_px, set.frames, set.len()),
            ([32, 16], 1, 512)
        );
        let pixel = |query: BatchQuery| {
            let [u, v] = query.uv;
            [
                (u / query.footprint[0]).floor(),
                (v / query.footprint[3]).floor(),
            ]
        };
        let mut seen: Vec<[f32; 2]> = set.queries().into_iter().map(pixel).collect();
        assert_eq!(seen[..2], [[0.0, 0.0], [1.0, 0.0]]);
        assert_eq!(
            (seen[8], seen[64], seen[256]),
            ([0.0, 1.0], [8.0, 0.0], [0.0, 8.0])
        );
        seen.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap());
        seen.dedup();
        assert_eq!(seen.len(), 512);
    }

    #[test]
    fn windows_have_the_size_asked_for_and_stay_on_the_canvas() {
        let screen = Screen::new([300.0, 100.0]);
        let sets = [
            screen.whole(300_000),
            screen.minified(300_000),
            screen.close([0.875, 0.5], 300_000),
            screen.scattered(300_000),
        ];
        for set in sets {
            assert!(
                (200_000..=300_000).contains(&set.len()),
                "{} {}",
                set.name,
                set.len()
            );
            // The last row of tiles may reach over the edge.
            let most = set.record.pixel.map(|pixel| 1.0 + 8.0 * pixel);
            for query in set.queries() {
                let inside = (0..2).all(|axis| (0.0..=most[axis]).contains(&query.uv[axis]));
                assert!(inside, "{} {:?}", set.name, query.uv);
            }
        }
    }

    #[test]
    fn close_windows_see_a_texel_of_4096_and_tile_the_canvas() {
        let screen = Screen::new([2.0, 1.0]);
        let query = screen.close([0.0, 0.0], 1).query(0);
        assert_eq!(query.footprint, [1.0 / 4096.0, 0.0, 0.0, 1.0 / 2048.0]);
        let corners: Vec<[f32; 2]> = screen.close_corners().collect();
        assert_eq!((corners.len(), corners[31]), (32, [0.875, 0.75]));
    }
}
