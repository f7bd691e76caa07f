//! Shapes of every kind, 0 wrong lookups each.

use super::*;

fn svg(path: &str) -> BezPath {
    BezPath::from_svg(path).expect("a path of this file")
}

fn star(points: u32, skip: u32, radius: f64) -> BezPath {
    let mut path = BezPath::new();
    for i in 0..points {
        let angle = f64::from(i * skip) / f64::from(points) * std::f64::consts::TAU + 0.1;
        let p = Point::new(4.03, 3.97) + radius * kurbo::Vec2::from_angle(angle);
        if i == 0 {
            path.move_to(p);
        } else {
            path.line_to(p);
        }
    }
    path.close_path();
    path
}

/// On a grid of 8 x 8 cells.
fn cases() -> Vec<(&'static str, BezPath)> {
    vec![
        ("star 5/2", star(5, 2, 3.7)),
        ("star 17/8", star(17, 8, 3.9)),
        (
            "curved star",
            svg("M1,1 Q4,9 7,1 Q-1,5 7,7 Q4,-1 1,7 Q9,3 1,1Z"),
        ),
        (
            "ring",
            svg(
                "M4,.5A3.5,3.5 0 1 0 4,7.5 3.5,3.5 0 1 0 4,.5ZM4,1.25A2.75,2.75 0 1 1 4,6.75 2.75,2.75 0 1 1 4,1.25Z",
            ),
        ),
        (
            "ring run twice",
            svg("M4,1A3,3 0 1 0 4,7 3,3 0 1 0 4,1ZM4,2A2,2 0 1 0 4,6 2,2 0 1 0 4,2Z"),
        ),
        ("cusps", svg("M1,7C7,1 1,1 7,7C5,6 5,6 4,2C3,6 3,6 1,7Z")),
        ("loop", svg("M1,4C9,-4 -1,-4 7,4C-1,12 9,12 1,4Z")),
        (
            "sliver",
            svg(
                "M.2,.3 L7.8,5.1 .2,.3001Z M.3,7.5 C3,7.4 5,7.6 7.7,7.5 C5,7.6001 3,7.4001 .3,7.5Z",
            ),
        ),
        (
            "hairline",
            svg("M.1,3.3 L7.9,3.3 7.9,3.30001 .1,3.30001Z M2.2,.1 V7.9 H2.20001 V.1Z"),
        ),
        ("lattice square", svg("M2,2H6V6H2Z")),
        ("lattice comb", svg("M1,1H7V7H6V2H5V7H4V2H3V7H2V2H1Z")),
        ("corner diamond", svg("M4,1L7,4 4,7 1,4Z")),
        (
            "touches borders",
            svg("M3,1.5Q4,3 5,1.5L5.5,3Q4,4 5.5,5L3,6Q2,5 2.5,3Z"),
        ),
        ("whole grid", svg("M0,0H8V8H0Z")),
        ("beyond the grid", svg("M-5,-7H30V50H-5ZM2,2V6H6V2Z")),
        (
            "far left",
            svg("M-900,3.3C-500,-40 -300,60 3.7,4.2C-200,90 -700,-80 -900,3.3Z"),
        ),
        ("far away", svg("M1e6,1e6 L-1e6,4.5 L1e6,-1e6Z")),
        ("left of the grid", svg("M-4,1H-1V7H-4Z")),
        (
            "glyph S",
            svg(
                "M5.6,2.2C5.1,1.3 3.9,1 3.2,1.5 2.3,2.1 2.6,3.2 3.7,3.6L4.6,3.9C6.6,4.6 6.7,7 4.6,7.4 3.3,7.6 2.3,7 2,5.9L2.9,5.6C3.2,6.6 4,6.8 4.7,6.5 5.7,6.1 5.5,5 4.3,4.6L3.4,4.3C1.3,3.6 1.4,1.2 3.3,.7 4.8,.3 5.9,.9 6.4,1.9Z",
            ),
        ),
        ("open contours", svg("M1,1L3,7 5,1M4,4C5,8 7,8 7.5,2L6,1")),
        (
            "nearly no handles",
            svg("M1,1C1.00001,1 7,6.99999 7,7C7,7.00001 1,7.00001 1,7C.99999,7 1,1.00001 1,1Z"),
        ),
        (
            "smaller than a unit",
            svg("M3.300001,3.3L3.300004,3.300003 3.300002,3.300006Z"),
        ),
        ("no area", svg("M1,1L7,3 1,1ZM2,5H6Z")),
        ("empty", BezPath::new()),
    ]
}

#[test]
fn lookups_agree_with_brute_force() {
    for (index, (name, outline)) in (0_u64..).zip(cases()) {
        for (rule, margin) in [(FillRule::NonZero, 0.125), (FillRule::EvenOdd, 0.0)] {
            let baked = bake(&outline, rule, params(8, margin));
            let found = compare(&outline, &baked, 150_000, index);
            assert_eq!(found.far, 0, "{name} {margin}: {found:?}");
            assert!(found.near * 4 < found.samples, "{name}: {found:?}");
        }
    }
}

#[test]
fn fill_rules_differ_where_windings_are_even() {
    let outline = star(5, 2, 3.7);
    let [filled, hollow] =
        [FillRule::NonZero, FillRule::EvenOdd].map(|rule| bake(&outline, rule, params(8, 0.125)));
    let middle = filled
        .lookup((Point::new(4.03, 3.97).to_vec2() * f64_units(&filled)).to_point())
        .expect("on the grid");
    assert!(filled.inside(middle), "winding 2 is not zero");
    assert!(!hollow.inside(middle), "winding 2 is even");
}

fn f64_units(baked: &Baked) -> f64 {
    f64::from(baked.params.lattice.units_per_cell)
}
