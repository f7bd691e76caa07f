//! How fine the cells that evaluators read are to be: what a lookup walks against memory.

use vtex_format::{CellWord, VtexFile};

use crate::layout::FilterMode;

use super::list::List;
use super::outline::Region;
use super::{dilated, list_of, whole_cell};

/// Deepest subdivision: each step halves the sides of cells.
pub(super) const MAX_DEPTH: u32 = 5;
/// Lists that stand for all of a file.
const SAMPLES: usize = 192;
/// Cost of walking a command. The unit is a lookup in a cell of one colour (about 7.5 ns on two
/// cores under llvmpipe, where a command takes 2 ns).
const COMMAND_COST: f64 = 0.27;
/// The same for the samples of a footprint: 34 ns where a point's command takes 21, in the busiest
/// part of the Tiger on a slower machine. (The twin takes 4.8 times as long for one, but is not
/// what most lookups run on.)
const FOOTPRINT_COMMAND_COST: f64 = 0.45;
/// Cost of a MiB. What it is worth in time is a judgement: each must save a mean lookup a command
/// in fourteen. Twice this takes 10% off the rate in the busiest part of a coat of arms (`saxony`),
/// and 2.4 of its 6.0 MiB.
const MIB_COST: f64 = 0.02;
/// No depth takes more words and commands than this, unless the file's own cells do.
const MAX_MIB: f64 = 48.0;

/// Sums over sampled cells of the file for each depth.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Commands of a list, weighted by the share of a cell that it serves.
    walked: f64,
    /// Commands stored.
    stored: f64,
}

/// How often `file`'s cells are to be halved.
pub(super) fn choose(file: &VtexFile, filter: FilterMode) -> u32 {
    let lists: Vec<u32> = file
        .cells
        .iter()
        .filter_map(|&word| match CellWord::decode(word) {
            Some(CellWord::List { offset_words }) => Some(offset_words),
            _ => None,
        })
        .collect();
    let step = lists.len().div_ceil(SAMPLES).max(1);
    let mut sums = [Sums::default(); MAX_DEPTH as usize + 1];
    let whole = whole_cell(file);
    let dilated = |region: &Region| dilated(region, &whole, filter);
    for &offset_words in lists.iter().step_by(step) {
        add(
            &mut sums,
            &list_of(file, offset_words),
            &whole,
            1.0,
            &dilated,
        );
    }
    let [cells, sampled, lists] =
        [file.cells.len(), lists.len().div_ceil(step), lists.len()].map(count);
    let per_list = lists / sampled.max(1.0);
    let command_cost = if filter == FilterMode::Footprint {
        FOOTPRINT_COMMAND_COST
    } else {
        COMMAND_COST
    };
    let costs = (0..).zip(&sums).map(|(depth, sums)| {
        let words = cells * f64::from(4_u32.pow(depth));
        let mib = (4.0 * words + 16.0 * sums.stored * per_list) / f64::from(1 << 20);
        let walked = sums.walked * per_list / cells.max(1.0);
        let cost = walked * command_cost + mib * MIB_COST;
        (depth, if mib > MAX_MIB { f64::INFINITY } else { cost })
    });
    let best = costs.min_by(|a, b| a.1.total_cmp(&b.1));
    best.filter(|(_, cost)| cost.is_finite())
        .map_or(0, |(depth, _)| depth)
}

/// Adds `list`, which shows in `region`, `share` of a cell, to the sums from its depth on;
/// `dilated` says what the list of a region serves.
fn add(
    sums: &mut [Sums],
    list: &List,
    region: &Region,
    share: f64,
    dilated: &impl Fn(&Region) -> Region,
) {
    let Some((sum, deeper)) = sums.split_first_mut() else {
        return;
    };
    let commands = if list.solid().is_some() {
        0.0
    } else {
        count(list.command_count())
    };
    sum.walked += share * commands;
    sum.stored += commands;
    if list.has_outlines() {
        for quarter in &region.quarters() {
            let inner = list.within(&dilated(quarter));
            add(deeper, &inner, quarter, 0.25 * share, dilated);
        }
    } else {
        // What has no outline is not divided: the same list serves all its parts.
        for sum in deeper {
            sum.walked += share * commands;
            sum.stored += commands;
        }
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts far below 2^53")]
fn count(commands: usize) -> f64 {
    commands as f64
}
