//! Opaque shapes that abut hide what lies behind them: through whole files, twin and GPU, in point
//! and in footprint mode.
//!
//! The ground is green and nothing in front of it is, so that any green in a lookup is a leak.
//! Lookups above half a texel of mip 0 may be answered by mips, which are means of lookups and hide
//! the ground as well.

use std::fmt::Write as _;

use kurbo::{CubicBez, ParamCurve as _, Point, Vec2};
use rayon::prelude::*;
use vtex_baker::{BakeConfig, Resources, bake};
use vtex_format::VtexFile;
use vtex_runtime::{BatchQuery, BatchSampler, FilterMode, LoadOptions, Trust};
use vtex_shaders::{PackOptions, cpu, pack};
use vtex_tests::gpu::shared as gpu;
use vtex_tests::random::Random;
use vtex_truth::picture::{POINTS, Shot, View};

/// Units along the canvas' sides.
const CANVAS: f64 = 100.0;
/// Further out than any point of the canvas is from its middle.
const FAR: f64 = 150.0;
/// Pixels along the sides of the pictures: a sixteenth of a picture of 512.
const SIDE: u32 = 32;
/// Of pictures of 512 pixels.
const ZOOMS: [f64; 5] = [1.0, 2.0, 8.0, 32.0, 256.0];
const SAMPLES: [u32; 4] = [1, 4, 16, 64];
/// Texels along mip 0.
const MIP0: u32 = 512;

/// A drawing that covers its ground.
struct Scene {
    name: String,
    svg: String,
    /// Places on edges that shapes share.
    seams: Vec<Point>,
}

impl Scene {
    fn new(name: impl Into<String>, paths: &[(&str, String)], seams: Vec<Point>) -> Self {
        let mut svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {CANVAS} {CANVAS}'>\
             <path d='M0 0H{CANVAS}V{CANVAS}H0z' fill='#0f0'/>"
        );
        for (color, path) in paths {
            write!(svg, "<path d='{path}' fill='{color}'/>").unwrap();
        }
        svg.push_str("</svg>");
        Self {
            name: name.into(),
            svg,
            seams,
        }
    }

    fn bake(&self) -> VtexFile {
        let config = BakeConfig {
            max_zoom: 256.0,
            mip0_size: MIP0,
            ..BakeConfig::default()
        };
        bake(self.svg.as_bytes(), &config, &Resources::default()).unwrap()
    }

    /// Lookups of pictures about all seams at all zooms and sample counts: those that mips have a
    /// part in, or the others.
    fn queries(&self, in_mips: bool) -> Vec<BatchQuery> {
        let mut queries = Vec::new();
        for zoom in ZOOMS {
            for &seam in &self.seams {
                let view = View::window([seam.x / CANVAS, seam.y / CANVAS], 16.0 * zoom);
                let wanted = |spp: &u32| {
                    let texels = f64::from(MIP0) / (512.0 * zoom * f64::from(*spp).sqrt());
                    (texels > 0.5) == in_mips
                };
                for spp in SAMPLES.into_iter().filter(wanted) {
                    let shot = Shot {
                        view,
                        size_px: [SIDE; 2],
                        spp,
                        region_uv: POINTS,
                    };
                    let pixels = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
                    queries.extend(pixels.flat_map(|(x, y)| shot.queries(x, y)));
                }
            }
        }
        queries
    }

    /// How many lookups see the ground in each filter, on the twin and, where there is one, on the
    /// GPU.
    fn leaks(&self) -> [[usize; 2]; 2] {
        let file = self.bake();
        let queries = self.queries(false);
        FILTERS.map(|filter| Self::leaks_of(&file, &queries, &options(filter)))
    }

    fn leaks_of(file: &VtexFile, queries: &[BatchQuery], options: &LoadOptions) -> [usize; 2] {
        // No number at all is a leak as well. Weights that add up to 1 do so but for rounding.
        let green = |color: &[f32; 4]| !(color[1] <= 0.0 && color[3] > 1.0 - 1e-6);
        let packed = pack(file, &options.pack);
        let sampler = cpu::Sampler::new(&packed);
        let twin = queries.par_iter();
        let twin = twin.filter(|query| green(&sampler.sample(query.uv, query.footprint)));
        let twin = twin.count();
        let on_gpu = gpu().map_or(0, |gpu| {
            let trust = Trust::Regenerate;
            let sampler = BatchSampler::new(&gpu.device, &gpu.queue, file, options, trust);
            let colors = sampler.unwrap().sample(queries).unwrap();
            colors.iter().filter(|color| green(color)).count()
        });
        [twin, on_gpu]
    }
}

const FILTERS: [FilterMode; 2] = [FilterMode::Point, FilterMode::Footprint];

fn options(filter: FilterMode) -> LoadOptions {
    LoadOptions {
        pack: PackOptions {
            filter,
            ..PackOptions::default()
        },
        ..LoadOptions::default()
    }
}

fn assert_tight(scenes: &[Scene]) {
    let leaking: Vec<(&str, [[usize; 2]; 2])> = scenes
        .iter()
        .map(|scene| (scene.name.as_str(), scene.leaks()))
        .filter(|(_, leaks)| leaks.as_flattened().iter().any(|&leak| leak > 0))
        .collect();
    assert!(leaking.is_empty(), "{leaking:?}");
}

fn polygon(points: &[Point]) -> String {
    let mut path = String::new();
    for (index, p) in points.iter().enumerate() {
        let command = if index == 0 { 'M' } else { 'L' };
        write!(path, "{command}{} {}", p.x, p.y).unwrap();
    }
    path + "z"
}

#[test]
fn a_straight_edge_at_any_angle() {
    let scenes: Vec<Scene> = (0..24)
        .map(|k| {
            let angle = f64::from(k) * 7.5_f64.to_radians();
            let middle = Point::new(50.0 + f64::from(k) * 0.37, 50.0 - f64::from(k) * 0.61);
            let along = FAR * Vec2::from_angle(angle);
            let across = 2.0 * Vec2::new(-along.y, along.x);
            let [p, q] = [middle + along, middle - along];
            let left = polygon(&[p, q, q + across, p + across]);
            let right = polygon(&[q, p, p - across, q - across]);
            let seams = vec![middle, middle + 0.2 * along];
            Scene::new(
                format!("angle {k}"),
                &[("#f00", left), ("#00f", right)],
                seams,
            )
        })
        .collect();
    assert_tight(&scenes);
}

#[test]
fn a_curved_edge() {
    let curves = [
        // A bow, an S, a loop's worth of turning, nearly straight, with a cusp, with a handle of no
        // length.
        [(-20.0, 50.0), (30.0, -10.0), (70.0, 110.0), (120.0, 50.0)],
        [(-20.0, 10.0), (160.0, 20.0), (-60.0, 80.0), (120.0, 90.0)],
        [(50.0, -20.0), (130.0, 60.0), (-30.0, 60.0), (50.0, 120.0)],
        [(-20.0, 31.0), (30.0, 41.2), (70.0, 49.7), (120.0, 61.0)],
        [(-20.0, 50.0), (120.0, 80.0), (-20.0, 80.0), (120.0, 50.0)],
        [(-20.0, 37.3), (-20.0, 37.3), (90.0, 12.1), (120.0, 71.7)],
    ];
    let scenes: Vec<Scene> = curves
        .iter()
        .enumerate()
        .map(|(k, &points)| {
            let [a, b, c, d] = points.map(Point::from);
            let upright = (d - a).x.abs() < 1.0;
            let out = if upright {
                Vec2::new(2.0 * FAR, 0.0)
            } else {
                Vec2::new(0.0, 2.0 * FAR)
            };
            let reach = if upright {
                Vec2::new(0.0, FAR)
            } else {
                Vec2::new(FAR, 0.0)
            };
            let curve = |p: Point, q: Point, r: Point| {
                format!("C{} {} {} {} {} {}", p.x, p.y, q.x, q.y, r.x, r.y)
            };
            let around = |from: Point, to: Point, out: Vec2| {
                // From the end of the curve round the outside to its start.
                let away = if (to - from).dot(reach) > 0.0 {
                    reach
                } else {
                    -reach
                };
                let corners = [to + away, to + away + out, from - away + out, from - away];
                corners
                    .iter()
                    .fold(String::new(), |s, p| s + &format!("L{} {}", p.x, p.y))
            };
            let there = format!("M{} {}{}{}z", a.x, a.y, curve(b, c, d), around(a, d, out));
            let back = format!("M{} {}{}{}z", d.x, d.y, curve(c, b, a), around(d, a, -out));
            let bez = CubicBez::new(a, b, c, d);
            let seams = [0.3, 0.45, 0.5, 0.62].map(|t| bez.eval(t)).to_vec();
            Scene::new(
                format!("curve {k}"),
                &[("#f00", there), ("#00f", back)],
                seams,
            )
        })
        .collect();
    assert_tight(&scenes);
}

#[test]
fn a_t_junction() {
    let scenes: Vec<Scene> = [13.7, 38.2, 50.0, 61.803, 90.01]
        .iter()
        .map(|&x| {
            let y = 0.83 * x + 7.0;
            let beside = format!("M-9 -9H{x}V109H-9z");
            let above = format!("M{x} -9V{y}H109V-9z");
            let below = format!("M109 109V{y}H{x}V109z");
            let colors = ["#f00", "#00f", "#f0f"];
            let paths = [beside, above, below];
            let paths: Vec<_> = colors.into_iter().zip(paths).collect();
            Scene::new(format!("junction {x}"), &paths, vec![Point::new(x, y)])
        })
        .collect();
    assert_tight(&scenes);
}

#[test]
fn a_board_of_crooked_fields() {
    let mut random = Random::new(5);
    // Corners shared by four fields each; the outermost lie beyond the canvas.
    let mut corner = |column: u32, row: u32| {
        let jitter = |r: &mut Random| f64::from(r.between(-4.0, 4.0));
        let at = |index: u32| -12.5 + 12.5 * f64::from(index);
        Point::new(
            at(column) + jitter(&mut random),
            at(row) + jitter(&mut random),
        )
    };
    let corners: Vec<Vec<Point>> = (0..11)
        .map(|row| (0..11).map(|column| corner(column, row)).collect())
        .collect();
    let mut paths = Vec::new();
    let mut seams = Vec::new();
    for row in 0..10 {
        for column in 0..10 {
            let field = [
                corners[row][column],
                corners[row][column + 1],
                corners[row + 1][column + 1],
                corners[row + 1][column],
            ];
            let color = ["#f00", "#00f", "#808", "#000"][(row % 2) * 2 + column % 2];
            paths.push((color, polygon(&field)));
            if (row * 10 + column) % 13 == 5 {
                seams.extend([field[0], field[0].midpoint(field[1])]);
            }
        }
    }
    assert_tight(&[Scene::new("board", &paths, seams)]);
}

#[test]
fn mips_hide_the_ground() {
    let halves = [
        ("#f00", "M-9 -9H37L63 109H-9z".to_owned()),
        ("#00f", "M37 -9H109V109H63z".to_owned()),
    ];
    let junction = [
        ("#f00", "M-9 -9H38.2V109H-9z".to_owned()),
        ("#00f", "M38.2 -9V41.3H109V-9z".to_owned()),
        ("#f0f", "M109 109V41.3H38.2V109z".to_owned()),
    ];
    let bow = [
        ("#f00", "M-9 30C30 -10 70 110 109 60V-9H-9z".to_owned()),
        ("#00f", "M109 60C70 110 30 -10 -9 30V109H109z".to_owned()),
    ];
    for paths in [&halves[..], &junction, &bow] {
        let scene = Scene::new("mips", paths, vec![Point::new(50.0, 50.0)]);
        let file = scene.bake();
        for (level, texels) in file.images[0].mips.iter().enumerate() {
            let leak = texels.chunks_exact(4).find(|t| t[1] != 0 || t[3] != 255);
            assert_eq!(leak, None, "level {level} of {paths:?}");
        }
        let queries = scene.queries(true);
        for filter in FILTERS {
            let packed = pack(&file, &options(filter).pack);
            let sampler = cpu::Sampler::new(&packed);
            let seen = queries
                .iter()
                .map(|query| sampler.sample(query.uv, query.footprint)[1]);
            assert!(!queries.is_empty() && seen.fold(0.0, f32::max) <= 0.0);
        }
    }
}

#[test]
fn a_gap_is_seen() {
    // A thousandth of the canvas: these tests can fail.
    let paths = [
        ("#f00", "M-9 -9H50V109H-9z".to_owned()),
        ("#00f", "M50.1 -9H109V109H50.1z".to_owned()),
    ];
    let scene = Scene::new("gap", &paths, vec![Point::new(50.0, 50.0)]);
    for [twin, on_gpu] in scene.leaks() {
        assert!(
            twin > 30 && (gpu().is_none() || on_gpu == twin),
            "{twin} {on_gpu}"
        );
    }
}

/// Footprints of any size have a colour: the shape covers more than the canvas.
#[test]
fn no_footprint_is_too_large() {
    let path = "M-9 -9H109V109H-9z".to_owned();
    let scene = Scene::new("one", &[("#f00", path)], Vec::new());
    let file = scene.bake();
    let mut queries = Vec::new();
    let extents = [0.0, 1e-9, 1e-3, 0.2, 30.0, 1e8, 1e19, 3e38];
    for uv in [[0.37, 0.61], [0.0, 0.5], [1.001, -1e-3]] {
        for x in extents {
            for y in extents {
                let footprints = [[x, 0.0, 0.0, y], [x, y, -y, x]];
                queries.extend(footprints.map(|footprint| BatchQuery {
                    uv,
                    padding: [0.0; 2],
                    footprint,
                }));
            }
        }
    }
    let leaks = FILTERS.map(|filter| Scene::leaks_of(&file, &queries, &options(filter)));
    assert_eq!(leaks, [[0; 2]; 2]);
}

/// A shape that ends with the canvas fills it to its sides, and colours what is beyond in clamp mode. Its
/// coordinates are rounded to the curve lattice, on which the sides of the canvas need not lie.
#[test]
fn shapes_end_with_the_canvas() {
    let canvases = [[100.0, 100.0], [97.3, 61.7], [31.0, 1000.1], [3.0, 7.0]];
    for [width, height] in canvases {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}'>\
             <path d='M0 0H{width}V{height}H0z' fill='#f00'/>\
             <path d='M{x} 0V{height}H{width}V0z' fill='#00f'/></svg>",
            x = 0.41 * width,
        );
        let file = bake(
            svg.as_bytes(),
            &BakeConfig::default(),
            &Resources::default(),
        )
        .unwrap();
        let mut queries = Vec::new();
        for place in [-0.5, -1e-4, 0.0, 1e-7, 0.3, 0.999_999_9, 1.0, 1.000_1, 1.5] {
            for side in [-3.0, 0.0, 1.0, 1.2] {
                for uv in [[place, side], [side, place]] {
                    queries.extend([0.0, 1e-4, 0.01].map(|width| BatchQuery {
                        uv,
                        padding: [0.0; 2],
                        footprint: [width, 0.0, 0.0, width],
                    }));
                }
            }
        }
        let leaks = FILTERS.map(|filter| Scene::leaks_of(&file, &queries, &options(filter)));
        assert_eq!(leaks, [[0; 2]; 2], "{width} x {height}");
    }
}
