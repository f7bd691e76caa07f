//! The curves of one outline, sorted into bands.

use super::index;
use super::outlines::{Curve, Outline};

/// A band has about this many curves of its outline's, until there are too many bands.
const CURVES_PER_BAND: usize = 2;
const MAX_BANDS: usize = 256;
/// Bands overlap by this part of their height, so that rounding on the GPU loses no curve.
const OVERLAP: f32 = 1.0 / 256.0;

/// Curves and their bands.
pub(super) struct Sorted {
    /// Left, top, right, bottom.
    pub(super) bounds: [f32; 4],
    /// Horizontal and vertical bands.
    pub(super) bands: [u32; 2],
    /// Indices of curves for each horizontal, then each vertical band. The curves that reach
    /// farthest to the right, or down, come first.
    pub(super) lists: Vec<Vec<u32>>,
    /// First end and control point; the last end is the first of the next.
    pub(super) curves: Vec<[f32; 4]>,
}

impl Sorted {
    /// `first` is the index of the first curve; `None` for an outline without an inside.
    pub(super) fn new(outline: &Outline, first: usize) -> Option<Self> {
        let mut curves = Vec::new();
        let mut numbered: Vec<(u32, Curve)> = Vec::new();
        for contour in &outline.contours {
            for curve in contour {
                numbered.push((index(first + curves.len()), *curve));
                let [[x0, y0], [x1, y1], _] = *curve;
                curves.push([x0, y0, x1, y1]);
            }
            let [x, y] = contour.last()?[2];
            curves.push([x, y, x, y]);
        }
        let range = |axis: usize| range(numbered.iter().flat_map(|(_, c)| c.map(|p| p[axis])));
        let ([left, right], [top, bottom]) = (range(0), range(1));
        if !(left < right && top < bottom) {
            return None;
        }
        let count = (numbered.len() / CURVES_PER_BAND).clamp(1, MAX_BANDS);
        let mut lists = bands(&numbered, 1, [top, bottom], count);
        lists.extend(bands(&numbered, 0, [left, right], count));
        Some(Self {
            bounds: [left, top, right, bottom],
            bands: [index(count); 2],
            lists,
            curves,
        })
    }
}

/// Bands across `axis`.
fn bands(
    curves: &[(u32, Curve)],
    axis: usize,
    [low, high]: [f32; 2],
    count: usize,
) -> Vec<Vec<u32>> {
    let height = (high - low) / count as f32;
    let reach = |curve: &Curve, axis: usize| range(curve.map(|point| point[axis]).into_iter());
    let mut sorted: Vec<&(u32, Curve)> = curves
        .iter()
        // A ray along a level line does not cross it.
        .filter(|(_, curve)| {
            let [from, to] = reach(curve, axis);
            from < to
        })
        .collect();
    let far = |curve: &Curve| reach(curve, 1 - axis)[1];
    sorted.sort_by(|a, b| far(&b.1).total_cmp(&far(&a.1)));
    let list = |band: usize| {
        let from = low + (band as f32 - OVERLAP) * height;
        let to = low + (band as f32 + 1.0 + OVERLAP) * height;
        let holds = |curve: &Curve| {
            let [start, end] = reach(curve, axis);
            start <= to && end >= from
        };
        let held = sorted.iter().filter(|(_, curve)| holds(curve));
        held.map(|(number, _)| *number).collect()
    };
    (0..count).map(list).collect()
}

fn range(values: impl Iterator<Item = f32>) -> [f32; 2] {
    values.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_lists_the_curves_that_cross_it() {
        let line = |a: [f32; 2], b: [f32; 2]| [a, a, b];
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let square = (0..4).map(|i| line(corners[i], corners[(i + 1) % 4]));
        let outline = Outline {
            color: [1.0; 4],
            even_odd: false,
            contours: vec![square.collect()],
        };
        let sorted = Sorted::new(&outline, 10).unwrap();
        assert_eq!(sorted.bounds, [0.0, 0.0, 1.0, 1.0]);
        assert_eq!(sorted.bands, [2, 2]);
        // The sides, the right one first; then bottom and top.
        assert_eq!(sorted.lists, [[11, 13], [11, 13], [12, 10], [12, 10]]);
        assert_eq!(sorted.curves.len(), 5);
        assert_eq!(sorted.curves[4], [0.0; 4]);
    }
}
