//! Gradients of baked files against resvg, one feature in each case.

use std::sync::Arc;

use tiny_skia::{Pixmap, Transform};
use vtex_format::{Features, Gradient, GradientShape, Spread, VtexFile};
use vtex_shaders::{PackOptions, cpu, pack};

use crate::{
    BakeConfig, Mode, Resources, bake,
    drawing::{Drawing, Item, Paint},
    number::to_f32,
    testing::{drawing_of, shape, solid},
};

const SIDE: u16 = 200;
/// resvg has 8 bits of the stops' alpha and of its result, and tiny-skia steps along rows.
const SAME_CODES: i32 = 3;

fn svg_of(body: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' \
         viewBox='0 0 200 200' width='200' height='200'>{body}</svg>"
    )
}

fn baked(svg: &str) -> VtexFile {
    let config = BakeConfig {
        mode: Mode::Curves,
        mip0_size: 32,
        ..BakeConfig::default()
    };
    bake(svg.as_bytes(), &config, &Resources::default()).unwrap()
}

fn resvg_picture(svg: &str) -> Pixmap {
    let tree = usvg::Tree::from_str(svg, &usvg::Options::default()).unwrap();
    let mut pixmap = Pixmap::new(SIDE.into(), SIDE.into()).unwrap();
    resvg::render(&tree, Transform::identity(), &mut pixmap.as_mut());
    pixmap
}

/// The share of pixels at whose centre a lookup differs from resvg's picture. resvg must paint it
/// without anti-aliasing.
fn wrong_share(svg: &str) -> f64 {
    let file = baked(svg);
    assert_ne!(file.spec.features & Features::GRADIENTS, 0, "{svg}");
    assert_eq!(file.images.len(), 1, "no patches: {svg}");
    let packed = pack(&file, &PackOptions::default());
    let sampler = cpu::Sampler::new(&packed);
    let theirs = resvg_picture(svg);
    let mut wrong = 0;
    for y in 0..SIDE {
        for x in 0..SIDE {
            let uv = [x, y].map(|i| (f32::from(i) + 0.5) / f32::from(SIDE));
            let seen = sampler.sample(uv, [0.0; 4]);
            let seen = cpu::color::encode_premultiplied(seen);
            let pixel = theirs.pixel(x.into(), y.into()).unwrap();
            let pixel = [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()];
            let differs = seen.iter().zip(pixel).any(|(&ours, theirs)| {
                (f64::from(ours) * 255.0 - f64::from(theirs)).abs() > f64::from(SAME_CODES)
            });
            wrong += u32::from(differs);
        }
    }
    f64::from(wrong) / f64::from(SIDE).powi(2)
}

const STOPS: &str = "<stop stop-color='#f40'/><stop offset='.4' stop-color='#0a8' \
     stop-opacity='.5'/><stop offset='1' stop-color='#206'/>";

/// Attributes that each case adds to a gradient with [`STOPS`], and a body that uses it as `#g`.
#[track_caller]
fn check(tag: &str, attributes: &str, body: &str, most_wrong: f64) {
    check_stops(tag, attributes, STOPS, body, most_wrong);
}

#[track_caller]
fn check_stops(tag: &str, attributes: &str, stops: &str, body: &str, most_wrong: f64) {
    let svg = svg_of(&format!(
        "<g shape-rendering='crispEdges'><{tag} id='g' {attributes}>{stops}</{tag}>{body}</g>"
    ));
    let wrong = wrong_share(&svg);
    assert!(wrong <= most_wrong, "{wrong} wrong: {svg}");
}

const ALL: &str = "<rect width='200' height='200' fill='url(#g)'/>";

#[test]
fn lines() {
    check("linearGradient", "", ALL, 0.0);
    check(
        "linearGradient",
        "x1='.2' y1='.1' x2='.7' y2='.5'",
        ALL,
        0.0,
    );
    check(
        "linearGradient",
        "x2='.25' y2='.1' spreadMethod='reflect'",
        ALL,
        0.001,
    );
    // A jump from the last colour to the first every 17 pixels.
    check(
        "linearGradient",
        "x2='.08' y2='.03' spreadMethod='repeat'",
        ALL,
        0.01,
    );
    check(
        "linearGradient",
        "gradientUnits='userSpaceOnUse' x1='20' x2='150' y2='60'",
        ALL,
        0.0,
    );
    check(
        "linearGradient",
        "gradientTransform='rotate(30 .5 .5) skewX(20) scale(.5 2)'",
        ALL,
        0.0,
    );
}

#[test]
fn circles() {
    check("radialGradient", "", ALL, 0.0);
    check(
        "radialGradient",
        "r='.1' spreadMethod='reflect'",
        ALL,
        0.001,
    );
    check(
        "radialGradient",
        "cx='.3' cy='.6' r='.2' spreadMethod='repeat'",
        ALL,
        0.02,
    );
    check("radialGradient", "fx='.3' fy='.4'", ALL, 0.0);
    check("radialGradient", "fx='.3' fy='.4' fr='.1'", ALL, 0.001);
    check("radialGradient", "fr='.2'", ALL, 0.001);
    check(
        "radialGradient",
        "gradientUnits='userSpaceOnUse' cx='100' cy='90' r='80' fx='60' fy='70' \
         gradientTransform='matrix(.9 .2 -.3 .7 20 10)'",
        ALL,
        0.0,
    );
    // A cone: nothing beside it.
    check(
        "radialGradient",
        "cx='.6' r='.2' fx='.2' fr='.1'",
        ALL,
        0.005,
    );
    check(
        "radialGradient",
        "cx='.6' r='.2' fx='.2' fr='.2'",
        ALL,
        0.005,
    );
}

#[test]
fn places() {
    let circle = "<circle cx='100' cy='90' r='70' fill='url(#g)'/>";
    check("linearGradient", "y2='1'", circle, 0.005);
    let turned = "<g transform='rotate(25 100 100) scale(1.2 .8)'>\
                  <rect x='40' y='50' width='90' height='80' fill='url(#g)' opacity='.5'/></g>";
    check("linearGradient", "y2='1'", turned, 0.005);
    check("radialGradient", "fx='.3'", turned, 0.005);
    let stroke = "<path d='M30 40L160 60L90 170z' fill='none' stroke='url(#g)' \
                  stroke-width='25' stroke-opacity='.7'/>";
    check("linearGradient", "", stroke, 0.01);
    check(
        "radialGradient",
        "gradientUnits='userSpaceOnUse' cx='100' cy='100' r='70'",
        stroke,
        0.01,
    );
    // On top of each other, and on a solid background.
    let stack = "<rect width='200' height='150' fill='#9c3'/>\
                 <rect x='20' width='150' height='200' fill='url(#g)' fill-opacity='.8'/>\
                 <rect y='60' width='200' height='80' fill='url(#g)'/>";
    check("linearGradient", "y2='1'", stack, 0.005);
}

#[test]
fn stops() {
    let hard = "<stop offset='.3' stop-color='red'/><stop offset='.3' stop-color='lime'/>\
                <stop offset='.6' stop-color='blue'/><stop offset='.6' stop-color='#fff'/>";
    check_stops("linearGradient", "x2='.97' y2='.3'", hard, ALL, 0.01);
    check_stops("radialGradient", "", hard, ALL, 0.02);
    // Offsets that descend, and beyond the ends.
    let odd = "<stop offset='-1' stop-color='red'/><stop offset='.6' stop-color='lime'/>\
               <stop offset='.2' stop-color='blue'/><stop offset='2' stop-color='#fff'/>";
    check_stops("linearGradient", "", odd, ALL, 0.02);
    let many: String = (0..50)
        .map(|i| {
            format!(
                "<stop offset='{}%' stop-color='rgb({},{},90)'/>",
                2 * i,
                i * 37 % 256,
                i * 91 % 256
            )
        })
        .collect();
    check_stops("linearGradient", "y2='.5'", &many, ALL, 0.005);
}

/// The paint of the only shape.
fn paint_of(attributes: &str, tag: &str, stops: &str) -> Option<Paint> {
    let svg = svg_of(&format!("<{tag} id='g' {attributes}>{stops}</{tag}>{ALL}"));
    let drawing = drawing_of(svg.as_bytes(), &BakeConfig::default());
    match drawing.items.as_slice() {
        [Item::Shape(shape)] => Some(shape.paint.clone()),
        [] => None,
        _ => panic!("one shape"),
    }
}

#[test]
fn what_is_no_gradient_is_a_colour_or_nothing() {
    let two = "<stop stop-color='red'/><stop offset='1' stop-color='#00f' stop-opacity='.5'/>";
    let color = |attributes, tag, stops| solid(&paint_of(attributes, tag, stops).unwrap());
    let last = [0.0, 0.0, 1.0, 0.5];
    assert_eq!(color("x1='.5' x2='.5'", "linearGradient", two), last);
    assert_eq!(color("r='0'", "radialGradient", two), last);
    let one = "<stop offset='.5' stop-color='red'/>";
    assert_eq!(color("", "linearGradient", one), [1.0, 0.0, 0.0, 1.0]);
    let same = "<stop stop-color='red'/><stop offset='1' stop-color='red'/>";
    assert_eq!(color("", "linearGradient", same), [1.0, 0.0, 0.0, 1.0]);
    let clear = "<stop stop-opacity='0'/><stop offset='1' stop-color='red' stop-opacity='0'/>";
    assert_eq!(paint_of("", "linearGradient", clear), None);
}

#[test]
fn opaque_is_what_is_so_everywhere() {
    let two = "<stop stop-color='red'/><stop offset='1' stop-color='#00f'/>";
    let opaque = |attributes, tag| paint_of(attributes, tag, two).unwrap().is_opaque();
    assert!(opaque("", "linearGradient"));
    assert!(opaque("fx='.2'", "radialGradient"));
    assert!(!opaque("r='.2' fx='.2'", "radialGradient"));
    assert!(!paint_of("", "linearGradient", STOPS).unwrap().is_opaque());
}

#[test]
fn far_periods_keep_their_digits() {
    let attributes = "gradientUnits='userSpaceOnUse' x1='-1e6' x2='-999999' spreadMethod='repeat'";
    let Some(Paint::Gradient(gradient)) = paint_of(attributes, "linearGradient", STOPS) else {
        panic!("a gradient");
    };
    let GradientShape::Linear { t_from_uv } = gradient.shape else {
        panic!("a line");
    };
    assert_eq!(gradient.spread, Spread::Repeat);
    assert!(t_from_uv.iter().all(|n| n.abs() <= 200.0), "{t_from_uv:?}");
}

#[test]
fn equal_gradients_are_one_paint_and_merge_with_nothing() {
    let two = "<stop stop-color='red'/><stop offset='1' stop-color='#00f' stop-opacity='.5'/>";
    let body = format!(
        "<linearGradient id='g' gradientUnits='userSpaceOnUse' x2='200'>{two}</linearGradient>\
         {ALL}{ALL}<rect width='200' height='200' fill='#080' fill-opacity='.5'/>"
    );
    let file = baked(&svg_of(&body));
    assert_eq!(
        file.paints
            .iter()
            .filter(|paint| paint.is_gradient())
            .count(),
        1
    );
    assert!(file.entries.len() >= 6, "three entries in a list");
}

#[test]
fn a_mask_takes_the_alpha_of_gradients() {
    let two = "<stop stop-color='red'/><stop offset='1' stop-color='#00f' stop-opacity='0'/>";
    let body = format!("<linearGradient id='g'>{two}</linearGradient>{ALL}");
    let config = BakeConfig {
        mask: true,
        ..BakeConfig::default()
    };
    let file = bake(svg_of(&body).as_bytes(), &config, &Resources::default()).unwrap();
    let packed = pack(&file, &PackOptions::default());
    for u in [0.1, 0.35, 0.8] {
        let seen = cpu::Sampler::new(&packed).sample([u, 0.5], [0.0; 4]);
        assert!(
            seen.iter().all(|alpha| (alpha - (1.0 - u)).abs() < 1e-5),
            "{u}: {seen:?}"
        );
    }
}

/// The oracle's gradients against the twin, on shapes made by hand.
#[test]
fn oracle_and_twin_agree() {
    let stops = match paint_of("", "linearGradient", STOPS) {
        Some(Paint::Gradient(gradient)) => gradient.stops.clone(),
        other => panic!("{other:?}"),
    };
    for (distance, focal_radius) in [(0.0, 0.0), (0.5, 0.25), (1.5, 0.5), (0.5, 2.0), (1.0, 1.0)] {
        let gradient = Gradient {
            shape: GradientShape::Radial {
                circle_from_uv: [3.0, 1.0, -0.5, 4.0, -1.2, -2.1],
                distance,
                focal_radius,
            },
            spread: Spread::Reflect,
            stops: stops.clone(),
        };
        let square = kurbo::Shape::to_path(&kurbo::Rect::new(-1.0, -1.0, 11.0, 11.0), 0.1);
        let mut item = shape(square, crate::drawing::FillRule::NonZero, [0.0; 4]);
        if let Item::Shape(shape) = &mut item {
            shape.paint = Paint::Gradient(Arc::new(gradient.clone()));
        }
        let drawing = Drawing::ungrouped([10.0, 10.0], vec![item]);
        let config = BakeConfig::default();
        let file = crate::pipeline::assemble(drawing, None, &config, [0; 32], &|_| ()).unwrap();
        let packed = pack(&file, &PackOptions::default());
        for i in 0..900_u16 {
            let uv = [i % 30, i / 30].map(|i| (f64::from(i) + 0.37) / 30.0);
            let seen = cpu::Sampler::new(&packed).sample(uv.map(to_f32), [0.0; 4]);
            let [r, g, b, a] = crate::oracle::gradient::color_at(&gradient, uv).map(to_f32);
            let [r, g, b] = cpu::color::decode([r, g, b]).map(|c| c * a);
            let near = seen
                .iter()
                .zip([r, g, b, a])
                .all(|(x, y)| (x - y).abs() < 1e-3);
            assert!(
                near,
                "{distance} {focal_radius} {uv:?}: {seen:?} {:?}",
                [r, g, b, a]
            );
        }
    }
}
