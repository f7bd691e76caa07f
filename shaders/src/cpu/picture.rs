//! Twin of `vtex/picture_*.wgsl`, `vtex/lists_*.wgsl` and `vtex/draws_*.wgsl`: what the cells show to
//! a lookup.

use vtex_format::Features;

use super::cell::{cell, corner, level};
use super::cost::Observer;
use super::math::to_f32;
use super::plane::Vec2;
use super::rows::{CellRows, Phase, Rows, extent};
use super::samples::{Point, Samples};
use super::walk::{Resolved, walk};
use super::{Lookup, Sampler, groups, mapping, paint, paper};
use crate::layout::rows::SAMPLES;
use crate::layout::{cell, cmd, filter};

/// Farther than any place in cells, and still finite by the number of samples a cell.
const FAR: f32 = 1e24;
/// By how much of its side the list of a cell goes beyond it.
const OVERLAP: f32 = cell::OVERLAP as f32 / 16.0;
/// How wide cells are at least, in what the samples of a footprint may be away from its centre.
const WIDTHS: f32 = 2.0;
/// Places are kept three halves of a unit inside the canvas and samples count from one unit on: rounding
/// puts no place beyond it.
const INSIDE: f32 = 2.0 / 3.0;
/// What of its side a cell's clearance is counted in.
const PART: f32 = 1.0 / cell::CLEARANCE_PARTS as f32;

/// Linear light, premultiplied.
pub(super) fn picture(
    sampler: &Sampler<'_>,
    lookup: &Lookup,
    observer: &mut impl Observer,
) -> [f32; 4] {
    let s = &sampler.settings;
    let p = [0, 1].map(|axis| lookup.uv[axis] * s.scale[axis] + s.offset[axis]);
    if s.filter == filter::FOOTPRINT {
        return average(sampler, lookup, p, observer);
    }
    let found = cell(sampler, p, observer);
    let corner = corner(sampler, p);
    let q = [0, 1].map(|i| p[i] - corner[i]);
    point(sampler, lookup, found.word, q, observer)
}

/// What a cell with `word` shows to a point lookup.
pub(super) fn point(
    sampler: &Sampler<'_>,
    lookup: &Lookup,
    word: u32,
    q: Vec2,
    observer: &mut impl Observer,
) -> [f32; 4] {
    let [units, margin] = sampler.settings.curve_lattice;
    let samples = Point {
        uv: lookup.uv,
        q,
        p: q.map(|q| q * units + margin),
    };
    lists(sampler, lookup, word, &samples, 1, observer).sum
}

/// The mean of what the cells show to a footprint's samples, pass by pass.
fn average(
    sampler: &Sampler<'_>,
    lookup: &Lookup,
    p: Vec2,
    observer: &mut impl Observer,
) -> [f32; 4] {
    let mut canvas = Canvas::new(sampler, lookup, p);
    let mut pass = canvas.pass(sampler, canvas.centre, observer);
    // Most footprints lie in one paint.
    if pass.whole && pass.word >> cell::TAG_SHIFT < cell::LIST {
        return point(sampler, lookup, pass.word, canvas.centre, observer);
    }
    let halvings = sampler.settings.halvings;
    let phase = Phase::new(p, lookup.axes);
    canvas.rows = Rows::new(canvas.centre, lookup.axes, phase, halvings);
    let mut sum = [0.0; 4];
    let mut count = 0.0;
    let mut live = canvas.rows.every();
    let mut own = 0;
    for _ in 0..=SAMPLES {
        let mask = if pass.whole {
            live
        } else {
            // Rounding must not leave out the one that the pass is for.
            (canvas.rows.within(pass.low, pass.high) | own) & live
        };
        if pass.beyond {
            live &= !mask;
        } else {
            let samples = CellRows::new(sampler, lookup, &canvas.rows, pass.cell, canvas.centre);
            let resolved = lists(sampler, lookup, pass.word, &samples, mask, observer);
            sum = std::array::from_fn(|i| sum[i] + resolved.sum[i]);
            count += to_f32(resolved.done.count_ones());
            live &= !resolved.done;
        }
        if live == 0 {
            if count > 0.0 {
                break;
            }
            // None is on the canvas: the lookup's own place stands for all.
            canvas.rows = Rows::new(canvas.centre, [0.0; 4], Phase::default(), halvings);
            canvas.low = [-FAR; 2];
            canvas.high = [FAR; 2];
            live = canvas.rows.every();
        }
        let next = live.trailing_zeros();
        own = 1 << next;
        pass = canvas.pass(sampler, canvas.rows.place(next), observer);
    }
    sum.map(|channel| channel / count.max(1.0))
}

/// A footprint's samples and the canvas, in cells, from the corner of the cell that the lookup's
/// centre lies in.
struct Canvas {
    /// That corner.
    home: Vec2,
    centre: Vec2,
    extent: Vec2,
    /// Cells are no smaller than the footprint: no more than 2 to this along one of the file's.
    most: i32,
    /// Not made before they are needed.
    rows: Rows,
    /// The canvas.
    low: Vec2,
    high: Vec2,
}

/// The samples of one pass: those in a cell, or in a square around it that shows the same, or those
/// beyond one side of the canvas, which do not count.
struct Pass {
    word: u32,
    /// The corner of the file's cell.
    cell: Vec2,
    low: Vec2,
    high: Vec2,
    /// All samples lie between.
    whole: bool,
    beyond: bool,
}

impl Canvas {
    fn new(sampler: &Sampler<'_>, lookup: &Lookup, p: Vec2) -> Self {
        let s = &sampler.settings;
        let home = p.map(f32::floor);
        let centre = [p[0] - home[0], p[1] - home[1]];
        let inset = [0, 1].map(|i| INSIDE * mapping::inset(sampler, i) * s.scale[i]);
        let low = [0, 1].map(|i| s.offset[i] + inset[i] - home[i]);
        let extent = extent(lookup.axes);
        let width = if s.has(Features::GROUPS) {
            0.0
        } else {
            WIDTHS * extent[0].max(extent[1])
        };
        Self {
            home,
            centre,
            extent,
            // The power of two above the width. Textures with groups have no levels.
            most: 126 - (width.to_bits() >> cell::EXPONENT_SHIFT).cast_signed(),
            rows: Rows::default(),
            low,
            high: [0, 1].map(|i| s.scale[i] - 2.0 * inset[i] + low[i]),
        }
    }

    /// The pass for what lies at `place`.
    fn pass(&self, sampler: &Sampler<'_>, place: Vec2, observer: &mut impl Observer) -> Pass {
        let p = [0, 1].map(|i| place[i] + self.home[i]);
        let found = level(sampler, p, self.most, observer);
        let side = found.side();
        let word = found.word;
        let corner = corner(sampler, p);
        let cell = [0, 1].map(|i| corner[i] - self.home[i]);
        // A list serves what is near, as far as its cell of the file goes.
        let listed = word >> cell::TAG_SHIFT >= cell::LIST;
        let clearance = to_f32(word >> cell::CLEARANCE_SHIFT & cell::CLEARANCE_MASK);
        let around = if listed { OVERLAP } else { clearance * PART } * side;
        let mut pass = Pass {
            word,
            cell,
            low: self.low,
            high: self.high,
            whole: true,
            beyond: false,
        };
        for (i, &cell) in cell.iter().enumerate() {
            if listed {
                pass.low[i] = pass.low[i].max(cell);
                pass.high[i] = pass.high[i].min(cell + 1.0);
            }
            let corner = found.at[i] * side - self.home[i];
            pass.low[i] = pass.low[i].max(corner - around);
            pass.high[i] = pass.high[i].min(corner + around + side);
            pass.whole &= pass.low[i] <= self.centre[i] - self.extent[i];
            pass.whole &= self.centre[i] + self.extent[i] < pass.high[i];
        }
        let [before, behind] = [
            [0, 1].map(|i| place[i] < self.low[i]),
            [0, 1].map(|i| place[i] >= self.high[i]),
        ];
        if (0..2).any(|i| before[i] || behind[i]) {
            pass.beyond = true;
            pass.low = [0, 1].map(|i| if behind[i] { self.high[i] } else { -FAR });
            pass.high = [0, 1].map(|i| if before[i] { self.low[i] } else { FAR });
        }
        pass
    }
}

/// Where a footprint's samples lie in uv.
pub(super) fn places(sampler: &Sampler<'_>, lookup: &Lookup) -> Vec<Vec2> {
    let s = &sampler.settings;
    let p = [0, 1].map(|axis| lookup.uv[axis] * s.scale[axis] + s.offset[axis]);
    let Canvas {
        home,
        centre,
        low,
        high,
        ..
    } = Canvas::new(sampler, lookup, p);
    let rows = Rows::new(centre, lookup.axes, Phase::new(p, lookup.axes), s.halvings);
    let samples = (0..1 << s.halvings).map(|index| rows.place(index));
    let on = |place: &Vec2| (0..2).all(|i| low[i] <= place[i] && place[i] < high[i]);
    let mut places: Vec<Vec2> = samples.filter(on).collect();
    if places.is_empty() {
        places.push(centre);
    }
    let uv = |place: Vec2| [0, 1].map(|i| (place[i] + home[i] - s.offset[i]) / s.scale[i]);
    places.into_iter().map(uv).collect()
}

/// What a cell with `word` shows to the samples of `live`.
fn lists<S: Samples>(
    sampler: &Sampler<'_>,
    lookup: &Lookup,
    word: u32,
    samples: &S,
    live: u32,
    observer: &mut impl Observer,
) -> Resolved {
    let payload = word & cell::PAYLOAD_MASK;
    let offset = payload.wrapping_mul(cmd::WORDS);
    let first = sampler.settings.commands.wrapping_add(offset);
    match word >> cell::TAG_SHIFT {
        cell::SOLID => {
            observer.paint(0);
            let paint = word & cell::PAINT_MASK;
            let color = paint::linear(sampler, paint, samples.uv(live));
            Resolved::of(color, live)
        }
        cell::LIST if sampler.settings.has(Features::PAPER) => {
            paper::paper(sampler, lookup, first, samples)
        }
        cell::LIST => walk(sampler, lookup, first, samples, live, observer),
        cell::GROUPS => groups::groups(sampler, lookup, first, samples, live, observer),
        _ => Resolved::of([0.0; 4], live),
    }
}
