//! Compositing the items at one point, group by group.

use vtex_format::MaskKind;
use vtex_shaders::srgb::decode;

use super::blend::blend;
use crate::drawing::tree::{Clip, Group, Mask, Node};

/// The items that contain a point.
#[derive(Debug)]
pub(super) struct Covering<'a, P> {
    /// Ascending.
    pub(super) items: &'a [u32],
    /// Colour of an item there: straight alpha, sRGB-encoded.
    pub(super) color: P,
}

impl<P: Fn(u32) -> [f64; 4]> Covering<'_, P> {
    /// The nodes painted over `ground`: sRGB-encoded, premultiplied.
    pub(super) fn paint(&self, nodes: &[Node], ground: [f64; 4]) -> [f64; 4] {
        let mut out = ground;
        let mut rest = self.items;
        while let Some((&item, others)) = rest.split_first() {
            let behind = nodes.partition_point(|node| node.items()[0] <= item);
            let node = nodes[..behind].last();
            rest = others;
            match node.filter(|node| item < node.items()[1]) {
                Some(Node::Item(_)) => out = over((self.color)(item), out),
                Some(Node::Group(group)) => {
                    out = self.group(group, out);
                    let inside = rest.partition_point(|&other| other < group.items[1]);
                    rest = &rest[inside..];
                }
                None => {}
            }
        }
        out
    }

    fn group(&self, group: &Group, ground: [f64; 4]) -> [f64; 4] {
        if !self.inside(&group.clips) {
            return ground;
        }
        let masks = group.masks.iter().map(|mask| self.weight(mask));
        let weight = f64::from(group.opacity) * masks.product::<f64>();
        if group.isolated {
            let picture = self.paint(&group.children, [0.0; 4]);
            return blend(group.blend, ground, picture.map(|c| weight * c));
        }
        let picture = self.paint(&group.children, ground);
        std::array::from_fn(|i| (1.0 - weight) * ground[i] + weight * picture[i])
    }

    fn inside(&self, clips: &[Clip]) -> bool {
        clips.iter().all(|clip| {
            let mut parts = clip.parts.iter();
            parts.any(|part| {
                self.items.binary_search(&part.item).is_ok() && self.inside(&part.clips)
            })
        })
    }

    fn weight(&self, mask: &Mask) -> f64 {
        let picture = self.paint(&mask.children, [0.0; 4]);
        let light = |[r, g, b]: [f64; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
        let [r, g, b, alpha] = picture;
        match mask.kind {
            MaskKind::Alpha => alpha,
            MaskKind::Luminance => light([r, g, b]),
            MaskKind::LinearLuminance => {
                if alpha <= 0.0 {
                    return 0.0;
                }
                #[expect(clippy::cast_possible_truncation, reason = "the transfer is f32")]
                let straight = [r, g, b].map(|c| (c / alpha) as f32);
                light(straight.map(|c| f64::from(decode(c)))) * alpha
            }
        }
    }
}

/// A straight-alpha colour over a premultiplied one.
fn over([r, g, b, a]: [f64; 4], behind: [f64; 4]) -> [f64; 4] {
    let front = [r, g, b, 1.0].map(|c| c * a);
    std::array::from_fn(|i| front[i] + (1.0 - a) * behind[i])
}
