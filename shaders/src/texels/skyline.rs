//! Places for rectangles above each other, by the heights that are already taken.

/// A page of some width that fills up from the top: along it, runs of columns with how far each is taken.
#[derive(Clone, Debug)]
pub(super) struct Skyline {
    width: u32,
    runs: Vec<Run>,
}

#[derive(Clone, Copy, Debug)]
struct Run {
    left: u32,
    taken: u32,
}

impl Skyline {
    pub(super) fn new(width: u32) -> Self {
        let runs = vec![Run { left: 0, taken: 0 }];
        Self { width, runs }
    }

    /// Takes the place whose end is the highest, the leftmost of equals; `None` when it would end
    /// beyond `height`.
    pub(super) fn place(&mut self, size: [u32; 2], height: u32) -> Option<[u32; 2]> {
        let starts = 0..self.runs.len();
        let fits = |&(_, top): &(usize, u32)| top + size[1] <= height;
        let tops = starts.filter_map(|at| Some((at, self.top(at, size[0])?)));
        let (at, top) = tops.filter(fits).min_by_key(|&(_, top)| top)?;
        let left = self.runs[at].left;
        let right = left + size[0];
        let behind = self.runs[at..].iter().take_while(|run| run.left < right);
        let covered = behind.count();
        let rest = self.runs[at + covered - 1].taken;
        let mut new = vec![Run {
            left,
            taken: top + size[1],
        }];
        let next = self
            .runs
            .get(at + covered)
            .map_or(self.width, |run| run.left);
        if right < next {
            new.push(Run {
                left: right,
                taken: rest,
            });
        }
        self.runs.splice(at..at + covered, new);
        Some([left, top])
    }

    /// Where a rectangle of this width comes to lie that begins with the run `at`.
    fn top(&self, at: usize, width: u32) -> Option<u32> {
        let left = self.runs[at].left;
        let right = left
            .checked_add(width)
            .filter(|&right| right <= self.width)?;
        let below = self.runs[at..].iter().take_while(|run| run.left < right);
        below.map(|run| run.taken).max()
    }

    /// How far it is taken.
    pub(super) fn height(&self) -> u32 {
        self.runs.iter().map(|run| run.taken).max().unwrap_or(0)
    }
}
