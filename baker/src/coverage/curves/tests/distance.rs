//! Signed distances against the outline as drawn.

use super::*;

/// Distances are exact for lines; a quadratic's nearest point is found by Newton's method.
#[test]
fn distances_agree_with_the_outline() {
    let path = "M5.6,2.2C5.1,1.3 3.9,1 3.2,1.5 2.3,2.1 2.6,3.2 3.7,3.6L4.6,3.9C6.6,4.6 6.7,7 4.6,7.4 \
                3.3,7.6 2.3,7 2,5.9L2.9,5.6C3.2,6.6 4,6.8 4.7,6.5 5.7,6.1 5.5,5 4.3,4.6L3.4,4.3\
                C1.3,3.6 1.4,1.2 3.3,.7 4.8,.3 5.9,.9 6.4,1.9Z";
    let outline = BezPath::from_svg(path).expect("a path of this file");
    let baked = bake(&outline, FillRule::NonZero, params(8, 0.125));
    let units = f64::from(baked.params.lattice.units_per_cell);
    let scaled = kurbo::Affine::scale(units) * outline;
    let reach = baked.params.lattice.margin_units;
    let mut random = Random(3);
    let (mut tested, mut worst) = (0, 0.0_f64);
    while tested < 20_000 {
        let segment = baked.lowered.segments[random.index(baked.lowered.segments.len())];
        let t = random.unit();
        let spread = 10.0_f64.powf(random.unit() * 4.0);
        let offset = kurbo::Vec2::new(random.unit() - 0.5, random.unit() - 0.5) * spread;
        let Some(lookup) = baked.lookup(segment.blossom(t, t) + offset) else {
            continue;
        };
        let Some(record) = baked.records.get(&lookup.cell) else {
            continue;
        };
        tested += 1;
        #[expect(clippy::cast_precision_loss, reason = "16 bits")]
        let found = f64::from(curve::distance(record, lookup.p, reach as f32));
        let truth = edge_distance(&scaled, lookup.at).min(f64::from(reach));
        worst = worst.max((found.abs() - truth).abs());
        let side = curve::inside(record, lookup.p);
        assert_eq!(found > 0.0, side && found.abs() > 0.0, "{lookup:?}");
    }
    assert!(worst <= ERROR_UNITS, "{worst} units");
}

#[test]
fn far_from_edges_the_distance_is_the_reach() {
    let outline = BezPath::from_svg("M2,2H6V6H2Z").expect("a path of this file");
    let baked = bake(&outline, FillRule::NonZero, params(8, 0.125));
    let units = f64::from(baked.params.lattice.units_per_cell);
    for (x, sign) in [(2.5, 1.0), (1.5, -1.0)] {
        let lookup = baked
            .lookup(Point::new(x * units, 2.5 * units))
            .expect("on the grid");
        let record = &baked.records[&lookup.cell];
        assert!((curve::distance(record, lookup.p, 100.0) - 100.0 * sign).abs() < 1e-3);
    }
}
