//! A group of a list in a part of a cell.

use vtex_format::BlendMode;

use super::list::{Arena, Node};
use super::outline::Span;

/// Blocks composited as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Group {
    pub(super) masks: Span,
    pub(super) isolated: bool,
    pub(super) body: Span,
    /// Number of a [`BlendMode`].
    pub(super) mode: u32,
    /// f32 bits, in \[0, 1\].
    pub(super) opacity: u32,
}

/// What a group's weight is multiplied with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Mask {
    /// Number of a [`vtex_format::MaskKind`].
    pub(super) kind: u32,
    pub(super) body: Span,
}

impl Group {
    pub(super) fn masks(self, arena: &Arena) -> &[Mask] {
        &arena.masks[self.masks.range()]
    }

    /// What its masks and it itself hold.
    pub(super) fn bodies(self, arena: &Arena) -> impl Iterator<Item = Span> {
        let masks = self.masks(arena).iter().map(|mask| mask.body);
        masks.chain([self.body])
    }

    /// Makes pending what shows: nothing where its body or a mask is empty.
    pub(super) fn cut(self, arena: &mut Arena, x: [f64; 2]) {
        if self.opacity == 0 {
            return;
        }
        let first = arena.pending.len();
        arena.cut(self.body, x);
        if arena.pending.len() == first || self.is_plain() {
            return;
        }
        let body = arena.keep(first);
        let mut masks = Vec::new();
        for at in self.masks.range() {
            let mask = arena.masks[at];
            arena.cut(mask.body, x);
            if arena.pending.len() == first {
                return;
            }
            masks.push(Mask {
                kind: mask.kind,
                body: arena.keep(first),
            });
        }
        let first = arena.masks.len();
        arena.masks.extend(masks);
        arena.pending.push(Node::Group(Self {
            masks: Span::from(first, &arena.masks),
            body,
            ..self
        }));
    }

    /// Whether its blocks show as they would without it.
    fn is_plain(self) -> bool {
        let normal = self.mode == BlendMode::Normal as u32;
        let whole = f32::from_bits(self.opacity) >= 1.0;
        self.masks.is_empty() && !self.isolated && normal && whole
    }
}
