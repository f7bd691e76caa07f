//! Expanding patterns: every tile that shows becomes outlines.
//!
//! A painted shape becomes a group that is clipped to the shape and holds all tiles under it. Where
//! the content is plain, all copies of one shape become a single shape of many contours. A pattern
//! that would need too many outlines is left to resvg.

use kurbo::{Affine, BezPath, Rect, Shape as _};
use usvg::{Group, Node, Pattern};

use super::{
    group::{Effects, holds_open_blend},
    walker::{Place, Walker},
};
use crate::{
    drawing::{FillRule, Paint, Shape, tree},
    number::count,
    svg::{
        path::{affine, transformed_bounds},
        plan::PlanItem,
    },
};

/// Most path elements of one expanded pattern. A pattern that needs more becomes a patch.
const MAX_ELEMENTS: f64 = 262_144.0;
/// Most tiles that are walked one by one, where copies cannot share an outline.
const MAX_WALKED_TILES: f64 = 4096.0;
/// Levels of the blend stack that a pattern takes: the clip to the shape, its opacity, the clip to
/// the tile.
const BLEND_LEVELS: u32 = 5;
/// Levels of patterns inside a pattern that are expanded.
const LEVELS: u32 = 1;
/// How far content may extend beyond its tile without being clipped to it, as a share of the tile.
const OVERHANG: f64 = 1e-6;

/// The tiles that may show: a range of columns and of rows, counted from the tile at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tiles {
    canvas_from_pattern: Affine,
    rect: Rect,
    columns: [f64; 2],
    rows: [f64; 2],
}

impl Tiles {
    /// The tiles under `bounds`, which are in canvas space; `None` if there are none.
    fn under(pattern: &Pattern, canvas_from_user: Affine, bounds: Rect) -> Option<Self> {
        let canvas_from_pattern = canvas_from_user * affine(pattern.transform());
        let rect = transformed_bounds(pattern.rect().to_rect(), Affine::IDENTITY);
        let sound =
            canvas_from_pattern.determinant().abs() > 0.0 && canvas_from_pattern.is_finite();
        if !sound || bounds.area() <= 0.0 {
            return None;
        }
        // Back from the canvas to the pattern, where tiles are a plain grid.
        let area = canvas_from_pattern.inverse().transform_rect_bbox(bounds);
        let span = |low: f64, high: f64, origin: f64, size: f64| {
            [
                ((low - origin) / size).floor(),
                ((high - origin) / size).ceil(),
            ]
        };
        Some(Self {
            canvas_from_pattern,
            rect,
            columns: span(area.x0, area.x1, rect.x0, rect.width()),
            rows: span(area.y0, area.y1, rect.y0, rect.height()),
        })
    }

    fn count(&self) -> f64 {
        (self.columns[1] - self.columns[0]) * (self.rows[1] - self.rows[0])
    }

    /// The transform of each tile's content to the canvas.
    fn places(self) -> impl Iterator<Item = Affine> {
        let numbers = |[first, last]: [f64; 2]| {
            std::iter::successors(Some(first), |at| Some(at + 1.0)).take_while(move |&at| at < last)
        };
        numbers(self.rows).flat_map(move |row| {
            numbers(self.columns).map(move |column| {
                let x = self.rect.x0 + column * self.rect.width();
                let y = self.rect.y0 + row * self.rect.height();
                self.canvas_from_pattern * Affine::translate((x, y))
            })
        })
    }

    /// The rectangle of a tile, with its corner at the origin.
    fn tile(&self) -> Rect {
        Rect::new(0.0, 0.0, self.rect.width(), self.rect.height())
    }
}

impl<'a> Walker<'a, '_> {
    /// Whether all patterns that paint the path can be expanded.
    pub(super) fn expands_patterns(&self, path: &usvg::Path, place: Place<'_>) -> bool {
        let fill = path.fill().filter(|_| self.options.fill_color.is_none());
        let stroke = path
            .stroke()
            .filter(|_| self.options.stroke_color.is_none());
        let paints = [fill.map(usvg::Fill::paint), stroke.map(usvg::Stroke::paint)];
        let bounds = transformed_bounds(path.stroke_bounding_box(), place.canvas_from_user);
        let shown = bounds.intersect(self.canvas);
        paints.into_iter().flatten().all(|paint| match paint {
            usvg::Paint::Pattern(pattern) => {
                let tiles = Tiles::under(pattern, place.canvas_from_user, shown);
                let deep = place.deeper(BLEND_LEVELS).is_none();
                !deep
                    && tiles.is_none_or(|tiles| {
                        tiles.count() * weight(pattern.root(), LEVELS) <= MAX_ELEMENTS
                    })
            }
            _ => true,
        })
    }

    /// Adds what the pattern shows inside an outline.
    pub(super) fn pattern(
        &mut self,
        pattern: &'a Pattern,
        outline: BezPath,
        rule: FillRule,
        opacity: f32,
        place: Place<'a>,
    ) {
        let bounds = outline.control_box().intersect(self.canvas);
        let tiles = Tiles::under(pattern, place.canvas_from_user, bounds);
        let (Some(tiles), Some(inner)) = (tiles, place.deeper(BLEND_LEVELS)) else {
            return;
        };
        let first = self.next_item();
        let Some(clips) = self.clip_to(outline, rule) else {
            return;
        };
        let inner = Place {
            opacity: 1.0,
            ..inner
        };
        let effects = Effects {
            clips,
            opacity,
            isolated: holds_open_blend(pattern.root()),
            ..Effects::default()
        };
        self.add_group(first, effects, |walker| walker.tiles(pattern, tiles, inner));
    }

    fn tiles(&mut self, pattern: &'a Pattern, tiles: Tiles, place: Place<'a>) {
        let content = transformed_bounds(
            pattern.root().layer_bounding_box().to_rect(),
            Affine::IDENTITY,
        );
        let tile = tiles.tile();
        let (slack_x, slack_y) = (OVERHANG * tile.width(), OVERHANG * tile.height());
        // Content within its tile needs no clip, which saves a test for every tile.
        let fits = tile.inflate(slack_x, slack_y).union(content) == tile.inflate(slack_x, slack_y);
        if fits && self.shared_tiles(pattern, tiles, place) {
            return;
        }
        if tiles.count() > MAX_WALKED_TILES {
            let message = "a pattern with too many tiles is left out";
            let code = vtex_format::WarningCode::PathFallback;
            return self.warnings.push(code, "pattern", place.element, message);
        }
        for canvas_from_tile in tiles.places() {
            let place = Place {
                canvas_from_user: canvas_from_tile,
                ..place
            };
            if fits {
                self.children(pattern.root(), place);
            } else {
                self.clipped_tile(pattern, tile, place);
            }
        }
    }

    /// Adds a tile that must clip its content.
    fn clipped_tile(&mut self, pattern: &'a Pattern, tile: Rect, place: Place<'a>) {
        let first = self.next_item();
        let outline = place.canvas_from_user * tile.to_path(0.1);
        let Some(clips) = self.clip_to(outline, FillRule::NonZero) else {
            return;
        };
        let effects = Effects {
            clips,
            isolated: holds_open_blend(pattern.root()),
            ..Effects::default()
        };
        self.add_group(first, effects, |walker| {
            walker.children(pattern.root(), place);
        });
    }

    /// Adds all tiles at once: each shape of the content becomes one shape with a copy in every
    /// tile. Tiles do not overlap, so the order between them is free. Works for shapes of solid
    /// colours only; for anything else it adds nothing and returns `false`.
    fn shared_tiles(&mut self, pattern: &'a Pattern, tiles: Tiles, place: Place<'a>) -> bool {
        let Some(place_of_one) = tiles.places().next() else {
            return true;
        };
        let (first, elements) = (self.items.len(), self.element_count);
        // The first tile is walked and copied. Nothing of it may be left out, even if it does not
        // show in this tile.
        let everywhere = Rect::new(-1e9, -1e9, 1e9, 1e9);
        let window = std::mem::replace(&mut self.window, everywhere);
        let nodes = self.collected(|walker| {
            let place = Place {
                canvas_from_user: place_of_one,
                ..place
            };
            walker.children(pattern.root(), place);
        });
        self.window = window;
        let items = self.items.split_off(first);
        self.element_count = elements;
        // Groups would have to be copied with their items.
        let plain = nodes.iter().all(|node| matches!(node, tree::Node::Item(_)))
            && items.iter().all(is_plain);
        if !plain {
            return false;
        }
        // From the place of the tile that was walked to the tile's own space.
        let one_from_canvas = place_of_one.inverse();
        for item in items {
            let PlanItem::Shape(shape) = item else {
                continue;
            };
            let mut outline = BezPath::new();
            for canvas_from_tile in tiles.places() {
                outline.extend(canvas_from_tile * one_from_canvas * &shape.outline);
            }
            self.element_count += outline.elements().len();
            if self.shows(outline.control_box()) {
                self.show(PlanItem::Shape(Shape { outline, ..shape }));
            }
        }
        true
    }
}

fn is_plain(item: &PlanItem<'_>) -> bool {
    matches!(item, PlanItem::Shape(shape) if matches!(shape.paint, Paint::Solid(_)))
}

/// About how many path elements a group becomes, with patterns inside it expanded. Infinite if they
/// nest deeper than `levels`.
fn weight(group: &Group, levels: u32) -> f64 {
    let of = |node: &Node| match node {
        Node::Group(group) => 4.0 + weight(group, levels),
        Node::Path(path) => {
            let verbs = count(path.data().verbs().len());
            // An expanded stroke has about four elements for each of the line.
            let strokes = if path.stroke().is_some() { 4.0 } else { 0.0 };
            let paints = [
                path.fill().map(usvg::Fill::paint),
                path.stroke().map(usvg::Stroke::paint),
            ];
            let bounds = transformed_bounds(path.stroke_bounding_box(), Affine::IDENTITY);
            let tiled = paints.into_iter().flatten().map(|paint| match paint {
                usvg::Paint::Pattern(pattern) => {
                    let tiles = Tiles::under(pattern, Affine::IDENTITY, bounds);
                    let tiles = tiles.map_or(0.0, |tiles| tiles.count());
                    match levels.checked_sub(1) {
                        Some(levels) => tiles * weight(pattern.root(), levels),
                        None => f64::INFINITY,
                    }
                }
                _ => 0.0,
            });
            verbs * (1.0 + strokes) + tiled.sum::<f64>()
        }
        Node::Text(text) => weight(text.flattened(), levels),
        // Every tile would get a patch of its own.
        Node::Image(_) => 4096.0,
    };
    1.0 + group.children().iter().map(of).sum::<f64>()
}
