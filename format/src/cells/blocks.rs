//! How the entries of a list hang together: what is clipped by what, which groups there are.
//!
//! A list is a sequence of *blocks*, front to back. A block is one of these:
//!
//! - an entry that draws;
//! - a *clip*: branches, then the blocks that they let through. A branch leads to a
//!   later branch of its own clip, the first block behind them all, or the clip's end;
//! - a *group*: any number of masks, each `Open` (isolated), blocks, `Mask`, then `Open`, blocks,
//!   `Close`. A mask branches over all that follows it, up to and with the `Close`.
//!
//! Where a clip begins and ends follows from where its branches lead: it is the shortest range of
//! entries from its first branch on that no branch inside it leaves.

use std::ops::Range;

use super::cell::{Entry, EntryKind};
use super::control::{BlendMode, OPEN_ISOLATED};

/// Groups and clips that may be nested: evaluators keep a blend stack of so many levels. The baker
/// makes an image of what nests deeper.
pub const MAX_BLEND_DEPTH: u32 = 32;
/// Nested clips that parsing enters, before clips with one end are joined. Bounds its recursion.
const MAX_DEPTH: u32 = 64;

/// A part of a list. Numbers count entries from the list's first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Block {
    /// An entry that draws.
    Draw(usize),
    /// Blocks that show where branches let them through.
    Clip {
        /// The branches. [`branch_target`] of each is in the range, its end, or the end of the
        /// body.
        branches: Range<usize>,
        /// What they guard; not empty.
        body: Vec<Self>,
    },
    /// Blocks composited as one.
    Group {
        /// What its weight is multiplied with.
        masks: Vec<MaskBlock>,
        /// The `Open`.
        open: usize,
        /// What is drawn; may be empty.
        body: Vec<Self>,
        /// The `Close`.
        close: usize,
    },
}

/// A mask of a group.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MaskBlock {
    /// The `Open`.
    pub open: usize,
    /// What is drawn; may be empty.
    pub body: Vec<Block>,
    /// The `Mask`.
    pub close: usize,
}

/// What is wrong with the control entries of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{kind} at entry {entry}")]
pub struct ListFault {
    /// The entry from the list's first.
    pub entry: usize,
    /// What is wrong there.
    pub kind: ListFaultKind,
}

/// Rules that control entries keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ListFaultKind {
    /// A branch leaves its list or group, ends leads into another, or among what a clip lets
    /// through.
    #[error("a branch to where none may lead")]
    Branch,
    /// An `Open` without end, or an end without `Open`.
    #[error("a group without beginning or end")]
    Bracket,
    /// A mask that is not isolated, or what follows it is no group, or it branches over something
    /// else than that.
    #[error("a mask without its group")]
    Mask,
    /// A group that is not isolated and blends other than normally.
    #[error("a blend mode of a group that is not isolated")]
    Blend,
    /// More than [`MAX_BLEND_DEPTH`] groups and clips in one another.
    #[error("groups and clips too deep in one another")]
    BlendDepth,
}

/// Where the `Branch` or `Mask` at `at` leads.
pub const fn branch_target(at: usize, entry: &Entry) -> usize {
    at + 1 + entry.index as usize
}

/// The blocks of a list, front to back; `entries` are all of it.
///
/// # Errors [`ListFault`] with the first rule that is broken, [`ListFaultKind::BlendDepth`] only
/// where that is far beyond the bound: [`list_blend_depth`] tells exactly.
pub fn list_blocks(entries: &[Entry]) -> Result<Vec<Block>, ListFault> {
    let parser = Parser {
        entries,
        ends: bracket_ends(entries)?,
    };
    parser.blocks(0..entries.len(), 0)
}

/// How many levels of the blend stack a list needs at most: one for each group and clip in one
/// another, and inside a clip's branches one for each place where a branch over it may still lead.
/// At most [`MAX_BLEND_DEPTH`]; 0 without control entries.
///
/// # Errors
/// [`ListFault`] with the first rule that is broken.
pub fn list_blend_depth(entries: &[Entry]) -> Result<u32, ListFault> {
    // Lists that only draw need no parsing.
    if entries.iter().all(|entry| entry.kind.draws()) {
        return Ok(0);
    }
    let depth = depth_of(&list_blocks(entries)?, entries);
    if depth > MAX_BLEND_DEPTH {
        return Err(fault(0, ListFaultKind::BlendDepth));
    }
    Ok(depth)
}

const fn fault(entry: usize, kind: ListFaultKind) -> ListFault {
    ListFault { entry, kind }
}

fn depth_of(blocks: &[Block], entries: &[Entry]) -> u32 {
    let of = |block: &Block| match block {
        Block::Draw(_) => 0,
        Block::Clip { branches, body } => {
            // While branches run, each place where a branch may still lead takes a level. Behind
            // them one level stands for the whole clip.
            waiting_branches(branches.clone(), entries).max(1 + depth_of(body, entries))
        }
        Block::Group { masks, body, .. } => {
            let masks = masks.iter().map(|mask| &mask.body);
            let inner = masks.chain([body]).map(|body| depth_of(body, entries));
            1 + inner.max().unwrap_or(0)
        }
    };
    blocks.iter().map(of).max().unwrap_or(0)
}

/// The most places to which branches over one of `branches` lead.
fn waiting_branches(branches: Range<usize>, entries: &[Entry]) -> u32 {
    let mut waiting: Vec<usize> = Vec::new();
    let mut most = 0;
    for at in branches {
        // Branches that lead here have arrived; branches to one place share a level.
        waiting.retain(|&target| target > at);
        let target = branch_target(at, &entries[at]);
        if !waiting.contains(&target) {
            waiting.push(target);
        }
        most = most.max(waiting.len());
        // More than may be; to count on would take quadratic time.
        if most > MAX_BLEND_DEPTH as usize {
            break;
        }
    }
    u32::try_from(most).unwrap_or(u32::MAX)
}

/// For each `Open` where its group ends, 0 for other entries.
fn bracket_ends(entries: &[Entry]) -> Result<Vec<usize>, ListFault> {
    let mut ends = vec![0; entries.len()];
    let mut open = Vec::new();
    for (at, entry) in entries.iter().enumerate() {
        match entry.kind {
            EntryKind::Open => open.push(at),
            EntryKind::Close | EntryKind::Mask => {
                let begin = open.pop().ok_or(fault(at, ListFaultKind::Bracket))?;
                ends[begin] = at;
            }
            _ => {}
        }
        // Refused here already: it bounds how deep `Parser` recurses into groups.
        if open.len() > MAX_BLEND_DEPTH as usize {
            return Err(fault(at, ListFaultKind::BlendDepth));
        }
    }
    match open.pop() {
        Some(at) => Err(fault(at, ListFaultKind::Bracket)),
        None => Ok(ends),
    }
}

struct Parser<'a> {
    entries: &'a [Entry],
    /// As of [`bracket_ends`].
    ends: Vec<usize>,
}

impl Parser<'_> {
    fn blocks(&self, range: Range<usize>, depth: u32) -> Result<Vec<Block>, ListFault> {
        if depth > MAX_DEPTH {
            return Err(fault(range.start, ListFaultKind::BlendDepth));
        }
        let mut blocks = Vec::new();
        let mut at = range.start;
        while at < range.end {
            let (block, next) = match self.entries[at].kind {
                EntryKind::Branch => self.clip(at, range.end, depth)?,
                EntryKind::Open => self.group(at, range.end, depth)?,
                // Its group begins outside the range: a branch cuts it.
                EntryKind::Close | EntryKind::Mask => return Err(fault(at, ListFaultKind::Branch)),
                _ => (Block::Draw(at), at + 1),
            };
            blocks.push(block);
            at = next;
        }
        Ok(blocks)
    }

    /// The clip whose first branch is at `start`, and what follows it.
    fn clip(&self, start: usize, end: usize, depth: u32) -> Result<(Block, usize), ListFault> {
        let (close, branches_end) = self.clip_range(start, end)?;
        let mut body = self.blocks(branches_end..close, depth + 1)?;
        let mut branches = start..branches_end;
        // A clip whose body is one clip is joined with it: both guard the same blocks.
        if let [
            Block::Clip {
                branches: inner, ..
            },
        ] = body.as_slice()
        {
            branches.end = inner.end;
            let Some(Block::Clip { body: inner, .. }) = body.pop() else {
                return Err(fault(start, ListFaultKind::Branch));
            };
            body = inner;
        }
        Ok((Block::Clip { branches, body }, close))
    }

    /// Where the clip from `start` on ends, and its branches.
    fn clip_range(&self, start: usize, end: usize) -> Result<(usize, usize), ListFault> {
        let target = |at: usize| branch_target(at, &self.entries[at]);
        let stray = |at| fault(at, ListFaultKind::Branch);
        // The clip ends where its farthest branch leads, so each branch on the way may move its
        // end.
        let (mut close, mut branches_end) = (target(start), start + 1);
        let mut at = start + 1;
        while at < close.min(end) {
            match self.entries[at].kind {
                EntryKind::Branch if target(at) > close => {
                    // What leads to the end so far leads among the branches.
                    branches_end = branches_end.max(close).max(at + 1);
                    close = target(at);
                }
                // A group lies in the clip as a whole; it is parsed later, with the body.
                EntryKind::Open => at = self.ends[at],
                EntryKind::Close | EntryKind::Mask => return Err(stray(start)),
                _ => {}
            }
            at += 1;
        }
        // `at` is past `close` where a group begins inside the clip and ends behind it.
        if close > end || at != close {
            return Err(stray(start));
        }
        let mut at = start;
        while at < branches_end {
            if self.entries[at].kind != EntryKind::Branch {
                return Err(stray(at));
            }
            if target(at) < close {
                branches_end = branches_end.max(target(at));
            }
            at += 1;
        }
        // Branches behind these that lead to the end guard the same body: they are branches of this
        // clip, not clips in its body.
        let more = self.entries[branches_end..close].iter().zip(branches_end..);
        let guards =
            more.take_while(|&(entry, at)| entry.kind == EntryKind::Branch && target(at) == close);
        branches_end += guards.count();
        // A clip without a body shows nothing.
        if branches_end >= close {
            return Err(stray(start));
        }
        Ok((close, branches_end))
    }

    /// The group whose first `Open` is at `start`, and what follows it.
    fn group(&self, start: usize, end: usize, depth: u32) -> Result<(Block, usize), ListFault> {
        let mut masks = Vec::new();
        let mut open = start;
        loop {
            let close = self.ends[open];
            if close >= end {
                return Err(fault(open, ListFaultKind::Branch));
            }
            let body = self.blocks(open + 1..close, depth + 1)?;
            let isolated = self.entries[open].data == OPEN_ISOLATED;
            let last = self.entries[close];
            if last.kind == EntryKind::Close {
                if last.index != BlendMode::Normal as u32 && !isolated {
                    return Err(fault(close, ListFaultKind::Blend));
                }
                self.mask_targets(&masks, close + 1)?;
                let group = Block::Group {
                    masks,
                    open,
                    body,
                    close,
                };
                return Ok((group, close + 1));
            }
            let next = self.entries.get(close + 1);
            let followed = next.is_some_and(|next| next.kind == EntryKind::Open);
            if !isolated || !followed || close + 1 >= end {
                return Err(fault(close, ListFaultKind::Mask));
            }
            masks.push(MaskBlock { open, body, close });
            open = close + 1;
        }
    }

    /// All masks of a group branch over the same.
    fn mask_targets(&self, masks: &[MaskBlock], target: usize) -> Result<(), ListFault> {
        let stray = masks
            .iter()
            .find(|mask| branch_target(mask.close, &self.entries[mask.close]) != target);
        match stray {
            Some(mask) => Err(fault(mask.close, ListFaultKind::Mask)),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;
