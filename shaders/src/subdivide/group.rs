//! A group of a list in a part of a cell.

use vtex_format::BlendMode;

use super::list::{Node, within};
use super::outline::Region;

/// Blocks composited as one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Group {
    pub(super) masks: Vec<Mask>,
    pub(super) isolated: bool,
    pub(super) body: Vec<Node>,
    /// Number of a [`BlendMode`].
    pub(super) mode: u32,
    /// f32 bits, in \[0, 1\].
    pub(super) opacity: u32,
}

/// What a group's weight is multiplied with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Mask {
    /// Number of a [`vtex_format::MaskKind`].
    pub(super) kind: u32,
    pub(super) body: Vec<Node>,
}

impl Group {
    /// What its masks and it itself hold.
    pub(super) fn bodies(&self) -> impl Iterator<Item = &Vec<Node>> {
        let masks = self.masks.iter().map(|mask| &mask.body);
        masks.chain([&self.body])
    }

    /// What shows in a region: nothing where its body or a mask is empty.
    pub(super) fn within(&self, region: &Region) -> Vec<Node> {
        if self.opacity == 0 {
            return Vec::new();
        }
        let body = within(&self.body, region);
        if body.is_empty() || self.is_plain() {
            return body;
        }
        let masks = self.masks.iter().map(|mask| Mask {
            kind: mask.kind,
            body: within(&mask.body, region),
        });
        let masks: Vec<Mask> = masks.collect();
        if masks.iter().any(|mask| mask.body.is_empty()) {
            return Vec::new();
        }
        vec![Node::Group(Self {
            masks,
            body,
            ..*self
        })]
    }

    /// Whether its blocks show as they would without it.
    fn is_plain(&self) -> bool {
        let normal = self.mode == BlendMode::Normal as u32;
        let whole = f32::from_bits(self.opacity) >= 1.0;
        self.masks.is_empty() && !self.isolated && normal && whole
    }
}
