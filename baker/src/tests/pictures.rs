//! Lookups point by point against resvg's picture of the same SVG.

use tiny_skia::{Pixmap, Transform};
use vtex_format::WarningCode;

use crate::{
    BakeConfig, BakeError, Mode, Resources, bake,
    drawing::{Drawing, Item},
    pipeline::{self, draw},
    raster::{canvas, mips::LinearImage, texel},
    svg,
    testing::solid,
    warning::Warnings,
};

const SIZE: u32 = 128;

fn svg_of(body: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' \
         viewBox='0 0 200 200' width='200' height='200'>{body}</svg>"
    )
}

fn drawing_of(svg: &str, config: &BakeConfig) -> Drawing {
    draw(svg.as_bytes(), config, &Resources::default(), &|_| {}).unwrap()
}

fn resvg_picture(tree: &usvg::Tree, size: [u32; 2]) -> Pixmap {
    let mut pixmap = Pixmap::new(size[0], size[1]).unwrap();
    let scale = Transform::from_scale(
        size[0] as f32 / tree.size().width(),
        size[1] as f32 / tree.size().height(),
    );
    resvg::render(tree, scale, &mut pixmap.as_mut());
    pixmap
}

/// Samples along each side of a texel that is compared. With fewer, tiny-skia's hairlines and its 4
/// x 4 coverage samples, not our outlines, decide the difference of thin strokes.
const SAMPLES: u32 = 8;
/// How much a texel on an edge may differ. resvg composites its 8-bit coverage sRGB-encoded,
/// which between dark and light is off by up to a quarter of a sample.
const EDGE_CODES: u8 = 32;
/// Texels along each side of a texel that is compared, for our lookups.
const OWN_SAMPLES: u32 = 3;

/// The average of [`SAMPLES`] x [`SAMPLES`] texels in linear light.
fn reduced(pixmap: &Pixmap) -> Pixmap {
    let size = [pixmap.width(), pixmap.height()];
    let texels = pixmap.data().as_chunks::<4>().0;
    let fine = LinearImage {
        size,
        texels: texels
            .iter()
            .map(|&texel| texel::linear_from_skia(texel))
            .collect(),
    };
    pixmap_of(&fine.reduced(size.map(|side| side / SAMPLES)))
}

fn pixmap_of(image: &LinearImage) -> Pixmap {
    let mut pixmap = Pixmap::new(image.size[0], image.size[1]).unwrap();
    let out = pixmap.data_mut().as_chunks_mut::<4>().0;
    for (out, &texel) in out.iter_mut().zip(&image.texels) {
        *out = texel::skia_from_linear(texel);
    }
    pixmap
}

/// PSNR over premultiplied 8-bit channels in dB, at most 99, and the largest difference.
fn difference(a: &Pixmap, b: &Pixmap) -> (f64, u8) {
    let differences = a.data().iter().zip(b.data()).map(|(&a, &b)| a.abs_diff(b));
    let sum: f64 = differences.clone().map(|d| f64::from(d).powi(2)).sum();
    let mse = sum / a.data().len() as f64;
    let psnr = if mse > 0.0 {
        10.0 * (255.0_f64.powi(2) / mse).log10()
    } else {
        99.0
    };
    (psnr.min(99.0), differences.max().unwrap_or(0))
}

/// Writes both pictures to the folder that `VTEX_DUMP` names, if it is set.
pub(crate) fn dump(name: &str, ours: &Pixmap, theirs: &Pixmap) {
    if let Ok(dir) = std::env::var("VTEX_DUMP") {
        for (suffix, pixmap) in [("ours", ours), ("resvg", theirs)] {
            pixmap
                .save_png(format!("{dir}/{name}.{suffix}.png"))
                .unwrap();
        }
    }
}

fn dump_svg_case(body: &str) {
    let c = compare(svg_of(body).as_bytes(), &Resources::default(), SIZE).unwrap();
    dump("case", &c.ours, &c.theirs);
}

pub(crate) struct Compared {
    pub(crate) psnr: f64,
    pub(crate) max: u8,
    pub(crate) drawing: Drawing,
    pub(crate) ours: Pixmap,
    pub(crate) theirs: Pixmap,
}

pub(crate) fn compare(
    svg: &[u8],
    resources: &Resources,
    longer_side: u32,
) -> Result<Compared, BakeError> {
    let config = BakeConfig::default();
    let drawing = draw(svg, &config, resources, &|_| {})?;
    let same = draw(svg, &config, resources, &|_| {})?;
    let small = canvas::canvas_texels(drawing.canvas_size, longer_side);
    let size = small.map(|n| n * SAMPLES);
    let file = pipeline::assemble(same, None, &config, [0; 32], &|_| {})?;
    let own = small.map(|n| n * OWN_SAMPLES);
    let ours = pixmap_of(&canvas::picture(&file, own).reduced(small));
    let tree = svg::parse(svg, resources, &Warnings::default())?;
    let theirs = reduced(&resvg_picture(&tree, size));
    let (psnr, max) = difference(&ours, &theirs);
    Ok(Compared {
        psnr,
        max,
        drawing,
        ours,
        theirs,
    })
}

#[track_caller]
fn check(svg: &str, min_psnr: f64, max_diff: u8) -> Drawing {
    let c = compare(svg.as_bytes(), &Resources::default(), SIZE).unwrap();
    dump("case", &c.ours, &c.theirs);
    let shows = c.theirs.data().iter().any(|&v| v > 0);
    assert!(shows, "the case shows nothing: {svg}");
    assert!(
        c.psnr >= min_psnr && c.max <= max_diff,
        "{:.1} dB, max {} for {svg}",
        c.psnr,
        c.max
    );
    c.drawing
}

fn shapes_and_patches(drawing: &Drawing) -> (usize, usize) {
    let shapes = drawing
        .items
        .iter()
        .filter(|i| matches!(i, Item::Shape(_)))
        .count();
    (shapes, drawing.items.len() - shapes)
}

#[test]
fn shapes_equal_resvg() {
    let cases = [
        // Basic shapes, both fill rules, open paths, degenerate parts.
        "<rect x='20' y='30' width='120' height='90' rx='15' fill='#a03'/>",
        "<circle cx='100' cy='100' r='70'/><ellipse cx='60' cy='90' rx='40' ry='20' fill='red'/>",
        "<path d='M100 20 L150 180 L20 80 H180 L50 180 Z' fill='blue'/>",
        "<path d='M100 20 L150 180 L20 80 H180 L50 180 Z' fill='blue' fill-rule='evenodd'/>",
        "<path d='M20 20 H150 V150' fill='teal'/><path d='M5 5 z M10 190 h0' fill='red'/>",
        "<polyline points='20,20 180,40 100,180' fill='olive'/>",
        // Transforms, nested and skewed.
        "<g transform='translate(100 20) rotate(30)'><rect width='60' height='80' \
         transform='skewX(20) scale(1.2 .7)' fill='green'/></g>",
        // Opacity, folded in every way.
        "<rect width='120' height='120' fill='red' fill-opacity='.5'/>\
         <rect x='60' y='60' width='120' height='120' fill='blue' opacity='.4'/>",
        "<g opacity='.5'><g opacity='.5' transform='scale(.9)'><rect width='90' height='90'/></g>\
         </g><rect x='50' y='50' width='99' height='99' fill='lime' fill-opacity='.3'/>",
        "<g opacity='.6'><rect x='10' y='10' width='50' height='50' fill='red'/>\
         <circle cx='140' cy='140' r='40' fill='blue'/></g>",
        // Visibility, display, use, symbols, nested svg, switch.
        "<g visibility='hidden'><rect width='200' height='200'/><rect x='50' y='50' width='50' \
         height='50' visibility='visible' fill='red'/></g><circle r='90' display='none'/>",
        "<defs><g id='a'><rect width='30' height='30'/></g></defs><use href='#a' x='20' y='20'/>\
         <use xlink:href='#a' transform='translate(120 120) rotate(45)' fill='red'/>",
        // Partly and wholly outside.
        "<rect x='-50' y='150' width='400' height='400' fill='navy'/><circle cx='-500' r='9'/>",
        // Paint order.
        "<path d='M40 40 H160 V160 Z' fill='gold' stroke='navy' stroke-width='30' \
         paint-order='stroke' stroke-opacity='.5'/>",
        "<path d='M40 40 H160 V160 Z' fill='gold' stroke='navy' stroke-width='30' \
         stroke-opacity='.5'/>",
        "<style>.a{fill:#123456;stroke:red;stroke-width:3}</style><rect class='a' x='9' y='9' \
         width='99' height='50'/>",
    ];
    for body in cases {
        let drawing = check(&svg_of(body), 50.0, EDGE_CODES);
        assert_eq!(shapes_and_patches(&drawing).1, 0, "a patch in {body}");
    }
}

#[test]
fn view_boxes_are_placed_as_resvg_does() {
    let body = "<rect x='10' y='10' width='80' height='30' fill='#b40'/>\
                <circle cx='50' cy='25' r='20' fill='#04b'/></svg>";
    let heads = [
        "width='200' height='100' viewBox='0 0 100 50'",
        "width='200' height='100' viewBox='0 0 100 100'",
        "width='100' height='200' viewBox='5 5 90 40' preserveAspectRatio='xMinYMax'",
        "width='100' height='200' viewBox='5 5 90 40' preserveAspectRatio='xMaxYMid slice'",
        "width='77' height='133' viewBox='-20 -10 130 60' preserveAspectRatio='none'",
        "viewBox='0 0 123.4 56.7'",
        "width='2cm' height='1in' viewBox='0 0 100 50'",
        "width='0.001' height='0.0005' viewBox='0 0 100 50'",
        "width='40000' height='20000' viewBox='0 0 100 50'",
        "width='100' height='50'",
    ];
    for head in heads {
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' {head}>{body}");
        check(&svg, 50.0, EDGE_CODES);
    }
}

#[test]
fn strokes_equal_resvg() {
    let lines = [
        "M40 60 L160 60 L60 150",
        "M40 150 C60 20 140 20 160 150",
        "M50 50 H150 V150 H50 Z",
        "M40 100 Q100 0 160 100 T180 180",
        "M100 100 m-50 0 a50 50 0 1 0 100 0 a50 50 0 1 0 -100 0 z",
        "M50 50 h0 M120 120 z M150 60 l0 0",
    ];
    let is_points = |line: &str| line.contains("h0");
    let dashes = [
        "",
        "stroke-dasharray='25 16'",
        "stroke-dasharray='30 5 8' stroke-dashoffset='-17'",
    ];
    let transforms = [
        "",
        "translate(20 60) rotate(15) scale(1 .4)",
        "matrix(.7 .1 .5 .8 -20 10)",
    ];
    let mut worst = (99.0, String::new());
    for line in lines {
        for cap in ["butt", "round", "square"] {
            for join in ["miter", "round", "bevel"] {
                for dash in dashes {
                    // Where resvg drops dashed points, SVG 2 sec. 13.5.4 wants their caps.
                    if is_points(line) && !dash.is_empty() {
                        continue;
                    }
                    for transform in transforms {
                        let body = format!(
                            "<rect width='9' height='9'/><path d='{line}' fill='none' stroke='#05a' \
                             stroke-width='14' stroke-linecap='{cap}' stroke-linejoin='{join}' \
                             {dash} transform='{transform}'/>"
                        );
                        let svg = svg_of(&body);
                        let c = compare(svg.as_bytes(), &Resources::default(), SIZE).unwrap();
                        if c.psnr < worst.0 {
                            worst = (c.psnr, body);
                        }
                    }
                }
            }
        }
    }
    dump_svg_case(&worst.1);
    assert!(worst.0 >= 42.0, "{:.1} dB for {}", worst.0, worst.1);
}

#[test]
fn dashes_that_are_points_show_their_caps() {
    // A square on a slanted line turns with it; resvg's does not.
    for (cap, line) in [("round", "M20 40 L180 160"), ("square", "M20 40 H180")] {
        let body = format!(
            "<path d='{line}' fill='none' stroke='black' stroke-width='12' \
             stroke-dasharray='0 30' stroke-linecap='{cap}'/>"
        );
        check(&svg_of(&body), 48.0, 64);
    }
}

#[test]
fn a_dash_bomb_becomes_a_pale_line() {
    let body = "<path d='M0 100 H200' stroke='black' stroke-width='20' \
                stroke-dasharray='1e-9 3e-9'/>";
    let drawing = drawing_of(&svg_of(body), &BakeConfig::default());
    let [Item::Shape(shape)] = drawing.items.as_slice() else {
        panic!("one shape")
    };
    let alpha = solid(&shape.paint)[3];
    assert!((alpha - 0.25).abs() < 1e-3, "{alpha}");
    assert_eq!(drawing.warnings[0].code, WarningCode::PathFallback);
}

#[test]
fn only_pixels_become_a_patch_in_its_place() {
    let under = "<rect x='10' y='10' width='150' height='60' fill='#8c4'/>";
    let over = "<circle cx='100' cy='110' r='30' fill='#333'/>";
    let gradient = "<linearGradient id='g'><stop stop-color='red'/><stop offset='1' \
                    stop-color='blue' stop-opacity='.3'/></linearGradient>";
    let cases = [
        (
            "pattern",
            "<pattern id='p' width='25' height='25' patternUnits='userSpaceOnUse'><circle cx='10' \
             cy='10' r='6'/></pattern><rect x='20' y='20' width='150' height='150' \
             fill='url(#p)'/>"
                .to_owned(),
        ),
        (
            "clipPath",
            "<clipPath id='c'><circle cx='100' cy='100' r='60'/></clipPath><g clip-path='url(#c)' \
             transform='translate(10 5) scale(.9)'><rect width='200' height='200' fill='#d80'/>\
             <rect width='100' height='100'/></g>"
                .to_owned(),
        ),
        (
            "mask",
            format!(
                "{gradient}<mask id='m'><rect width='200' height='200' fill='url(#g)'/></mask>\
                 <rect x='20' y='20' width='150' height='150' mask='url(#m)' fill='#06d'/>"
            ),
        ),
        (
            "filter",
            "<filter id='f'><feGaussianBlur stdDeviation='4'/></filter><rect x='40' y='40' \
             width='90' height='90' filter='url(#f)'/>"
                .to_owned(),
        ),
        (
            "opacity",
            "<g opacity='.5'><rect x='20' y='20' width='90' height='90'/><rect x='60' y='60' \
             width='90' height='90' fill='red'/></g>"
                .to_owned(),
        ),
    ];
    for (feature, body) in cases {
        let drawing = check(&svg_of(&format!("{under}{body}{over}")), 36.0, 80);
        let patches: Vec<&str> = drawing
            .items
            .iter()
            .filter_map(|item| match item {
                Item::Image(patch) => Some(patch.feature.as_str()),
                _ => None,
            })
            .collect();
        let expected = if feature == "filter" {
            &["filter"][..]
        } else {
            &[]
        };
        assert_eq!(patches, expected, "{feature}");
        let warned: Vec<&str> = drawing
            .warnings
            .iter()
            .map(|warning| warning.feature.as_str())
            .collect();
        assert_eq!(warned, expected, "{feature}");
    }
}

#[test]
fn blend_modes_see_their_backdrop() {
    let blend = "<circle cx='100' cy='100' r='60' fill='#7af' style='mix-blend-mode:multiply'/>";
    let grounds = [
        "<rect width='200' height='200' fill='#fc6'/>".to_owned(),
        "<rect width='120' height='120' fill='#fc6' opacity='.5'/>".to_owned(),
    ];
    for ground in grounds {
        let drawing = check(&svg_of(&format!("{ground}{blend}")), 40.0, 60);
        assert_eq!(shapes_and_patches(&drawing), (2, 0));
    }
    let isolated = format!(
        "<rect width='150' height='150' fill='#fc6'/><g style='isolation:isolate'>\
         <rect x='90' width='60' height='150' fill='#a4a'/>{blend}</g>"
    );
    let drawing = check(&svg_of(&isolated), 40.0, 60);
    assert_eq!(shapes_and_patches(&drawing), (3, 0));
}

#[test]
fn outside_images_are_not_loaded_and_said_so() {
    let body = "<image href='/etc/hostname' width='50' height='50'/><image width='9' height='9' \
                href='http://example.com/a.png'/><rect width='20' height='20'/>";
    let drawing = check(&svg_of(body), 50.0, 16);
    assert_eq!(shapes_and_patches(&drawing), (1, 0));
    let codes: Vec<_> = drawing.warnings.iter().map(|w| w.code).collect();
    assert_eq!(codes, [WarningCode::ImageNotLoaded; 2]);
}

#[test]
fn text_without_fonts_is_a_warning() {
    let svg =
        svg_of("<text x='20' y='50' font-family='Gill Sans'>Hi</text><rect width='9' height='9'/>");
    let drawing = drawing_of(&svg, &BakeConfig::default());
    assert_eq!(drawing.warnings[0].code, WarningCode::MissingFont);
    assert!(
        drawing.warnings[0].message.contains("Gill Sans"),
        "{:?}",
        drawing.warnings
    );
}

#[test]
fn an_empty_drawing_is_a_warning() {
    let drawing = drawing_of(
        &svg_of("<rect x='900' width='9' height='9'/>"),
        &BakeConfig::default(),
    );
    assert!(drawing.items.is_empty());
    assert_eq!(drawing.warnings[0].code, WarningCode::EmptyDrawing);
}

#[test]
fn replaced_colours_reach_shapes_and_mips() {
    let body = "<linearGradient id='g'><stop stop-color='red'/><stop offset='1'/></linearGradient>\
                <rect width='200' height='200' fill='url(#g)' stroke='blue' stroke-width='20'/>";
    let config = BakeConfig {
        fill_color: Some([0.0, 1.0, 0.0, 1.0]),
        stroke_color: Some([1.0, 1.0, 1.0, 0.5]),
        ..BakeConfig::default()
    };
    let drawing = drawing_of(&svg_of(body), &config);
    let colors: Vec<_> = drawing
        .items
        .iter()
        .map(|item| match item {
            Item::Shape(shape) => solid(&shape.paint),
            Item::Image(patch) => panic!("{} is a patch", patch.feature),
            Item::Clip(_) => panic!("a clip"),
        })
        .collect();
    assert_eq!(colors, [[0.0, 1.0, 0.0, 1.0], [1.0, 1.0, 1.0, 0.5]]);
    let file = bake(svg_of(body).as_bytes(), &config, &Resources::default()).unwrap();
    let image = &file.images[0];
    let [across, down] = image.size.map(|side| side as usize / 2);
    let center = 4 * (down * image.size[0] as usize + across);
    let texels = &image.mips[0];
    assert_eq!(texels[center..center + 4], [0, 255, 0, 255]);
}

#[test]
fn raster_mode_is_one_patch_of_the_canvas() {
    let svg = svg_of("<circle cx='100' cy='100' r='80' fill='red'/><rect width='50' height='50'/>");
    let config = BakeConfig {
        mode: Mode::Raster,
        ..BakeConfig::default()
    };
    let drawing = pipeline::rastered(drawing_of(&svg, &config), &config, &|_| {}).unwrap();
    let [Item::Image(patch)] = drawing.items.as_slice() else {
        panic!("one patch")
    };
    assert_eq!(patch.rect, kurbo::Rect::new(0.0, 0.0, 200.0, 200.0));
    assert_eq!(patch.image.rect_uv, [0.0, 0.0, 1.0, 1.0]);
}

#[test]
fn warnings_name_the_element_that_has_the_filter() {
    let body = "<filter id='f'><feGaussianBlur stdDeviation='4'/></filter><g id='outer'>\
                <rect id='soft' x='40' y='40' width='90' height='90' filter='url(#f)'/></g>";
    let drawing = drawing_of(&svg_of(body), &BakeConfig::default());
    assert_eq!(drawing.warnings[0].element, "soft");
}
