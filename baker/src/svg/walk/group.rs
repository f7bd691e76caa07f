//! Groups: clips, masks, opacity, blend modes and filters.

use kurbo::Shape as _;
use usvg::{BlendMode, Group, MaskType, Node};
use vtex_format::{self as format, MaskKind};

use super::{
    recolor::Recolor,
    walker::{Place, Walker},
};
use crate::{
    drawing::{
        FillRule,
        tree::{self, Clip, Mask},
    },
    svg::path::affine,
};

/// What is done to a group as a whole; by default nothing.
#[derive(Debug)]
pub(super) struct Effects {
    pub(super) clips: Vec<Clip>,
    pub(super) masks: Vec<Mask>,
    pub(super) opacity: f32,
    pub(super) blend: format::BlendMode,
    pub(super) isolated: bool,
}

impl Default for Effects {
    fn default() -> Self {
        Self {
            clips: Vec::new(),
            masks: Vec::new(),
            opacity: 1.0,
            blend: format::BlendMode::Normal,
            isolated: false,
        }
    }
}

impl<'a> Walker<'a, '_> {
    /// Adds a group and what is in it. A filter that only changes colours is applied to the
    /// colours; any other makes the group a subtree for resvg.
    pub(super) fn group(&mut self, node: &'a Node, group: &'a Group, place: Place<'a>) {
        let mut place = place;
        if !group.filters().is_empty() {
            // A change of colours inside another is left to resvg.
            let recolor = Recolor::of(group).filter(|_| place.recolor.is_none());
            if recolor.is_none() {
                return self.filtered(node, group, place);
            }
            place.recolor = recolor;
        }
        // Inside a folded group every opacity folds; an opacity of 1 always does.
        let folds = place.opacity < 1.0 || group.opacity() == usvg::Opacity::ONE;
        let folds = folds || self.folds(group);
        let own = group.opacity().get();
        let inner = Place {
            canvas_from_user: place.canvas_from_user * affine(group.transform()),
            opacity: place.opacity * if folds { own } else { 1.0 },
            ..place
        };
        let effects = Effects {
            opacity: if folds { 1.0 } else { own },
            blend: blend_mode(group.blend_mode()),
            // A group whose blend mode sees its backdrop is composited as a whole. Isolation
            // matters otherwise only if something inside could see through it.
            isolated: blends(group) || group.should_isolate() && holds_open_blend(group),
            ..Effects::default()
        };
        let grouped = effects.isolated || effects.opacity < 1.0 || group.mask().is_some();
        // The rectangle of a mask is a clip too.
        let clips = group.clip_path().map_or(0, clip_depth) + u32::from(group.mask().is_some());
        let Some(inner) = inner.deeper(clips + u32::from(grouped)) else {
            return self.raster(node, place, "nesting");
        };
        let first = self.next_item();
        let mut effects = effects;
        if self.clips_and_masks(group, inner, &mut effects).is_some() {
            self.add_group(first, effects, |walker| walker.children(group, inner));
        }
    }

    /// A group that resvg has to paint because of its filter. Its blend mode stays the evaluator's.
    fn filtered(&mut self, node: &'a Node, group: &'a Group, place: Place<'a>) {
        if !blends(group) {
            return self.raster(node, place, "filter");
        }
        let effects = Effects {
            blend: blend_mode(group.blend_mode()),
            isolated: true,
            ..Effects::default()
        };
        self.add_group(self.next_item(), effects, |walker| {
            walker.raster(node, place, "filter");
        });
    }

    /// Adds a group of the nodes that `walk` adds. `first` is its first item: items of its effects
    /// have been added before the walk. Without any effect the nodes are added without a group.
    pub(super) fn add_group(&mut self, first: u32, effects: Effects, walk: impl FnOnce(&mut Self)) {
        let children = self.collected(walk);
        let group = tree::Group {
            items: [first, self.next_item()],
            clips: effects.clips,
            masks: effects.masks,
            opacity: effects.opacity,
            blend: effects.blend,
            isolated: effects.isolated,
            children,
        };
        if group.clips.is_empty() && !group.is_group() {
            self.nodes.extend(group.children);
        } else if !group.children.is_empty() {
            self.nodes.push(tree::Node::Group(Box::new(group)));
        }
    }

    /// Adds clips and masks of a group to its effects; `None` if they let nothing show.
    fn clips_and_masks(
        &mut self,
        group: &'a Group,
        place: Place<'a>,
        effects: &mut Effects,
    ) -> Option<()> {
        if let Some(clip) = group.clip_path() {
            effects.clips = self.clips(clip, place.canvas_from_user)?;
        }
        if let Some(mask) = group.mask() {
            self.mask(mask, place, effects)?;
        }
        Some(())
    }

    /// Adds a mask, after the mask on it if there is one: each weights the group independently.
    fn mask(
        &mut self,
        mask: &'a usvg::Mask,
        place: Place<'a>,
        effects: &mut Effects,
    ) -> Option<()> {
        if let Some(outer) = mask.mask() {
            self.mask(outer, place, effects)?;
        }
        let [x0, y0, x1, y1] = [
            mask.rect().left(),
            mask.rect().top(),
            mask.rect().right(),
            mask.rect().bottom(),
        ]
        .map(f64::from);
        let area = kurbo::Rect::new(x0, y0, x1, y1).to_path(0.1);
        let outline = place.canvas_from_user * area;
        effects
            .clips
            .extend(self.clip_to(outline, FillRule::NonZero)?);
        let first = self.next_item();
        // The mask's picture is not part of the group: nothing of its surroundings applies.
        let place = Place {
            opacity: 1.0,
            recolor: None,
            ..place
        };
        let children = self.collected(|walker| walker.children(mask.root(), place));
        // A mask that shows nothing weights with 0 everywhere.
        if children.is_empty() {
            return None;
        }
        effects.masks.push(Mask {
            kind: match mask.kind() {
                MaskType::Luminance => MaskKind::Luminance,
                MaskType::Alpha => MaskKind::Alpha,
            },
            items: [first, self.next_item()],
            children,
        });
        Some(())
    }
}

/// How many branches can be pending at once while the clip is decided and its group drawn: for each
/// clip that contains another one past the group, and one past the rest of a union.
fn clip_depth(clip: &usvg::ClipPath) -> u32 {
    let outer = clip.clip_path().map_or(0, clip_depth);
    2 + outer + nested_clip_depth(clip.root())
}

fn nested_clip_depth(group: &Group) -> u32 {
    let depth = |node: &Node| match node {
        Node::Group(inner) => inner.clip_path().map_or(0, clip_depth) + nested_clip_depth(inner),
        _ => 0,
    };
    group.children().iter().map(depth).max().unwrap_or(0)
}

/// Whether a group has a blend mode that depends on what lies behind it.
fn blends(group: &Group) -> bool {
    group.blend_mode() != BlendMode::Normal
}

/// Whether a group inside has a blend mode whose backdrop is this group's content, and what lies
/// behind it unless the group is isolated.
pub(super) fn holds_open_blend(group: &Group) -> bool {
    group.children().iter().any(|node| match node {
        Node::Group(child) => blends(child) || (!child.should_isolate() && holds_open_blend(child)),
        _ => false,
    })
}

fn blend_mode(mode: BlendMode) -> format::BlendMode {
    match mode {
        BlendMode::Normal => format::BlendMode::Normal,
        BlendMode::Multiply => format::BlendMode::Multiply,
        BlendMode::Screen => format::BlendMode::Screen,
        BlendMode::Overlay => format::BlendMode::Overlay,
        BlendMode::Darken => format::BlendMode::Darken,
        BlendMode::Lighten => format::BlendMode::Lighten,
        BlendMode::ColorDodge => format::BlendMode::ColorDodge,
        BlendMode::ColorBurn => format::BlendMode::ColorBurn,
        BlendMode::HardLight => format::BlendMode::HardLight,
        BlendMode::SoftLight => format::BlendMode::SoftLight,
        BlendMode::Difference => format::BlendMode::Difference,
        BlendMode::Exclusion => format::BlendMode::Exclusion,
        BlendMode::Hue => format::BlendMode::Hue,
        BlendMode::Saturation => format::BlendMode::Saturation,
        BlendMode::Color => format::BlendMode::Color,
        BlendMode::Luminosity => format::BlendMode::Luminosity,
        BlendMode::PlusLighter => format::BlendMode::PlusLighter,
    }
}
