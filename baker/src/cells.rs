//! The cell grid: for each cell what shows in it, front to back.

use std::collections::BTreeMap;

use vtex_format::{
    CellWord, Entry, EntryKind, MAX_ENTRIES_PER_CELL, SourceRecord, cut::CellCurves,
};

use crate::{
    cover::Cover, curves::record::encode_record, drawing::FillRule, error::BakeError,
    grid::Lattice, paint_table::PaintTable, placed::Placed, subset::Packing,
};

/// What a cell list is made from: one record an item, in painter's order.
#[derive(Debug)]
pub(crate) struct CellInput<'a> {
    /// The items.
    pub(crate) placed: &'a [Placed],
    /// Where they show; empty for patches.
    pub(crate) covers: &'a [Cover],
    /// Their paint, or their image for a patch.
    pub(crate) paint_or_image: &'a [u32],
    /// Their ranks.
    pub(crate) packing: &'a Packing,
    /// Layer of each rank.
    pub(crate) layer_of_rank: &'a [u32],
}

/// The grid's words and what they need.
#[derive(Debug, Default)]
pub(crate) struct CellLists {
    /// One word a cell: [`CellWord`].
    pub(crate) words: Vec<u32>,
    /// The lists: [`Entry`].
    pub(crate) entries: Vec<u32>,
    /// Tiles, layer by layer and cell by cell.
    pub(crate) tiles: Vec<TileDraft>,
    /// Curve records, one after the other.
    pub(crate) curves: Vec<u32>,
    /// What each of them is cut from; outlines are items here.
    pub(crate) sources: Vec<SourceRecord>,
}

/// A tile that some cell lists.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct TileDraft {
    /// Index of its layer.
    pub(crate) layer: u32,
    /// Index of its cell.
    pub(crate) cell: u32,
    /// Items in it, in painter's order.
    pub(crate) items: Vec<u32>,
}

/// An entry before tiles have indices.
#[derive(Clone, Debug, PartialEq)]
enum Draft<'a> {
    Full { paint: u32 },
    Tile { paint: u32, tile: TileDraft },
    Curves(CurvesDraft<'a>),
    Image { image: u32 },
}

/// Shapes of one cell that share a record.
#[derive(Clone, Debug, PartialEq)]
struct CurvesDraft<'a> {
    paint: u32,
    rank: u32,
    rule: FillRule,
    parts: Vec<&'a CellCurves>,
    source: SourceRecord,
    words: Vec<u32>,
}

/// Builds every cell's list.
pub(crate) fn build_cells(
    input: &CellInput<'_>,
    lattice: &Lattice,
    paints: &mut PaintTable,
) -> Result<CellLists, BakeError> {
    let drafts: Vec<Vec<Draft<'_>>> = items_by_cell(input, lattice)
        .into_iter()
        .zip(0_u32..)
        .map(|(items, cell)| draft_cell(input, items, cell, paints))
        .collect();
    let mut tiles: Vec<TileDraft> = drafts
        .iter()
        .flatten()
        .filter_map(|draft| match draft {
            Draft::Tile { tile, .. } => Some(tile.clone()),
            _ => None,
        })
        .collect();
    // Layer by layer as the format wants; within a cell a layer may have a tile a paint.
    tiles.sort_unstable();
    let mut encoder = ListEncoder {
        lists: CellLists {
            tiles,
            ..CellLists::default()
        },
        shared: BTreeMap::new(),
        records: BTreeMap::new(),
        paints,
    };
    for cell in &drafts {
        let word = encoder.cell_word(cell)?;
        encoder.lists.words.push(word);
    }
    Ok(encoder.lists)
}

/// For every cell the items in it, in painter's order, and whether they cover it whole.
fn items_by_cell(input: &CellInput<'_>, lattice: &Lattice) -> Vec<Vec<(u32, bool)>> {
    let mut by_cell = vec![Vec::new(); lattice.cell_count()];
    for (item, (placed, cover)) in (0_u32..).zip(input.placed.iter().zip(input.covers)) {
        if placed.is_shape() {
            for &cell in &cover.cells.listed {
                by_cell[cell as usize].push((item, false));
            }
            for &cell in &cover.cells.full {
                by_cell[cell as usize].push((item, true));
            }
        } else if let Some([columns, rows]) = lattice.cells_in(placed.bounds()) {
            for row in rows[0]..=rows[1] {
                for column in columns[0]..=columns[1] {
                    let cell = row * lattice.grid.size_cells[0] + column;
                    by_cell[cell as usize].push((item, false));
                }
            }
        }
    }
    by_cell
}

/// Sorts, merges, folds and cuts one cell's items into its entries, front to back.
fn draft_cell<'a>(
    input: &CellInput<'a>,
    mut items: Vec<(u32, bool)>,
    cell: u32,
    paints: &mut PaintTable,
) -> Vec<Draft<'a>> {
    // Members of a rank do not meet, so their order is free and equal paints may come together.
    let free = !input.packing.forced;
    items.sort_unstable_by_key(|&(item, _)| {
        let index = item as usize;
        let paint = if free { input.paint_or_image[index] } else { 0 };
        std::cmp::Reverse((input.packing.ranks[index], paint, item))
    });
    let mut drafts: Vec<Draft<'a>> = Vec::new();
    let items = items.into_iter();
    for draft in items.flat_map(|(item, full)| draft_item(input, item, full, cell)) {
        let opaque_full = matches!(draft, Draft::Full { paint } if paints.is_opaque(paint));
        let merged = match drafts.last_mut() {
            Some(front) => merge(front, &draft, free, paints),
            None => false,
        };
        if !merged {
            drafts.push(draft);
        }
        if opaque_full {
            break;
        }
    }
    drafts
}

/// The entries of one item: one, but for curves that a record is too small for.
fn draft_item<'a>(input: &CellInput<'a>, item: u32, full: bool, cell: u32) -> Vec<Draft<'a>> {
    let index = item as usize;
    let paint = input.paint_or_image[index];
    if !input.placed[index].is_shape() {
        return vec![Draft::Image { image: paint }];
    }
    if full {
        return vec![Draft::Full { paint }];
    }
    let rank = input.packing.ranks[index];
    let parts = input.covers[index].curves_in(cell);
    if !parts.is_empty() {
        let rule = input.placed[index].rule;
        let source = SourceRecord {
            cell,
            outlines: vec![item],
        };
        let draft = |part| {
            Draft::Curves(CurvesDraft {
                paint,
                rank,
                rule,
                // Every part fits a record of its own, or the shape would not be curves.
                words: encode_record(&[part], rule).unwrap_or_default(),
                parts: vec![part],
                source: source.clone(),
            })
        };
        return parts.iter().map(draft).collect();
    }
    let layer = input.layer_of_rank[rank as usize];
    let tile = TileDraft {
        layer,
        cell,
        items: vec![item],
    };
    vec![Draft::Tile { paint, tile }]
}

/// Takes `back` into `front` where one entry can stand for both. `apart` says that members of a
/// rank do not meet.
fn merge<'a>(
    front: &mut Draft<'a>,
    back: &Draft<'a>,
    apart: bool,
    paints: &mut PaintTable,
) -> bool {
    match (front, back) {
        (Draft::Full { paint }, Draft::Full { paint: behind }) => {
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
            tile.items.extend(&other.items);
            tile.items.sort_unstable();
            true
        }
        (Draft::Curves(front), Draft::Curves(back)) if apart => front.join(back),
        _ => false,
    }
}

impl CurvesDraft<'_> {
    fn join(&mut self, other: &Self) -> bool {
        let alike = self.paint == other.paint && self.rank == other.rank && self.rule == other.rule;
        if !alike {
            return false;
        }
        let parts = [self.parts.as_slice(), &other.parts].concat();
        let Ok(words) = encode_record(&parts, self.rule) else {
            return false;
        };
        (self.parts, self.words) = (parts, words);
        self.source.outlines.extend(&other.source.outlines);
        true
    }
}

struct ListEncoder<'a> {
    lists: CellLists,
    /// Offsets of the lists so far, so that equal ones are stored once.
    shared: BTreeMap<Vec<u32>, u32>,
    /// Offsets of the records so far.
    records: BTreeMap<Vec<u32>, u32>,
    paints: &'a PaintTable,
}

impl ListEncoder<'_> {
    fn cell_word(&mut self, drafts: &[Draft<'_>]) -> Result<u32, BakeError> {
        let word = match drafts {
            [] => CellWord::Empty,
            [Draft::Full { paint }] => CellWord::Solid { paint: *paint },
            list => CellWord::List {
                offset_words: self.list_offset(list)?,
            },
        };
        word.encode()
            .ok_or_else(|| BakeError::Limit("more paints or entries than a cell can name".into()))
    }

    fn list_offset(&mut self, list: &[Draft<'_>]) -> Result<u32, BakeError> {
        if list.len() > MAX_ENTRIES_PER_CELL as usize {
            return Err(BakeError::Limit(format!(
                "{} shapes show in one cell of the grid, at most {MAX_ENTRIES_PER_CELL} can",
                list.len()
            )));
        }
        let mut words = Vec::with_capacity(2 * list.len());
        for (i, draft) in list.iter().enumerate() {
            let mut entry = self.entry(draft)?;
            entry.last = i + 1 == list.len();
            let encoded = entry.encode();
            words.extend(encoded.ok_or_else(|| {
                BakeError::Limit("more paints or images than an entry can name".into())
            })?);
        }
        let next = u32::try_from(self.lists.entries.len())
            .map_err(|_| BakeError::Limit("the cells' lists are too long".into()))?;
        let offset = *self.shared.entry(words.clone()).or_insert(next);
        if offset == next {
            self.lists.entries.extend(words);
        }
        Ok(offset)
    }

    fn entry(&mut self, draft: &Draft<'_>) -> Result<Entry, BakeError> {
        let (kind, index, data) = match draft {
            Draft::Full { paint } => (EntryKind::Full, *paint, 0),
            Draft::Curves(curves) => {
                let record = self.record_offset(curves)?;
                (EntryKind::Curves, curves.paint, record)
            }
            Draft::Image { image } => (EntryKind::Image, *image, 0),
            Draft::Tile { paint, tile } => {
                let tile = self.lists.tiles.partition_point(|other| other < tile);
                let tile = u32::try_from(tile).unwrap_or(u32::MAX);
                (EntryKind::Msdf, *paint, tile)
            }
        };
        Ok(Entry {
            kind,
            last: false,
            opaque: kind != EntryKind::Image && self.paints.is_opaque(index),
            index,
            data,
        })
    }

    fn record_offset(&mut self, draft: &CurvesDraft<'_>) -> Result<u32, BakeError> {
        let words = &draft.words;
        if let Some(&offset) = self.records.get(words) {
            return Ok(offset);
        }
        let curves = &mut self.lists.curves;
        let offset = u32::try_from(curves.len())
            .map_err(|_| BakeError::Limit("the cells' curves are too many".into()))?;
        curves.extend(words);
        self.records.insert(words.clone(), offset);
        self.lists.sources.push(draft.source.clone());
        Ok(offset)
    }
}
