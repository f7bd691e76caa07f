//! Coloured edges of an outline, from segments that are safe to measure distances to.

use fdsm::{
    bezier::{Order, Segment},
    color::Color,
    shape::{ColoredContour, ColoredSegment, Contour},
};
use kurbo::{
    BezPath, CubicBez, Line, ParamCurve, ParamCurveArclen, PathEl, PathSeg, Point, QuadBez, Shape,
};
use nalgebra::Point2;

use crate::geometry::{flatten_segment, set_end, set_start};

/// Segments and handles shorter than this many texels are collapsed. They are noise to a distance
/// field: the direction of a tiny segment decides signs far away from it.
const COLLAPSE_TEXELS: f64 = 0.05;
/// Sine of the smallest turn that counts as a corner: msdfgen's default angle of 3 rad.
const CORNER_SINE: f64 = 0.14;
/// How far quadratics may be from the cubic that they replace, in texels: a quarter of what a
/// stored byte resolves. fdsm measures quadratics in closed form, but cubics by 20 Newton steps,
/// which are slower and may miss the nearest point.
const QUAD_TOLERANCE_TEXELS: f64 = 4e-3;
/// How far [`Edge::lines`] may be from their segment, in texels.
const LINE_TOLERANCE_TEXELS: f64 = 0.02;

/// One coloured segment in lattice steps.
#[derive(Clone, Debug)]
pub(crate) struct Edge {
    /// A line or a quadratic with its colour.
    pub(crate) segment: ColoredSegment,
}

impl Edge {
    /// The segment in kurbo's terms.
    pub(crate) fn curve(&self) -> PathSeg {
        let s = &self.segment.segment;
        let p = |i| to_kurbo(s.control_point(i));
        match s.order() {
            Order::Linear => Line::new(p(0), p(1)).into(),
            Order::Quadratic => QuadBez::new(p(0), p(1), p(2)).into(),
            Order::Cubic => CubicBez::new(p(0), p(1), p(2), p(3)).into(),
        }
    }

    /// Straight lines along the edge.
    pub(crate) fn lines(&self) -> Vec<Line> {
        let mut points = vec![to_kurbo(self.segment.segment.start())];
        flatten_segment(self.curve(), LINE_TOLERANCE_TEXELS, &mut points);
        let ends = points.windows(2);
        ends.map(|ends| Line::new(ends[0], ends[1])).collect()
    }
}

/// How far edges, as lines, may lie from the outline that they come from, in steps.
pub(crate) const EDGE_ERROR_TEXELS: f64 =
    2.0 * COLLAPSE_TEXELS + QUAD_TOLERANCE_TEXELS + LINE_TOLERANCE_TEXELS;

/// The coloured edges of an outline, in lattice steps. Its contours are reversed where that makes
/// fdsm's distances positive inside.
pub(crate) fn edges_of(outline: &BezPath) -> Vec<Edge> {
    // fdsm's distances are positive to the left of the direction of travel, with y down.
    let turned = if outline.area() > 0.0 {
        outline.reverse_subpaths()
    } else {
        outline.clone()
    };
    let mut edges = Vec::new();
    // The index seeds the colouring, so equal outlines get equal colours in every bake.
    for (index, contour) in (0_u64..).zip(split_contours(&turned)) {
        let segments = collapse(&contour);
        // The rest of a collapsed contour: fewer than two segments enclose next to nothing.
        if segments.len() < 2 {
            continue;
        }
        for segment in color_contour(&segments, index) {
            push_quads(segment, &mut edges);
        }
    }
    edges
}

/// Colours of two channels. Any two of them share one channel.
const TWO_CHANNELS: [Color; 3] = [Color::CYAN, Color::MAGENTA, Color::YELLOW];

/// fdsm's "simple" colouring with a seed that differs by contour: the two contours of a thin ring
/// must get different colours, or their distances mix. For the same reason a contour without
/// corners, which fdsm makes white, gets a colour of two channels here.
fn color_contour(segments: &[PathSeg], index: u64) -> Vec<ColoredSegment> {
    let contour = Contour {
        segments: segments.iter().map(to_fdsm).collect(),
    };
    let colored = ColoredContour::edge_coloring_simple(contour, CORNER_SINE, index);
    let mut segments = colored.segments;
    if segments.iter().all(|segment| segment.color == Color::WHITE) {
        let third = usize::try_from(index % 3).unwrap_or(0);
        for segment in &mut segments {
            segment.color = TWO_CHANNELS[third];
        }
    }
    segments
}

/// The segments of each contour.
fn split_contours(outline: &BezPath) -> Vec<Vec<PathSeg>> {
    let mut contours = Vec::new();
    let mut current = Vec::new();
    for (i, element) in outline.elements().iter().enumerate() {
        if matches!(element, PathEl::MoveTo(_)) && !current.is_empty() {
            contours.push(std::mem::take(&mut current));
        }
        current.extend(outline.get_seg(i));
    }
    if !current.is_empty() {
        contours.push(current);
    }
    contours
}

/// The contour without segments shorter than [`COLLAPSE_TEXELS`]. Their neighbours close the gaps.
fn collapse(contour: &[PathSeg]) -> Vec<PathSeg> {
    let mut kept: Vec<PathSeg> = Vec::with_capacity(contour.len());
    let Some(start) = contour.first().map(ParamCurve::start) else {
        return kept;
    };
    // A dropped segment is bridged by the next one kept, which starts where the last one ended.
    let mut from = start;
    for segment in contour {
        let mut moved = *segment;
        set_start(&mut moved, from);
        if control_length(&moved) >= COLLAPSE_TEXELS {
            kept.push(moved);
            from = moved.end();
        }
    }
    if let Some(last) = kept.last_mut() {
        // The last segment closes the contour.
        set_end(last, start);
    }
    // Moving an end may have left a segment without length.
    kept.retain(|segment| control_length(segment) > 0.0);
    kept.into_iter().map(mend_handles).collect()
}

/// Length of the control polygon.
fn control_length(segment: &PathSeg) -> f64 {
    match segment {
        PathSeg::Line(l) => l.arclen(1.0),
        PathSeg::Quad(q) => (q.p1 - q.p0).hypot() + (q.p2 - q.p1).hypot(),
        PathSeg::Cubic(c) => (c.p1 - c.p0).hypot() + (c.p2 - c.p1).hypot() + (c.p3 - c.p2).hypot(),
    }
}

/// Turns handles shorter than [`COLLAPSE_TEXELS`] towards the next control point. The direction at
/// an end is then the one in which the curve really leaves, not that of a tiny handle.
fn mend_handles(segment: PathSeg) -> PathSeg {
    match segment {
        PathSeg::Line(_) => segment,
        PathSeg::Quad(q) => {
            let short = (q.p1 - q.p0).hypot().min((q.p2 - q.p1).hypot()) < COLLAPSE_TEXELS;
            if short {
                Line::new(q.p0, q.p2).into()
            } else {
                segment
            }
        }
        PathSeg::Cubic(mut c) => {
            let short = [(c.p1 - c.p0).hypot(), (c.p3 - c.p2).hypot()]
                .map(|length| length < COLLAPSE_TEXELS);
            match short {
                [true, true] => return Line::new(c.p0, c.p3).into(),
                [true, false] => c.p1 = towards(c.p0, c.p2),
                [false, true] => c.p2 = towards(c.p3, c.p1),
                [false, false] => {}
            }
            c.into()
        }
    }
}

/// A point a little way from `from` towards `to`.
fn towards(from: Point, to: Point) -> Point {
    let d = to - from;
    let length = d.hypot();
    if length > COLLAPSE_TEXELS {
        from + d * (0.5 * COLLAPSE_TEXELS / length)
    } else {
        from.lerp(to, 0.5)
    }
}

/// Appends the edge; a cubic becomes quadratics of its colour.
fn push_quads(colored: ColoredSegment, edges: &mut Vec<Edge>) {
    let color: Color = colored.color;
    let edge = Edge { segment: colored };
    match edge.curve() {
        PathSeg::Cubic(cubic) => {
            // All pieces keep the colour: there is no corner between them.
            let quads = cubic.to_quads(QUAD_TOLERANCE_TEXELS);
            edges.extend(quads.map(|(_, _, quad)| Edge {
                segment: ColoredSegment {
                    segment: to_fdsm(&quad.into()),
                    color,
                },
            }));
        }
        _ => edges.push(edge),
    }
}

fn to_fdsm(segment: &PathSeg) -> Segment {
    let p = |p: Point| Point2::new(p.x, p.y);
    match segment {
        PathSeg::Line(l) => Segment::line(p(l.p0), p(l.p1)),
        // For a straight quadratic the cubic equation of the nearest point degenerates.
        PathSeg::Quad(q) if is_straight(q) => Segment::line(p(q.p0), p(q.p2)),
        PathSeg::Quad(q) => Segment::quad(p(q.p0), p(q.p1), p(q.p2)),
        PathSeg::Cubic(c) => Segment::cubic(p(c.p0), p(c.p1), p(c.p2), p(c.p3)),
    }
}

fn is_straight(q: &QuadBez) -> bool {
    let bend = (q.p0.to_vec2() - 2.0 * q.p1.to_vec2() + q.p2.to_vec2()).hypot();
    bend < QUAD_TOLERANCE_TEXELS
}

fn to_kurbo(p: Point2<f64>) -> Point {
    Point::new(p.x, p.y)
}

/// The outline as fdsm alone would get it.
#[cfg(test)]
pub(crate) fn contours_for_fdsm(outline: &BezPath) -> Vec<Contour> {
    let contours = split_contours(outline).into_iter();
    contours
        .map(|contour| Contour {
            segments: contour.iter().map(to_fdsm).collect(),
        })
        .collect()
}
