//! Entries of one cell before tiles and records have offsets.

use vtex_format::{RecordParts, cut::CellCurves};

use crate::{
    cells::{
        input::{CellInput, Present},
        lists::TileDraft,
        paint_table::PaintTable,
    },
    coverage::{curves::record::encode_record, placed::PlacedKind},
    drawing::FillRule,
};

/// An entry that draws.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Draft<'a> {
    /// A paint that covers the whole cell.
    Full { paint: u32 },
    /// An MSDF tile.
    Tile { paint: u32, tile: TileDraft },
    /// A curve record.
    Curves(CurvesDraft<'a>),
    /// A raster image, anywhere in the cell.
    Image { image: u32 },
}

/// A curve record: the outlines of shapes that share cell, paint, rank and fill rule.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CurvesDraft<'a> {
    pub(super) paint: u32,
    rank: u32,
    rule: FillRule,
    parts: Vec<&'a CellCurves>,
    pub(super) record_parts: RecordParts,
    pub(super) words: Vec<u32>,
}

/// The entries of items that no group comes between, front to back. Entries of equal paint are
/// merged, full ones folded into one colour, and all is cut behind the first that hides the rest.
pub(super) fn draft_ungrouped<'a>(
    input: &CellInput<'a>,
    mut items: Vec<Present>,
    cell: u32,
    paints: &mut PaintTable,
) -> Vec<Draft<'a>> {
    // Members of a rank do not meet, so their order within the rank is free: sorting by paint puts
    // those side by side that can share a tile or a record.
    let free = !input.packing.forced;
    items.sort_unstable_by_key(|present| {
        let index = present.item as usize;
        let paint = if free { input.paint_or_image[index] } else { 0 };
        std::cmp::Reverse((input.packing.ranks[index], paint, present.item))
    });
    let mut drafts: Vec<Draft<'a>> = Vec::new();
    let items = items.into_iter();
    for draft in items.flat_map(|present| draft_item(input, present, cell)) {
        let hides = draft.hides(paints);
        let merged = match drafts.last_mut() {
            Some(front) => merge(front, &draft, free, paints),
            None => false,
        };
        if !merged {
            drafts.push(draft);
        }
        if hides {
            break;
        }
    }
    drafts
}

/// The entries of one item: one, or several when its curves do not fit one record.
fn draft_item<'a>(input: &CellInput<'a>, present: Present, cell: u32) -> Vec<Draft<'a>> {
    let Present { item, full } = present;
    let index = item as usize;
    let paint = input.paint_or_image[index];
    // The index names an image here, not a paint.
    if input.placed[index].kind == PlacedKind::Image {
        return vec![Draft::Image { image: paint }];
    }
    if full {
        return vec![Draft::Full { paint }];
    }
    let curves = draft_curves(input, item, cell);
    if !curves.is_empty() {
        return curves.into_iter().map(Draft::Curves).collect();
    }
    let rank = input.packing.ranks[index];
    let layer = input.layer_of_rank[rank as usize];
    // Neither an image nor full nor curves: it is an MSDF.
    let tile = TileDraft {
        layer,
        cell,
        items: vec![item],
    };
    vec![Draft::Tile { paint, tile }]
}

/// An item's outline in a cell: one record, or strips that add up to it. Empty unless it is curves.
pub(super) fn draft_curves<'a>(
    input: &CellInput<'a>,
    item: u32,
    cell: u32,
) -> Vec<CurvesDraft<'a>> {
    let index = item as usize;
    let rule = input.placed[index].rule;
    let parts = input.covers[index].curves_in(cell).iter();
    let draft = |part| CurvesDraft {
        paint: input.paint_or_image[index],
        rank: input.packing.ranks[index],
        rule,
        // Invariant: `cover` has encoded every part alone, so that cannot fail here.
        words: encode_record(&[part], rule).unwrap_or_default(),
        parts: vec![part],
        record_parts: RecordParts {
            cell,
            outlines: vec![item],
        },
    };
    parts.map(draft).collect()
}

/// Merges `back` into `front` where one entry can stand for both, and returns whether it did.
/// `apart` says that members of a rank do not meet.
fn merge<'a>(
    front: &mut Draft<'a>,
    back: &Draft<'a>,
    apart: bool,
    paints: &mut PaintTable,
) -> bool {
    match (front, back) {
        (Draft::Full { paint }, Draft::Full { paint: behind }) => {
            // Solid paints over the whole cell are one colour, computed as lookups would composite
            // them.
            let both = paints.intern_over(*paint, *behind);
            *paint = both.unwrap_or(*paint);
            both.is_some()
        }
        (
            Draft::Tile { paint, tile },
            Draft::Tile {
                paint: other_paint,
                tile: other,
            },
        ) if paint == other_paint && tile.layer == other.layer => {
            // Shapes of one layer and paint share a tile: the nearest edge decides between them.
            tile.items.extend(&other.items);
            tile.items.sort_unstable();
            true
        }
        (Draft::Curves(front), Draft::Curves(back)) if apart => front.join(back),
        _ => false,
    }
}

impl Draft<'_> {
    /// Whether nothing behind it shows in the cell.
    pub(super) fn hides(&self, paints: &PaintTable) -> bool {
        matches!(self, Self::Full { paint } if paints.is_opaque(*paint))
    }
}

impl CurvesDraft<'_> {
    fn join(&mut self, other: &Self) -> bool {
        let alike = self.paint == other.paint && self.rank == other.rank && self.rule == other.rule;
        if !alike {
            return false;
        }
        let parts = [self.parts.as_slice(), &other.parts].concat();
        // The two together may be too much for one record; then each keeps its own.
        let Ok(words) = encode_record(&parts, self.rule) else {
            return false;
        };
        (self.parts, self.words) = (parts, words);
        self.record_parts
            .outlines
            .extend(&other.record_parts.outlines);
        true
    }
}
