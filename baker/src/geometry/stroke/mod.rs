//! Expanding strokes to filled outlines: caps, joins, miter limits and dashes (SVG 2 sec. 13.5).

mod arcs;

use kurbo::{Affine, BezPath, Cap, Join, PathEl, Point, StrokeOpts, Vec2};

/// Most dashes of one path. A path with more becomes a continuous line of the dashes' mean opacity:
/// such dashes are far below a pixel at any useful zoom, or the file is hostile.
const MAX_DASHES: f64 = 100_000.0;
/// Length of subpaths and dashes that have none, in stroke widths. SVG draws their caps as dots;
/// kurbo needs a direction and would skip them.
const DOT_LENGTH: f64 = 1e-3;
/// Longer side of the canvas in the units in which strokes are expanded. kurbo measures dashes to
/// 1e-6 units whatever their size, so lengths must be neither tiny nor huge.
const WORK_UNITS: f64 = 1024.0;
/// Largest distance between an expanded stroke and the true one, in pixels at the largest zoom.
/// Together with the tolerances of lowering and rounding it stays below a fifth of a pixel.
const TOLERANCE_PX: f64 = 0.1;

/// A stroke in the path's own space.
#[derive(Clone, Debug)]
pub(crate) struct StrokeStyle {
    /// Full width.
    pub(crate) width: f64,
    /// Line cap.
    pub(crate) cap: Cap,
    /// Line join.
    pub(crate) join: Join,
    /// Miter limit as SVG defines it: miter length over stroke width.
    pub(crate) miter_limit: f64,
    /// Lengths of dashes and gaps in turn; empty for a continuous line.
    pub(crate) dashes: Vec<f64>,
    /// Distance into the dash pattern at which the line begins.
    pub(crate) dash_offset: f64,
}

/// An expanded stroke. Fill it with the non-zero rule.
#[derive(Debug)]
pub(crate) struct Expanded {
    /// In canvas space.
    pub(crate) outline: BezPath,
    /// 1, or the share of the line that its dashes cover if they were too many to draw.
    pub(crate) opacity: f32,
}

/// How finely strokes are expanded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StrokeQuality {
    /// Longer side of the canvas in user units.
    pub(crate) canvas_longer_side: f64,
    /// Pixels along that side at the largest zoom for which the outline must be right.
    pub(crate) longer_side_px: f64,
}

/// Expands `path` in its own space, then transforms the outline to the canvas: SVG wants a stroke
/// skewed and scaled together with its path.
///
/// `None` when the result is not finite or empty.
pub(crate) fn expand(
    path: &BezPath,
    style: &StrokeStyle,
    canvas_from_path: Affine,
    quality: StrokeQuality,
) -> Option<Expanded> {
    // Work at the size at which the stroke will be seen, whatever the units of the path are.
    let scale = largest_scale(canvas_from_path) * WORK_UNITS / quality.canvas_longer_side;
    if !(scale.is_finite() && scale > 0.0) {
        return None;
    }
    let work_from_path = Affine::scale(scale);
    let style = style.scaled(scale);
    let tolerance = TOLERANCE_PX * WORK_UNITS / quality.longer_side_px;
    let mut line = with_dots(&(work_from_path * path), &style);
    if !line.is_finite() || line.elements().is_empty() {
        return None;
    }
    let mut opacity = 1.0;
    if let Some(dashes) = style.drawable_dashes() {
        if dash_count(&line, &dashes, tolerance) <= MAX_DASHES {
            line = kurbo::dash(line.iter(), style.dash_offset, &dashes).collect();
        } else {
            opacity = duty(&dashes);
        }
    }
    let options = StrokeOpts::default();
    let mut outline = kurbo::stroke(line.iter(), &style.kurbo(), &options, tolerance);
    // Only round joins and caps have arcs.
    if style.is_round() {
        outline = arcs::refine(&outline, &line, 0.5 * style.width, tolerance);
    }
    // Back to the path's space, then to the canvas with whatever skew it has.
    let outline = canvas_from_path * work_from_path.inverse() * outline;
    outline.is_finite().then_some(Expanded { outline, opacity })
}

/// The larger singular value of the linear part: the most that the transform stretches a length.
fn largest_scale(transform: Affine) -> f64 {
    let [a, b, c, d, _, _] = transform.as_coeffs();
    // Eigenvalues of the matrix times its transpose; `max` because rounding may make the root
    // negative.
    let sum = a * a + b * b + c * c + d * d;
    let determinant = a * d - b * c;
    let root = (sum * sum - 4.0 * determinant * determinant)
        .max(0.0)
        .sqrt();
    ((sum + root) / 2.0).sqrt()
}

impl StrokeStyle {
    fn scaled(&self, scale: f64) -> Self {
        Self {
            width: self.width * scale,
            dashes: self.dashes.iter().map(|length| length * scale).collect(),
            dash_offset: self.dash_offset * scale,
            ..self.clone()
        }
    }

    fn is_round(&self) -> bool {
        self.cap == Cap::Round || self.join == Join::Round
    }

    /// kurbo's limit is half the miter length over half the width, the same ratio as SVG's.
    fn kurbo(&self) -> kurbo::Stroke {
        kurbo::Stroke::new(self.width)
            .with_caps(self.cap)
            .with_join(self.join)
            .with_miter_limit(self.miter_limit)
    }

    /// An even number of lengths in which every dash that shows has some length, or `None` for a
    /// continuous line.
    fn drawable_dashes(&self) -> Option<Vec<f64>> {
        // SVG 2: negative lengths and a sum of 0 mean a continuous line.
        let valid = self.dashes.iter().all(|d| d.is_finite() && *d >= 0.0);
        if !valid || self.dashes.iter().sum::<f64>() <= 0.0 {
            return None;
        }
        let mut dashes = self.dashes.clone();
        // SVG 2: an odd list is repeated once.
        if dashes.len() % 2 == 1 {
            dashes.extend_from_within(..);
        }
        // A dash of no length shows as a dot if the line has caps. It takes its length from the gap
        // behind it, so that the pattern keeps its period.
        for pair in dashes.chunks_exact_mut(2) {
            if pair[0] <= 0.0 && self.cap != Cap::Butt {
                pair[0] = (DOT_LENGTH * self.width).min(pair[1] / 2.0);
                pair[1] -= pair[0];
            }
        }
        Some(dashes)
    }
}

/// How many dashes the line has, about.
fn dash_count(line: &BezPath, dashes: &[f64], tolerance: f64) -> f64 {
    let length: f64 = line
        .segments()
        .map(|s| kurbo::ParamCurveArclen::arclen(&s, tolerance))
        .sum();
    length / dashes.iter().sum::<f64>() * (dashes.len() as f64 / 2.0)
}

/// Share of the pattern that dashes cover.
#[expect(clippy::cast_possible_truncation, reason = "a ratio in [0, 1]")]
fn duty(dashes: &[f64]) -> f32 {
    let on: f64 = dashes.iter().step_by(2).sum();
    (on / dashes.iter().sum::<f64>()) as f32
}

/// The line with a little length along x in each zero-length subpath, so that its caps are drawn
/// (SVG 2 sec. 13.5.4). Without caps such a subpath is left out.
fn with_dots(line: &BezPath, style: &StrokeStyle) -> BezPath {
    let mut out = BezPath::new();
    for subpath in subpaths(line) {
        // A lone move paints nothing; a move and a close is a zero-length subpath.
        let Some(PathEl::MoveTo(start)) = subpath.first().copied() else {
            continue;
        };
        let drawn = &subpath[1..];
        if drawn.is_empty() {
            continue;
        }
        if drawn.iter().any(|el| leaves(el, start)) {
            out.extend(subpath.iter().copied());
        } else if style.cap != Cap::Butt {
            out.move_to(start);
            out.line_to(start + Vec2::new(DOT_LENGTH * style.width, 0.0));
        }
    }
    out
}

/// Whether an element leaves the point `start`.
fn leaves(el: &PathEl, start: Point) -> bool {
    match *el {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => p != start,
        PathEl::QuadTo(p1, p) => p1 != start || p != start,
        PathEl::CurveTo(p1, p2, p) => p1 != start || p2 != start || p != start,
        PathEl::ClosePath => false,
    }
}

/// Splits before every move. An element after a close starts a subpath at the closed one's start.
fn subpaths(line: &BezPath) -> Vec<Vec<PathEl>> {
    let mut all: Vec<Vec<PathEl>> = Vec::new();
    let mut start = Point::ORIGIN;
    let mut closed = true;
    for &el in line.elements() {
        match el {
            PathEl::MoveTo(p) => {
                start = p;
                all.push(vec![el]);
            }
            _ if closed => all.push(vec![PathEl::MoveTo(start), el]),
            _ => all
                .last_mut()
                .into_iter()
                .for_each(|subpath| subpath.push(el)),
        }
        closed = el == PathEl::ClosePath;
    }
    all
}
