//! What trees are to show: docs/format.md section 3 over the tree itself, in `f64`.
//!
//! Of points: what a footprint shows is the mean of them.

use vtex_baker::oracle::blend;
use vtex_format::MaskKind;
use vtex_shaders::record;
use vtex_testing::srgb;

use super::tree::{Clip, Compositing, Group, Node};
use super::{Drawing, lattice};

type Rgba = [f64; 4];

/// A place in one cell.
#[derive(Clone, Copy, Debug)]
pub struct Lens<'a> {
    drawing: &'a Drawing,
    /// In units of the cell's box.
    p: [f32; 2],
}

impl<'a> Lens<'a> {
    /// The place `q` inside a cell.
    #[expect(clippy::cast_precision_loss, reason = "16 bits")]
    pub fn new(drawing: &'a Drawing, q: [f32; 2]) -> Self {
        let lattice = lattice();
        let [units, margin] = [lattice.units_per_cell, lattice.margin_units].map(|n| n as f32);
        Self {
            drawing,
            p: q.map(|q| q * units + margin),
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
                if outline.is_some_and(|outline| !self.covered(outline)) {
                    return behind;
                }
                let [r, g, b, a] = self.drawing.paints[*paint].map(f64::from);
                let paint = [r * a, g * a, b * a, a];
                decode(source_over(paint, encode(behind)))
            }
            Node::Group(group) => self.group(group, behind),
        })
    }

    fn group(&self, group: &Group, behind: Rgba) -> Rgba {
        if group.clip.as_ref().is_some_and(|clip| !self.inside(clip)) {
            return behind;
        }
        match &group.compositing {
            Some(how) => self.composite(how, &group.body, behind),
            None => self.over(&group.body, behind),
        }
    }

    /// Whether a clip lets the place through.
    fn inside(&self, clip: &Clip) -> bool {
        let within = |clip: &Option<Box<Clip>>| clip.as_ref().is_none_or(|clip| self.inside(clip));
        let mut parts = clip.parts.iter();
        within(&clip.also) && parts.any(|part| within(&part.clip) && self.covered(part.outline))
    }

    fn composite(&self, how: &Compositing, body: &[Node], behind: Rgba) -> Rgba {
        let masks = how.masks.iter().map(|mask| {
            let content = self.color(&mask.body);
            match mask.kind {
                MaskKind::Luminance => luminance(encode(content)),
                MaskKind::Alpha => content[3],
                MaskKind::LinearLuminance => luminance(content),
            }
        });
        let weight = f64::from(how.opacity) * masks.product::<f64>();
        if how.isolated {
            let source = encode(self.color(body)).map(|c| weight * c);
            return decode(blend(how.mode, encode(behind), source));
        }
        decode(mix(encode(behind), encode(self.over(body, behind)), weight))
    }

    fn covered(&self, outline: usize) -> bool {
        record::inside(&self.drawing.records[outline], self.p)
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
