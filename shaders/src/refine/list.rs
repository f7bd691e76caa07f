//! The list of a part of a cell, and the items that evaluators walk.

use vtex_format::{Entry, EntryKind};

use super::outline::{Outline, Region, Segment};
use crate::layout::item;

/// The last item of an entry holds a base winding of four bits.
const BASE_LIMIT: i32 = 8;
/// Lower end of the line that stands for a change of the winding: below every lookup.
const LOWEST: u32 = 0xffff;

/// An entry with its outline, if it has one.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Part {
    entry: Entry,
    outline: Option<Outline>,
}

/// What shows in a region, front to back.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct List {
    parts: Vec<Part>,
}

impl List {
    /// The list of a whole cell; `words` starts at its first entry.
    pub(super) fn decode(words: &[u32], curves: &[u32]) -> Self {
        let mut list = Self::default();
        for &words in words.as_chunks::<2>().0 {
            let Some(entry) = Entry::decode(words) else {
                break;
            };
            let outline = (entry.kind == EntryKind::Curves)
                .then(|| curves.get(entry.data as usize..).and_then(Outline::decode))
                .flatten();
            list.parts.push(Part { entry, outline });
            if entry.last {
                break;
            }
        }
        list
    }

    /// Whether a part of the region can have less to show.
    pub(super) fn has_outlines(&self) -> bool {
        self.parts.iter().any(|part| part.outline.is_some())
    }

    /// Items a lookup walks at most.
    pub(super) fn item_count(&self) -> usize {
        let of = |part: &Part| {
            let outline = part.outline.as_ref();
            outline.map_or(1, |o| (o.segments.len() + o.changes.len()).max(1))
        };
        self.parts.iter().map(of).sum()
    }

    /// What shows in `region`, a part of the region this is for.
    pub(super) fn within(&self, region: &Region) -> Self {
        let mut inner = Self::default();
        for part in &self.parts {
            let part = match &part.outline {
                None => part.clone(),
                Some(outline) => {
                    let outline = outline.within(region);
                    if !outline.is_uniform() {
                        Part {
                            entry: part.entry,
                            outline: Some(outline),
                        }
                    } else if outline.base_fills() {
                        Part {
                            entry: Entry {
                                kind: EntryKind::Full,
                                data: 0,
                                ..part.entry
                            },
                            outline: None,
                        }
                    } else {
                        continue;
                    }
                }
            };
            let hides = part.entry.kind == EntryKind::Full && part.entry.opaque;
            inner.parts.push(part);
            if hides {
                break;
            }
        }
        inner
    }

    /// The paint that fills the region, if nothing else shows.
    pub(super) fn solid(&self) -> Option<u32> {
        match self.parts.as_slice() {
            [part] if part.entry.kind == EntryKind::Full => Some(part.entry.index),
            _ => None,
        }
    }

    /// Whether nothing shows.
    pub(super) fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// The items, four words each.
    pub(super) fn items(&self) -> Vec<[u32; 4]> {
        let mut items = Vec::new();
        for (index, part) in self.parts.iter().enumerate() {
            let first = items.len();
            let mut tail = tail(&part.entry);
            match &part.outline {
                None => items.push([part.entry.data, 0, 0, item::GHOST_BIT]),
                Some(outline) => {
                    let base = outline.base.clamp(-BASE_LIMIT, BASE_LIMIT - 1);
                    push_outline(&mut items, outline, outline.base - base);
                    tail |= (base.cast_unsigned() << item::BASE_RIGHT) >> item::BASE_LEFT;
                    tail |= if outline.even_odd {
                        item::EVEN_ODD_BIT
                    } else {
                        0
                    };
                }
            }
            if items.len() == first {
                items.push([0, 0, 0, item::GHOST_BIT]);
            }
            if index + 1 == self.parts.len() {
                tail |= item::LAST_BIT;
            }
            if let Some(end) = items.last_mut() {
                end[3] |= tail;
            }
        }
        items
    }
}

fn tail(entry: &Entry) -> u32 {
    let opaque = if entry.opaque { item::OPAQUE_BIT } else { 0 };
    (entry.index & item::INDEX_MASK) | kind(entry.kind) | item::END_BIT | opaque
}

/// `excess` is winding that the last item's base cannot hold.
fn push_outline(items: &mut Vec<[u32; 4]>, outline: &Outline, excess: i32) {
    let changes = outline.changes.iter().copied();
    for (height, change) in std::iter::once((0, excess)).chain(changes) {
        let line = Segment {
            points: [height << 16, height << 16, LOWEST << 16],
            down: change > 0,
            line: true,
        };
        let [a, c, b, tail] = encode(&line);
        let ghost = [a, c, b, tail | item::GHOST_BIT];
        items.extend((0..change.unsigned_abs()).map(|_| ghost));
    }
    items.extend(outline.segments.iter().map(encode));
}

fn kind(kind: EntryKind) -> u32 {
    match kind {
        EntryKind::Full => item::FULL,
        EntryKind::Msdf => item::MSDF,
        EntryKind::Curves => item::CURVES,
        EntryKind::Image => item::IMAGE,
        EntryKind::Test | EntryKind::Open | EntryKind::Close | EntryKind::Mask => item::CONTROL_BIT,
    }
}

fn encode(segment: &Segment) -> [u32; 4] {
    let [a, c, b] = segment.points;
    let down = if segment.down { item::DOWN_BIT } else { 0 };
    let line = if segment.line { item::LINE_BIT } else { 0 };
    [a, c, b, down | line]
}
