//! Abutting shapes, abutting cells, and random outlines.

use super::*;

/// Two shapes share a curved edge: every lookup between the outer edges is in exactly one of them.
#[test]
fn abutting_shapes_leak_nothing() {
    let left = "M.5,.5H3.1C7.3,2.2 -.9,5.1 5.2,7.4H.5Z";
    let right = "M7.5,.5V7.4H5.2C-.9,5.1 7.3,2.2 3.1,.5Z";
    let [left, right] = [left, right].map(|path| {
        let outline = BezPath::from_svg(path).expect("a path of this file");
        bake(&outline, FillRule::NonZero, params(8, 0.125))
    });
    let units = f64::from(left.params.lattice.units_per_cell);
    let edge: Vec<&Segment> = left
        .lowered
        .segments
        .iter()
        .filter(|s| s.control.is_some())
        .collect();
    let mut random = Random(11);
    for i in 0..300_000 {
        let mut at = Point::new(0.6 + 6.8 * random.unit(), 0.6 + 6.7 * random.unit());
        at = (at.to_vec2() * units).to_point();
        if i % 2 == 0 {
            let t = random.unit();
            let on = edge[random.index(edge.len())].blossom(t, t);
            at = on + kurbo::Vec2::new(random.unit() - 0.5, random.unit() - 0.5) * 4.0;
        }
        let Some(lookup) = left.lookup(at) else {
            continue;
        };
        if lookup.at.y <= 0.5 * units + 1.0 || lookup.at.y >= 7.4 * units - 1.0 {
            continue;
        }
        let hits = u32::from(left.inside(lookup)) + u32::from(right.inside(lookup));
        assert_eq!(hits, 1, "{lookup:?}");
    }
}

/// A point on the border of two cells gets the same answer from both, except where rounding of cuts
/// decides.
#[test]
fn neighbouring_cells_agree_along_their_border() {
    let path = "M4.03,.31C9,4 -1,5 6.7,7.6L1.2,3.3 7.4,4.9 .4,6.8Z";
    let outline = BezPath::from_svg(path).expect("a path of this file");
    let baked = bake(&outline, FillRule::NonZero, params(8, 0.125));
    let lattice = baked.params.lattice;
    let units = f64::from(lattice.units_per_cell);
    let scaled = kurbo::Affine::scale(units) * outline;
    #[expect(clippy::cast_precision_loss, reason = "16 bits")]
    let (margin, far) = (
        lattice.margin_units as f32,
        (lattice.margin_units + lattice.units_per_cell) as f32,
    );
    let mut random = Random(5);
    let mut disagreed = 0;
    for _ in 0..100_000 {
        let border = 1 + random.index(7);
        let border_units = f64::from(u32::try_from(border).expect("small")) * units;
        let along = random.unit() * 8.0 * units;
        let upright = random.unit() < 0.5;
        let at = if upright {
            Point::new(border_units, along)
        } else {
            Point::new(along, border_units)
        };
        let after = baked.lookup(at).expect("on the grid");
        let mut before = after;
        before.cell -= if upright {
            1
        } else {
            baked.params.size_cells[0]
        };
        before.p[usize::from(!upright)] = far;
        assert!(
            (after.p[usize::from(!upright)] - margin).abs() < 1e-3,
            "{after:?}"
        );
        if baked.winding(before) != baked.winding(after) {
            disagreed += 1;
            let distance = edge_distance(&scaled, after.at);
            assert!(distance <= ERROR_UNITS, "{after:?}: {distance}");
        }
    }
    assert!(disagreed < 20, "{disagreed}");
}

/// Coordinates on a coarse lattice, so that edges run along cell borders, through corners and
/// back over each other.
fn any_outline(
    u: &mut arbtest::arbitrary::Unstructured<'_>,
) -> arbtest::arbitrary::Result<BezPath> {
    let mut path = BezPath::new();
    let point = |u: &mut arbtest::arbitrary::Unstructured<'_>| {
        let fine = u.ratio(1, 3)?;
        let mut axis = || -> arbtest::arbitrary::Result<f64> {
            let x = f64::from(u.int_in_range(-8..=24)?) / 4.0;
            let nudge = f64::from(u.int_in_range(-1000..=1000)?) * 1e-5;
            Ok(if fine { x + nudge } else { x })
        };
        Ok(Point::new(axis()?, axis()?))
    };
    for _ in 0..u.int_in_range(1..=3)? {
        path.move_to(point(u)?);
        for _ in 0..u.int_in_range(1..=6)? {
            match u.int_in_range(0..=2)? {
                0 => path.line_to(point(u)?),
                1 => path.quad_to(point(u)?, point(u)?),
                _ => path.curve_to(point(u)?, point(u)?, point(u)?),
            }
        }
        if u.arbitrary()? {
            path.close_path();
        }
    }
    Ok(path)
}

#[test]
fn any_outline_agrees_with_brute_force() {
    arbtest::arbtest(|u| {
        let outline = any_outline(u)?;
        let margin = if u.arbitrary()? { 0.125 } else { 0.0 };
        let baked = bake(&outline, FillRule::NonZero, params(4, margin));
        let found = compare(&outline, &baked, 300, 1);
        assert_eq!(found.far, 0, "{}: {found:?}", outline.to_svg());
        Ok(())
    })
    .budget_ms(3000);
}

/// Found by the property test: lookups at heights where lines end.
#[test]
fn heights_where_lines_end() {
    let path = "M-0.75,4 Q5.75,4 -0.74632,3.25179 L5.5,2.75 Q4.75,-0.75 5.75,5.75 Q1.5,-0.25 5.5,1.75 \
                L4.50537,0.99541 L4.9914,5.75416 Z M-1.75,1.25 C2.50824,1.7563 5.00741,-1.49455 1.25,1 \
                L3.50649,-1.25114 Z M5.75,4.75 L3.25,-1 L5.00506,5.75664 \
                C2.75,2 3.9906,5.00293 3.49905,4.75108 L3.75,4.5 Z";
    let outline = BezPath::from_svg(path).expect("a path of this file");
    for margin in [0.0, 0.125] {
        let baked = bake(&outline, FillRule::NonZero, params(4, margin));
        let found = compare(&outline, &baked, 20_000, 1);
        assert_eq!(found.far, 0, "{found:?}");
    }
}
