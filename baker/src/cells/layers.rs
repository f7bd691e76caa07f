//! The file's layers: the ranks that hold shapes.

use vtex_format::LayerRecord;

use super::{lists::CellLists, packing::Packing};
use crate::coverage::placed::Placed;

/// Layers are the ranks that hold shapes.
#[derive(Debug)]
pub(crate) struct Layers {
    /// Index of each rank's layer. A rank without shapes gets the layer of the next rank; nothing
    /// uses that number.
    pub(crate) of_rank: Vec<u32>,
    shape_counts: Vec<u32>,
}

impl Layers {
    /// The layers of packed items.
    pub(crate) fn new(placed: &[Placed], packing: &Packing) -> Self {
        let mut shapes_of_rank = vec![0; packing.count as usize];
        for (item, &rank) in placed.iter().zip(&packing.ranks) {
            shapes_of_rank[rank as usize] += u32::from(item.is_shape());
        }
        let mut next = 0;
        let of_rank = shapes_of_rank
            .iter()
            .map(|&shapes| {
                let layer = next;
                next += u32::from(shapes > 0);
                layer
            })
            .collect();
        shapes_of_rank.retain(|&shapes| shapes > 0);
        Self {
            of_rank,
            shape_counts: shapes_of_rank,
        }
    }

    /// One record a layer; tiles are those of `lists`.
    pub(crate) fn records(&self, lists: &CellLists) -> Vec<LayerRecord> {
        let first_of = |layer: u32| {
            // Tiles are sorted by layer, so a layer is a range of them.
            let first = lists.tiles.partition_point(|tile| tile.layer < layer);
            u32::try_from(first).unwrap_or(u32::MAX)
        };
        (0..)
            .zip(&self.shape_counts)
            .map(|(layer, &shape_count)| LayerRecord {
                tile_first: first_of(layer),
                tile_count: first_of(layer + 1) - first_of(layer),
                shape_count,
                reserved: 0,
            })
            .collect()
    }
}
