//! Sums over folders.

use std::collections::BTreeMap;

use super::row::Row;

/// One line of the table of folders.
#[derive(Clone, Debug, Default)]
pub(crate) struct Totals {
    pub(crate) files: usize,
    pub(crate) failed: usize,
    /// Without a raster patch.
    pub(crate) solid: usize,
    pub(crate) compared: usize,
    /// Of those compared or failed.
    pub(crate) missed: usize,
    pub(crate) bytes: u64,
    pub(crate) bake_seconds: f64,
    /// PSNR of each zoom, ascending.
    pub(crate) psnr_db: Vec<Vec<f64>>,
}

impl Totals {
    /// Over every folder by its name, and over all under the name `all`.
    pub(crate) fn by_folder(rows: &[Row], zoom_count: usize, bars: &[f64]) -> Vec<(String, Self)> {
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

    fn add(&mut self, row: &Row, bars: &[f64]) {
        self.files += 1;
        self.failed += usize::from(row.error.is_some());
        self.solid += usize::from(row.content.solid);
        self.compared += usize::from(!row.zooms.is_empty());
        self.missed += usize::from(row.misses(bars));
        self.bytes += row.content.bytes;
        self.bake_seconds += row.bake_seconds.unwrap_or_default();
        for (all, zoom) in self.psnr_db.iter_mut().zip(&row.zooms) {
            all.push(zoom.psnr_db);
        }
    }

    /// Least and middle PSNR of a zoom; `None` when nothing was compared.
    pub(crate) fn least_and_median(&self, zoom: usize) -> Option<[f64; 2]> {
        let sorted = self.psnr_db.get(zoom)?;
        Some([*sorted.first()?, *sorted.get(sorted.len() / 2)?])
    }
}
