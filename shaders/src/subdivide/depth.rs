//! How fine the cells that evaluators read are to be: what lookups walk against memory, for each cell
//! of the file by its own content.

use vtex_format::VtexFile;

use crate::layout::{FilterMode, half};

/// Deepest subdivision: each step halves the sides of cells.
pub(super) const MAX_DEPTH: u32 = 6;
/// Cost of walking a command. The unit is a lookup in a cell of one colour (about 7.5 ns on two
/// cores under llvmpipe, where a command takes 2 ns).
const COMMAND_COST: f64 = 0.27;
/// The same for the samples of a footprint: 34 ns where a point's command takes 21, in the busiest
/// part of the Tiger on a slower machine. (The twin takes 4.8 times as long for one, but is not
/// what most lookups run on.)
const FOOTPRINT_COMMAND_COST: f64 = 0.45;
/// Cost of reading a second word.
const BLOCK_COST: f64 = 0.05;
/// Cost of a MiB for points. What it is worth in time is a judgement: each must save a mean lookup five
/// commands in nine (docs/decisions/0030 has other values).
const MIB_COST: f64 = 0.15;
/// The same for footprints: two commands in fifteen (docs/decisions/0019).
const FOOTPRINT_MIB_COST: f64 = 0.06;
/// Bytes of a cell of a block that is narrow, as nearly all are where lookups are of points.
const NARROW_CELL_BYTES: f64 = half::BITS as f64 / 8.0;
/// Bytes of another cell.
const CELL_BYTES: f64 = 4.0;
/// One depth more is taken to leave at least this share of what parts with outlines walk: a straight
/// edge leaves half, because it goes through two quarters of four. No list is cut for a depth that
/// is not worth it even so. Over 69 drawings that saves half of all cuts, and by this model the
/// depths cost less than a thousandth more.
const LEAST_LEFT: f64 = 0.4;
/// No texture takes more bytes of words and commands than this, unless the file's own cells do.
pub(super) const MAX_BYTES: usize = 48 << 20;

/// What decides depths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Model {
    /// Of a command in a walk of all lookups in a cell of the file.
    command: f64,
    /// Of a second word for all lookups in a cell of the file.
    block: f64,
    /// Of a byte.
    byte: f64,
    /// Bytes of a cell.
    cell_bytes: f64,
    /// The greatest depth.
    pub(super) max_depth: u32,
    /// Whether every cell with an edge gets it.
    pub(super) forced: bool,
}

/// What a depth takes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// Commands of a list, weighted by the share of a cell that it serves.
    pub(super) walked: f64,
    /// Commands stored.
    pub(super) stored: f64,
}

/// A search for the best depth of one list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Search {
    model: Model,
    /// Cells that show the list.
    uses: f64,
    pub(super) best_depth: u32,
    best_cost: f64,
}

impl Model {
    /// `halvings` as in [`crate::PackOptions`].
    pub(super) fn new(file: &VtexFile, filter: FilterMode, halvings: Option<u32>) -> Self {
        let cells = count(file.cells.len().max(1));
        let (command, mib, cell_bytes) = match filter {
            FilterMode::Footprint => (FOOTPRINT_COMMAND_COST, FOOTPRINT_MIB_COST, CELL_BYTES),
            FilterMode::Point | FilterMode::Paper => (COMMAND_COST, MIB_COST, NARROW_CELL_BYTES),
        };
        Self {
            command: command / cells,
            block: BLOCK_COST / cells,
            byte: mib / f64::from(1 << 20),
            cell_bytes,
            max_depth: halvings.unwrap_or(MAX_DEPTH).min(MAX_DEPTH),
            forced: halvings.is_some(),
        }
    }

    /// One that takes fewer bytes; `None` where nothing is divided any more.
    pub(super) fn coarser(mut self) -> Option<Self> {
        self.max_depth = self.max_depth.checked_sub(1)?;
        self.byte *= 4.0;
        Some(self)
    }

    /// A search that begins with a list in whole cells, `uses` of them.
    pub(super) fn search(&self, whole: Sums, uses: usize) -> Search {
        let mut search = Search {
            model: *self,
            uses: count(uses),
            best_depth: 0,
            best_cost: f64::INFINITY,
        };
        search.best_cost = search.cost(0, whole);
        search
    }
}

impl Search {
    fn cost(&self, depth: u32, sums: Sums) -> f64 {
        let (words, block) = match depth {
            0 => (0.0, 0.0),
            _ => (f64::from(4_u32.pow(depth)), self.model.block),
        };
        self.uses * (sums.walked * self.model.command + block)
            + self.model.byte * (self.model.cell_bytes * words + 16.0 * sums.stored)
    }

    /// Whether `depth` can be better than the best one: `present` is what the depth before takes,
    /// and `settled` what of it stays.
    pub(super) fn promises(&self, depth: u32, settled: Sums, present: Sums) -> bool {
        let left = LEAST_LEFT * (present.walked - settled.walked);
        let next = Sums {
            walked: settled.walked + left,
            stored: present.stored,
        };
        self.model.forced || self.cost(depth, next) < self.best_cost
    }

    /// Takes note of what `depth` takes; false where the search is at its end.
    pub(super) fn visit(&mut self, depth: u32, sums: Sums) -> bool {
        let cost = self.cost(depth, sums);
        if self.model.forced || cost < self.best_cost {
            self.best_cost = cost;
            self.best_depth = depth;
        }
        // The first block costs a second word for what the next depths gain.
        let patience = if self.best_depth == 0 { 1 } else { 0 };
        depth < self.model.max_depth && depth - self.best_depth <= patience
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts far below 2^53")]
pub(super) fn count(commands: usize) -> f64 {
    commands as f64
}
