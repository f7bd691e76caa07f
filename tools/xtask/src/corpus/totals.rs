//! Sums over folders and features, and what they say of the bars.

use std::collections::BTreeMap;

use super::bars::{Bar, Bars};
use super::row::Row;

/// One line of the table of folders.
#[derive(Clone, Debug, Default)]
pub(crate) struct Totals {
    pub(crate) files: usize,
    pub(crate) failed: usize,
    /// Without a raster patch.
    pub(crate) native: usize,
    pub(crate) compared: usize,
    /// Of those compared or failed.
    pub(crate) missed: usize,
    pub(crate) bytes: u64,
    pub(crate) bake_seconds: f64,
    /// Sum over files of the share of the canvas that patches cover.
    pub(crate) patch_area: f64,
    /// PSNR of each zoom, ascending.
    pub(crate) psnr_db: Vec<Vec<f64>>,
}

impl Totals {
    /// Over every folder by its name, and over all under the name `all`.
    pub(crate) fn by_folder(rows: &[Row], zoom_count: usize, bars: &Bars) -> Vec<(String, Self)> {
        let mut folders: BTreeMap<&str, Self> = BTreeMap::new();
        let mut all = Self::new(zoom_count);
        for row in rows {
            let folder = folders
                .entry(&row.folder)
                .or_insert_with(|| Self::new(zoom_count));
            folder.add(row, bars);
            all.add(row, bars);
        }
        let mut totals: Vec<(String, Self)> = folders
            .into_iter()
            .map(|(name, totals)| (name.to_owned(), totals))
            .collect();
        totals.push(("all".to_owned(), all));
        for (_, totals) in &mut totals {
            for zoom in &mut totals.psnr_db {
                zoom.sort_by(f64::total_cmp);
            }
        }
        totals
    }

    fn new(zoom_count: usize) -> Self {
        Self {
            psnr_db: vec![Vec::new(); zoom_count],
            ..Self::default()
        }
    }

    fn add(&mut self, row: &Row, bars: &Bars) {
        self.files += 1;
        self.failed += usize::from(row.error.is_some());
        self.native += usize::from(row.content.native && row.error.is_none());
        self.compared += usize::from(!row.zooms.is_empty());
        self.missed += usize::from(row.misses(bars));
        self.bytes += row.content.bytes;
        self.bake_seconds += row.bake_seconds.unwrap_or_default();
        self.patch_area += row.content.patch_area;
        for (all, zoom) in self.psnr_db.iter_mut().zip(&row.zooms) {
            all.push(zoom.psnr_db);
        }
    }

    /// Mean share of the canvas that patches cover.
    pub(crate) fn mean_patch_area(&self) -> f64 {
        self.patch_area / self.files.max(1) as f64
    }

    /// Least and middle PSNR of a zoom; `None` when nothing was compared.
    pub(crate) fn least_and_median(&self, zoom: usize) -> Option<[f64; 2]> {
        let sorted = self.psnr_db.get(zoom)?;
        Some([*sorted.first()?, *sorted.get(sorted.len() / 2)?])
    }
}

/// Files in which a feature became raster patches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FeatureTotals {
    pub(crate) files: usize,
    /// Of those, files in which no other feature did.
    pub(crate) alone: usize,
    /// Sum over these files of the share of the canvas that the feature's patches cover.
    pub(crate) area: f64,
}

impl FeatureTotals {
    /// Over every feature by its name, the most frequent first.
    pub(crate) fn all(rows: &[Row]) -> Vec<(String, Self)> {
        let mut features: BTreeMap<&str, Self> = BTreeMap::new();
        for row in rows {
            let patched = &row.content.patched;
            for (feature, area) in patched {
                let totals = features.entry(feature).or_default();
                totals.files += 1;
                totals.alone += usize::from(patched.len() == 1);
                totals.area += area;
            }
        }
        let named = features.into_iter();
        let mut all: Vec<(String, Self)> = named.map(|(n, t)| (n.to_owned(), t)).collect();
        all.sort_by_key(|(_, totals)| std::cmp::Reverse(totals.files));
        all
    }

    /// Mean share of the canvas, over the files that have such patches.
    pub(crate) fn mean_area(&self) -> f64 {
        self.area / self.files.max(1) as f64
    }
}

/// How the files of one kind fare at one zoom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Verdict {
    pub(crate) native: bool,
    /// Index of the zoom.
    pub(crate) zoom: usize,
    pub(crate) bar: Bar,
    /// Files compared or failed.
    pub(crate) files: usize,
    /// Those that reach the bar, or the truth's own noise.
    pub(crate) reached: usize,
}

impl Verdict {
    /// One for each bar that there are files for.
    pub(crate) fn all(rows: &[Row], zoom_count: usize, bars: &Bars) -> Vec<Self> {
        let kinds = [true, false].into_iter();
        kinds
            .flat_map(|native| (0..zoom_count).map(move |zoom| (native, zoom)))
            .filter_map(|(native, zoom)| Self::new(rows, native, zoom, bars))
            .collect()
    }

    fn new(rows: &[Row], native: bool, zoom: usize, bars: &Bars) -> Option<Self> {
        let bar = bars.of(native, zoom)?;
        let held = |row: &&Row| row.content.native == native && !row.skipped;
        let held: Vec<&Row> = rows.iter().filter(held).collect();
        let reaches = |row: &&&Row| row.above_db(bars, zoom).is_some_and(|above| above >= 0.0);
        let reached = held.iter().filter(reaches).count();
        (!held.is_empty()).then_some(Self {
            native,
            zoom,
            bar,
            files: held.len(),
            reached,
        })
    }

    /// Share of files that reach the bar.
    pub(crate) fn share(&self) -> f64 {
        self.reached as f64 / self.files.max(1) as f64
    }

    pub(crate) fn holds(&self) -> bool {
        self.share() >= self.bar.share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corpus::row::{Content, Zoom};

    fn row(native: bool, psnr_db: f64, patched: &[(&str, f64)]) -> Row {
        let zoom = Zoom {
            psnr_db,
            wrong_share: 0.0,
            noise_db: None,
        };
        let patched = patched.iter().map(|&(name, area)| (name.to_owned(), area));
        Row {
            zooms: vec![zoom],
            content: Content {
                native,
                patched: patched.collect(),
                ..Content::default()
            },
            ..Row::default()
        }
    }

    #[test]
    fn a_bar_wants_its_share_of_files() {
        let bars = Bars::usual(&[1.0]);
        let mut rows: Vec<Row> = (0..99).map(|_| row(true, 41.0, &[])).collect();
        rows.push(row(true, 39.0, &[]));
        rows.push(row(false, 36.0, &[]));
        let verdicts = Verdict::all(&rows, 1, &bars);
        assert!(
            verdicts.len() == 2 && verdicts.iter().all(Verdict::holds),
            "{verdicts:?}"
        );
        rows.push(row(true, 39.0, &[]));
        let native = Verdict::all(&rows, 1, &bars)[0];
        assert!(
            (native.files, native.reached) == (101, 99) && !native.holds(),
            "{native:?}"
        );
    }

    #[test]
    fn features_are_counted_by_files() {
        let rows = [
            row(false, 40.0, &[("filter", 0.5)]),
            row(false, 40.0, &[("filter", 0.1), ("mask", 0.2)]),
        ];
        let [(first, filter), (second, mask)] = &FeatureTotals::all(&rows)[..] else {
            panic!("two features");
        };
        assert_eq!([first.as_str(), second], ["filter", "mask"]);
        assert_eq!(
            (filter.files, filter.alone, mask.files, mask.alone),
            (2, 1, 1, 0)
        );
        assert!((filter.mean_area() - 0.3).abs() < 1e-9, "{filter:?}");
    }
}
