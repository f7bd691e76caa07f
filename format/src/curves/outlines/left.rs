//! What outlines leave of themselves left of a box.

use crate::curves::cut::to_u16;

/// The winding along a box's left edge.
#[derive(Clone, Debug, Default)]
pub(super) struct Winding {
    /// At the top.
    base: i32,
    /// Heights where it changes, and by how much.
    steps: Vec<(u16, i32)>,
    /// So many of the steps ascend, one for each height.
    settled: usize,
}

impl Winding {
    pub(super) fn base(&self) -> i32 {
        self.base
    }

    /// In any order where not settled.
    pub(super) fn steps(&self) -> &[(u16, i32)] {
        &self.steps
    }

    pub(super) fn clear(&mut self) {
        self.base = 0;
        self.steps.clear();
        self.settled = 0;
    }

    /// Adds a change at a height of a box of this side.
    pub(super) fn change(&mut self, height: f64, change: i32, size: f64) {
        // A change at or above the top holds for the whole box, one at or below the bottom for none
        // of it. A step counts from its own height on.
        if height <= 0.0 {
            self.base = self.base.saturating_add(change);
        } else if height < size {
            self.steps.push((to_u16(height), change));
        }
    }

    pub(super) fn join(&mut self, other: &Self) {
        // A sum that saturates fits no record.
        self.base = self.base.saturating_add(other.base);
        self.steps.extend(&other.steps);
    }

    /// Settles the steps where that may leave far fewer.
    pub(super) fn tidy(&mut self) {
        if self.steps.len() > 2 * self.settled + 8 {
            self.settle();
        }
    }

    /// Brings the steps into ascending order, those of one height as one and none of zero.
    pub(super) fn settle(&mut self) {
        self.steps.sort_unstable_by_key(|step| step.0);
        let mut kept = 0;
        for at in 0..self.steps.len() {
            let (height, change) = self.steps[at];
            match self.steps[..kept].last_mut() {
                Some(last) if last.0 == height => last.1 = last.1.saturating_add(change),
                Some(last) if last.1 == 0 => *last = (height, change),
                _ => {
                    self.steps[kept] = (height, change);
                    kept += 1;
                }
            }
        }
        self.steps.truncate(kept);
        self.steps.pop_if(|last| last.1 == 0);
        self.settled = self.steps.len();
    }
}
