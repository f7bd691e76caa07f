//! How long work is cut into short submissions.

use super::records::PassRecord;

/// Longest side of a film: 8,192 workgroups of 8 pixels stay far below the dispatch limit of
/// 65,535. Larger pictures are refused.
pub(super) const MAX_FILM_SIDE: u32 = 65_536;
/// Paths of one submission, unless their state asks for fewer. On a software driver at about a million
/// rays a second this is a fraction of a second, on a graphics card well under a millisecond's overhead a
/// frame; drivers that reset after two seconds are never met. A row of the widest film is just as long.
pub(super) const PATHS_PER_PASS: u32 = MAX_FILM_SIDE;
/// Samples one invocation may add in one pass, so that small films need fewer submissions.
pub(super) const MAX_SAMPLES_PER_PASS: u32 = 16;
/// Submissions that may be under way before the host waits, which bounds queued memory.
pub(super) const MAX_IN_FLIGHT: u32 = 8;
/// Rows and samples of each submission: all rows of some samples, then the next samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passes {
    height: u32,
    rows_per_pass: u32,
    samples_per_pass: u32,
    row: u32,
    sample: u32,
    sample_end: u32,
}

impl Passes {
    /// `paths`: how many a submission may have, at least a row.
    pub(super) fn new(size: [u32; 2], sample_first: u32, sample_count: u32, paths: u32) -> Self {
        let rows = (paths / size[0]).clamp(1, size[1]);
        let samples = (paths / rows.saturating_mul(size[0]).max(1)).clamp(1, MAX_SAMPLES_PER_PASS);
        Self {
            height: size[1],
            rows_per_pass: rows,
            samples_per_pass: samples,
            row: 0,
            sample: sample_first,
            sample_end: sample_first.saturating_add(sample_count),
        }
    }
}

impl Iterator for Passes {
    type Item = PassRecord;

    fn next(&mut self) -> Option<PassRecord> {
        if self.sample >= self.sample_end {
            return None;
        }
        let record = PassRecord {
            row_first: self.row,
            row_count: self.rows_per_pass.min(self.height - self.row),
            sample_first: self.sample,
            sample_count: self.samples_per_pass.min(self.sample_end - self.sample),
        };
        // A pixel's samples are added in the order of their numbers, however they are cut: sums in
        // f32 depend on the order, and the picture must not depend on the cut.
        self.row += record.row_count;
        if self.row == self.height {
            self.row = 0;
            self.sample += record.sample_count;
        }
        Some(record)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(size: [u32; 2], first: u32, count: u32, paths: u32) {
        let mut seen = vec![0_u32; size[1] as usize];
        for pass in Passes::new(size, first, count, paths) {
            assert!(pass.row_count > 0 && pass.sample_count > 0, "idle pass");
            assert!(pass.sample_first >= first, "sample twice");
            let pixels = pass.row_count * size[0];
            assert!(pixels * pass.sample_count <= paths, "more paths than fit");
            for row in pass.row_first..pass.row_first + pass.row_count {
                assert_eq!(pass.sample_first, first + seen[row as usize], "order");
                seen[row as usize] += pass.sample_count;
            }
        }
        assert!(seen.iter().all(|&n| n == count), "{size:?}: {seen:?}");
    }

    #[test]
    fn passes_cover_every_row_and_sample_once_in_order() {
        check([1, 1], 0, 1000, PATHS_PER_PASS);
        check([640, 480], 5, 3, PATHS_PER_PASS);
        check([640, 480], 5, 3, 1 << 18);
        check([65_536, 3], 0, 2, PATHS_PER_PASS);
        check([100, 100], 0, 0, PATHS_PER_PASS);
        check([100, 7], 0, 3, 128);
    }
}
