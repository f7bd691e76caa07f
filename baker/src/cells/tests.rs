//! Lists against exact windings: what a list names must be what shows in the cell.

#![expect(clippy::print_stdout, reason = "names the drawings left out")]

use kurbo::{Point, Rect, Shape as _};
use vtex_format::{CellWord, EntryKind, VtexFile};
use vtex_testing::{Corpus, slow};

use crate::{
    config::{BakeConfig, Mode, Resources},
    coverage::{
        grid::Lattice,
        placed::{Placed, PlacedKind, place},
        verdict::{Coverage, Verdict},
    },
    drawing::{Drawing, FillRule, Item, tree::Tree},
    geometry::line_box_distance,
    pipeline::assemble,
    testing::{Evaluator, Random, drawing_of, paint_at, random_outline, shape, stored_at},
};

fn bake(drawing: Drawing, config: &BakeConfig) -> VtexFile {
    let file = assemble(drawing, None, config, [0; 32], &|_| ()).unwrap();
    assert_eq!(file.check(), []);
    file
}

fn msdf() -> BakeConfig {
    BakeConfig {
        mode: Mode::Msdf,
        ..BakeConfig::default()
    }
}

fn place_msdf(drawing: &Drawing, lattice: &Lattice) -> Vec<Placed> {
    let verdicts = vec![Verdict::forced(Coverage::Msdf); drawing.items.len()];
    place(drawing, lattice, &verdicts)
}

fn random_drawing(seed: u64, count: usize) -> Drawing {
    let mut random = Random(seed);
    let items = (0..count)
        .map(|_| {
            let rule = match random.below(2) {
                0 => FillRule::NonZero,
                _ => FillRule::EvenOdd,
            };
            let mut channel = || random.below(4) as f32 / 3.0;
            let color = [channel(), channel(), channel(), channel().max(0.4)];
            let alpha = if color[3] > 0.5 { 1.0 } else { 0.5 };
            let outline = random_outline(&mut random, 100.0);
            shape(outline, rule, [color[0], color[1], color[2], alpha])
        })
        .collect();
    Drawing::ungrouped([100.0, 80.0], items)
}

/// The outcome of one comparison.
#[derive(Debug, Default)]
struct Tally {
    compared: usize,
    wrong: usize,
    entries: usize,
}

/// Evaluates lists with each listed shape's exact inside test in place of its tile.
fn compare_lists(drawing: &Drawing, file: &VtexFile, config: &BakeConfig, points: u32) -> Tally {
    let lattice = Lattice::new(drawing.canvas_size, config.msdf_size);
    let placed = place_msdf(drawing, &lattice);
    let evaluator = Evaluator { file };
    let mut random = Random(5);
    let mut tally = Tally::default();
    for _ in 0..points {
        let uv = [random.within(0.0, 1.0), random.within(0.0, 1.0)];
        let canvas = lattice.canvas;
        let p = Point::new(
            canvas.x0 + uv[0] * canvas.width(),
            canvas.y0 + uv[1] * canvas.height(),
        );
        // An f32 lookup this near to an edge or a lattice line may fall on the other side.
        let near = Rect::from_center_size(p, (1e-3, 1e-3));
        if near_an_edge(&placed, near) {
            continue;
        }
        let (word, entries, _) = evaluator.entries(uv);
        let mut truth = [0.0; 4];
        for item in placed.iter().rev() {
            if let PlacedKind::Shape { paint, .. } = &item.kind
                && item.region.contains(p)
            {
                crate::testing::under(&mut truth, paint_at(paint, uv));
            }
        }
        let mut listed = [0.0; 4];
        if let CellWord::Paint { paint } = word {
            crate::testing::under(&mut listed, stored_at(file, paint, uv));
        }
        for entry in &entries {
            let covered = entry.kind == EntryKind::Full
                || tile_contains(file, &placed, entry.data, entry.index, p);
            if covered {
                crate::testing::under(&mut listed, stored_at(file, entry.index, uv));
            }
        }
        let wrong = truth.iter().zip(&listed).any(|(a, b)| (a - b).abs() > 1e-5);
        tally.compared += 1;
        tally.entries += entries.len();
        tally.wrong += usize::from(wrong);
    }
    tally
}

fn near_an_edge(placed: &[Placed], area: Rect) -> bool {
    placed.iter().any(|item| {
        item.bounds().overlaps(area)
            && item.outline.segments().any(|segment| {
                segment.bounding_box().overlaps(area) && {
                    let mut points = vec![kurbo::ParamCurve::start(&segment)];
                    crate::geometry::flatten_segment(segment, 1e-5, &mut points);
                    points
                        .windows(2)
                        .any(|e| line_box_distance(kurbo::Line::new(e[0], e[1]), area) == 0.0)
                }
            })
    })
}

/// Whether a shape of the tile's layer with the entry's paint contains `p`.
fn tile_contains(file: &VtexFile, placed: &[Placed], tile: u32, paint: u32, p: Point) -> bool {
    let layer = file
        .layers
        .iter()
        .position(|layer| (layer.tile_first..layer.tile_first + layer.tile_count).contains(&tile))
        .unwrap();
    file.shapes.iter().zip(placed).any(|(record, item)| {
        record.layer_or_image as usize == layer && record.paint == paint && item.region.contains(p)
    })
}

#[test]
fn lists_show_the_exact_picture() {
    for (seed, msdf_size) in (0..).zip([64, 200, 512, 64, 200, 512]) {
        let config = BakeConfig {
            msdf_size,
            ..msdf()
        };
        let file = bake(random_drawing(seed, 60), &config);
        let tally = compare_lists(&random_drawing(seed, 60), &file, &config, 20_000);
        assert_eq!(tally.wrong, 0, "{tally:?}");
        assert!(tally.compared > 18_000 && tally.entries > 1000, "{tally:?}");
    }
}

#[test]
fn tiger_lists_show_the_exact_picture() {
    let Some(corpus) = Corpus::find("lists of the tiger") else {
        return;
    };
    let svg = corpus.read("paper5/5_tiger__svgpan__tiger.svg");
    let config = msdf();
    let file = bake(drawing_of(&svg, &config), &config);
    let points = if slow() { 300_000 } else { 30_000 };
    let tally = compare_lists(&drawing_of(&svg, &config), &file, &config, points);
    assert_eq!(tally.wrong, 0, "{tally:?}");
    assert!(tally.compared > 29_000, "{tally:?}");
}

/// In every texel of every tile the sign of the median is that of the lattice point.
#[test]
fn texels_are_inside_exactly_where_the_winding_says() {
    let config = BakeConfig {
        msdf_size: 128,
        ..msdf()
    };
    let drawing = random_drawing(3, 40);
    let lattice = Lattice::new(drawing.canvas_size, config.msdf_size);
    let placed = place_msdf(&drawing, &lattice);
    let file = bake(random_drawing(3, 40), &config);
    let n = lattice.grid.texels_per_cell as usize;
    let columns = lattice.grid.size_cells[0] as usize;
    let mut texels = 0;
    for (cell, word) in file.cells.iter().enumerate() {
        let CellWord::List { offset_words } = CellWord::decode(*word).unwrap() else {
            continue;
        };
        for pair in file.entries[offset_words as usize..].chunks_exact(2) {
            let entry = vtex_format::Entry::decode([pair[0], pair[1]]).unwrap();
            if entry.kind == EntryKind::Msdf {
                let size = 4 * (n + 1) * (n + 1);
                let tile = &file.tiles[entry.data as usize * size..][..size];
                for (i, rgba) in tile.chunks_exact(4).enumerate() {
                    let x = (cell % columns * n + i % (n + 1)) as f64;
                    let y = (cell / columns * n + i / (n + 1)) as f64;
                    let p = Point::new(x, y);
                    let inside = tile_contains(&file, &placed, entry.data, entry.index, p);
                    let (r, g, b) = (rgba[0], rgba[1], rgba[2]);
                    let median = r.min(g).max(r.max(g).min(b));
                    assert_eq!(median >= 128, inside, "{p} {rgba:?}");
                    assert_eq!(rgba[3], 255);
                    texels += 1;
                }
            }
            if entry.last {
                break;
            }
        }
    }
    assert!(texels > 10_000, "{texels}");
}

/// Cells that share a side store the same texels on it, so that lookups are seamless.
#[test]
fn tiles_side_by_side_share_their_border() {
    let config = BakeConfig {
        msdf_size: 128,
        ..msdf()
    };
    let mut drawing = random_drawing(3, 40);
    drawing.items.truncate(1);
    drawing.tree = Tree::ungrouped(1);
    drawing.items[0] = shape(
        kurbo::Circle::new((50.0, 40.0), 23.0).to_path(1e-4),
        FillRule::NonZero,
        [0.0, 0.0, 0.0, 1.0],
    );
    let file = bake(drawing, &config);
    let n = file.meta.grid.texels_per_cell as usize;
    let columns = file.meta.grid.size_cells[0] as usize;
    let tile_of = |cell: usize| match CellWord::decode(file.cells[cell]).unwrap() {
        CellWord::List { offset_words } => {
            let at = offset_words as usize;
            let tile = file.entries[at + 1] as usize;
            Some(&file.tiles[tile * 4 * (n + 1) * (n + 1)..][..4 * (n + 1) * (n + 1)])
        }
        _ => None,
    };
    let mut shared = 0;
    for cell in 0..file.cells.len() - 1 {
        if (cell + 1) % columns == 0 {
            continue;
        }
        if let (Some(left), Some(right)) = (tile_of(cell), tile_of(cell + 1)) {
            for row in 0..=n {
                let texel = |tile: &[u8], column: usize| {
                    let at = 4 * (row * (n + 1) + column);
                    tile[at..at + 4].to_vec()
                };
                assert_eq!(texel(left, n), texel(right, 0));
                shared += 1;
            }
        }
    }
    assert!(shared > 100, "{shared}");
}

#[test]
fn same_file_at_any_thread_count() {
    let curves = BakeConfig {
        mode: Mode::Curves,
        ..BakeConfig::default()
    };
    for config in [msdf(), curves] {
        let bake_on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let pool = pool.build().unwrap();
            pool.install(|| bake(random_drawing(4, 80), &config))
        };
        let files = [1, 2, 7].map(bake_on);
        assert_eq!(files[0], files[1]);
        assert_eq!(files[0], files[2]);
        assert_eq!(files[0].to_bytes().unwrap(), files[2].to_bytes().unwrap());
    }
}

#[test]
fn merged_shapes_share_a_layer_and_are_warned_about() {
    let config = BakeConfig {
        merge: true,
        ..msdf()
    };
    let file = bake(random_drawing(6, 40), &config);
    assert_eq!(file.layers.len(), 1);
    let warned = |file: &VtexFile| {
        let mut warnings = file.provenance.as_ref().unwrap().warnings.iter();
        warnings.any(|warning| warning.code == vtex_format::WarningCode::MergeOverlap)
    };
    assert!(warned(&file));
    let apart = [(20.0, 0.2), (70.0, 0.7)]
        .map(|(x, red)| {
            let circle = kurbo::Circle::new((x, 40.0), 10.0).to_path(1e-3);
            shape(circle, FillRule::NonZero, [red, 0.0, 0.0, 1.0])
        })
        .into();
    let apart = Drawing::ungrouped([100.0, 80.0], apart);
    assert!(!warned(&bake(apart, &config)));
}

#[test]
fn an_outline_widens_range_and_lists() {
    let circle = kurbo::Circle::new((50.0, 40.0), 20.0).to_path(1e-3);
    let drawing = || {
        Drawing::ungrouped(
            [100.0, 80.0],
            vec![shape(
                circle.clone(),
                FillRule::NonZero,
                [1.0, 0.0, 0.0, 1.0],
            )],
        )
    };
    let config = BakeConfig {
        msdf_size: 128,
        outline_texels: Some(6.0),
        stroke_color: Some([0.0, 0.0, 1.0, 1.0]),
        ..msdf()
    };
    let file = bake(drawing(), &config);
    let outline = file.meta.sampler.outline.unwrap();
    assert!(file.meta.distance_range_texels > 2.0 * outline.width_texels);
    assert_eq!(
        file.paints[outline.paint as usize].color,
        [0.0, 0.0, 1.0, 1.0]
    );
    // A point on the ring, just inside its outer border, lies in a cell that lists the circle.
    let steps_per_unit = 128.0 / 100.0;
    let x = 50.0 + 20.0 + 5.9 / steps_per_unit;
    let evaluator = Evaluator { file: &file };
    let (_, entries, _) = evaluator.entries([x / 100.0, 0.5]);
    assert_eq!(entries.len(), 1);
}

#[test]
fn a_drawing_that_shows_nothing_is_one_empty_grid() {
    let drawing = Drawing::ungrouped([3.0, 1.0], Vec::new());
    let file = bake(drawing, &msdf());
    assert!(file.cells.iter().all(|&word| word == 0) && file.tiles.is_empty());
    assert_eq!(file.provenance.unwrap().warnings.len(), 1);
}

#[test]
fn odd_outlines_do_no_harm() {
    let odd = [
        "M0 0",
        "M0 0Z",
        "M10 10L20 20Z",
        "M10 10C10 10 10 10 10 10Z",
        "M-1e7 -1e7H1e7V1e7H-1e7Z",
        "M10 10C90 10 10 10 90 10Z",
        "M1e-7 0L2e-7 1e-7L0 1e-7Z",
    ];
    let mut items: Vec<Item> = odd
        .iter()
        .map(|text| {
            let outline = kurbo::BezPath::from_svg(text).unwrap();
            shape(outline, FillRule::EvenOdd, [0.5, 0.5, 0.5, 0.5])
        })
        .collect();
    let mut infinite = kurbo::BezPath::new();
    infinite.move_to((0.0, f64::NAN));
    infinite.line_to((f64::INFINITY, 3.0));
    infinite.line_to((1.0, 3.0));
    items.push(shape(infinite, FillRule::NonZero, [0.0, 0.0, 0.0, 1.0]));
    let drawing = Drawing::ungrouped([100.0, 80.0], items);
    let file = bake(drawing, &msdf());
    // Only the huge rectangle shows there.
    let evaluator = Evaluator { file: &file };
    let c = evaluator.point([0.7, 0.7]);
    assert!(
        c.iter()
            .zip([0.25, 0.25, 0.25, 0.5])
            .all(|(a, b)| (a - b).abs() < 1e-6),
        "{c:?}"
    );
}

/// Drawings of the corpus with solid paints: each bakes to a valid file with correct lists.
#[test]
fn corpus_files_are_listed_right() {
    let Some(corpus) = Corpus::find("lists of real drawings") else {
        return;
    };
    let mut names = corpus.svg_files(&["paper5", "icons", "flags", "logos", "signs"]);
    names.retain(|path| path.extension().is_some_and(|ending| ending == "svg"));
    let every = if slow() { 1 } else { 12 };
    let config = BakeConfig {
        msdf_size: 256,
        mip0_size: 64,
        ..msdf()
    };
    for path in names.iter().step_by(every) {
        let svg = std::fs::read(path).unwrap();
        let Ok(mut drawing) = crate::pipeline::draw(&svg, &config, &Resources::default(), &|_| ())
        else {
            println!("not drawn: {}", path.display());
            continue;
        };
        let mut again =
            crate::pipeline::draw(&svg, &config, &Resources::default(), &|_| ()).unwrap();
        for drawing in [&mut drawing, &mut again] {
            drawing.items.retain(|item| matches!(item, Item::Shape(_)));
            drawing.tree = Tree::ungrouped(drawing.items.len());
        }
        let file = bake(drawing, &config);
        let tally = compare_lists(&again, &file, &config, 2_000);
        assert_eq!(tally.wrong, 0, "{} {tally:?}", path.display());
    }
}
