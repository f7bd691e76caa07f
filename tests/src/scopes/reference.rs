//! What trees are to show: docs/format.md section 3 over the tree itself, in `f64`.

use vtex_baker::oracle::blend;
use vtex_format::MaskKind;
use vtex_shaders::record;
use vtex_testing::srgb;

use super::tree::{Clip, Group, Node, Scope};
use super::{Drawing, TEXELS_PER_CELL, lattice};

type Rgba = [f64; 4];

/// A lookup in one cell.
#[derive(Clone, Copy, Debug)]
pub struct Lens<'a> {
    drawing: &'a Drawing,
    /// In units of the cell's box.
    p: [f32; 2],
    /// Of the footprint in cells, 0 in point mode.
    width_cells: f32,
}

impl<'a> Lens<'a> {
    /// A lookup at `q` inside a cell, with a footprint of `width_cells`, 0 for a point.
    #[expect(clippy::cast_precision_loss, reason = "16 bits")]
    pub fn new(drawing: &'a Drawing, q: [f32; 2], width_cells: f32) -> Self {
        let lattice = lattice();
        let [units, margin] = [lattice.units_per_cell, lattice.margin_units].map(|n| n as f32);
        Self {
            drawing,
            p: q.map(|q| q * units + margin),
            width_cells,
        }
    }

    /// Linear light, premultiplied.
    pub fn color(&self, nodes: &[Node]) -> Rgba {
        self.over(nodes, [0.0; 4])
    }

    /// What `nodes` make of what lies behind them, linear light.
    fn over(&self, nodes: &[Node], behind: Rgba) -> Rgba {
        nodes.iter().fold(behind, |behind, node| match node {
            Node::Shape { outline, paint } => {
                let covered = outline.map_or(1.0, |outline| self.coverage(outline));
                let [r, g, b, a] = self.drawing.paints[*paint].map(f64::from);
                let paint = [r * a, g * a, b * a, a];
                let shown = decode(source_over(paint, encode(behind)));
                mix(behind, shown, covered)
            }
            Node::Scope(scope) => self.scope(scope, behind),
        })
    }

    fn scope(&self, scope: &Scope, behind: Rgba) -> Rgba {
        let shown = match &scope.group {
            Some(group) => self.group(group, &scope.body, behind),
            None => self.over(&scope.body, behind),
        };
        let inside = scope.clip.as_ref().map_or(1.0, |clip| self.inside(clip));
        mix(behind, shown, inside)
    }

    /// How much of the footprint a clip lets through, edges being independent.
    fn inside(&self, clip: &Clip) -> f64 {
        let also = clip.also.as_ref().map_or(1.0, |also| self.inside(also));
        let outside: f64 = clip
            .parts
            .iter()
            .map(|part| {
                let own = part.clip.as_ref().map_or(1.0, |own| self.inside(own));
                1.0 - own * self.coverage(part.outline)
            })
            .product();
        also * (1.0 - outside)
    }

    fn group(&self, group: &Group, body: &[Node], behind: Rgba) -> Rgba {
        let masks = group.masks.iter().map(|mask| {
            let content = self.color(&mask.body);
            match mask.kind {
                MaskKind::Luminance => luminance(encode(content)),
                MaskKind::Alpha => content[3],
                MaskKind::LinearLuminance => luminance(content),
            }
        });
        let weight = f64::from(group.opacity) * masks.product::<f64>();
        if group.isolated {
            let source = encode(self.color(body)).map(|c| weight * c);
            return decode(blend(group.mode, encode(behind), source));
        }
        decode(mix(encode(behind), encode(self.over(body, behind)), weight))
    }

    fn coverage(&self, outline: usize) -> f64 {
        let record = &self.drawing.records[outline];
        if self.width_cells <= 0.0 {
            return f64::from(u8::from(record::inside(record, self.p)));
        }
        let lattice = lattice();
        let [units, reach] = [lattice.units_per_cell, lattice.margin_units].map(f64::from);
        #[expect(clippy::cast_possible_truncation, reason = "an integer of 16 bits")]
        let distance = f64::from(record::distance(record, self.p, reach as f32));
        if distance.abs() >= reach * 0.999_999 {
            return f64::from(u8::from(distance > 0.0));
        }
        let texels = f64::from(TEXELS_PER_CELL);
        let width = f64::from(self.width_cells) * texels;
        (distance / units * texels / width + 0.5).clamp(0.0, 1.0)
    }
}

fn mix(a: Rgba, b: Rgba, t: f64) -> Rgba {
    std::array::from_fn(|i| (1.0 - t) * a[i] + t * b[i])
}

fn source_over(front: Rgba, back: Rgba) -> Rgba {
    std::array::from_fn(|i| front[i] + (1.0 - front[3]) * back[i])
}

fn luminance([r, g, b, _]: Rgba) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

fn straight(f: fn(f64) -> f64, [r, g, b, a]: Rgba) -> Rgba {
    if a <= 0.0 {
        return [0.0; 4];
    }
    let [r, g, b] = [r, g, b].map(|c| f(c / a) * a);
    [r, g, b, a]
}

fn decode(encoded: Rgba) -> Rgba {
    straight(srgb::decode, encoded)
}

fn encode(linear_light: Rgba) -> Rgba {
    straight(srgb::encode, linear_light)
}
