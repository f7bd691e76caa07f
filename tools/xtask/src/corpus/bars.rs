//! What files are held to.

/// A PSNR that a share of files must reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bar {
    pub(crate) db: f64,
    /// In \[0, 1\].
    pub(crate) share: f64,
}

/// Bars of each zoom, by its index; `None` where there is none.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Bars {
    /// Of files that need no raster patch.
    pub(crate) native: Vec<Option<Bar>>,
    /// Of the others.
    pub(crate) patched: Vec<Option<Bar>>,
}

impl Bars {
    /// The usual ones at the zooms that have some.
    pub(crate) fn usual(zooms: &[f64]) -> Self {
        let at = |wanted: f64, db: f64, share: f64| {
            move |&zoom: &f64| ((zoom - wanted).abs() < 1e-9).then_some(Bar { db, share })
        };
        let native = |zoom: &f64| at(1.0, 40.0, 0.99)(zoom).or_else(|| at(8.0, 38.0, 0.97)(zoom));
        Self {
            native: zooms.iter().map(native).collect(),
            patched: zooms.iter().map(at(1.0, 35.0, 0.97)).collect(),
        }
    }

    /// `db` at each zoom for every file.
    pub(crate) fn strict(db: &[f64]) -> Self {
        let bars: Vec<Option<Bar>> = db.iter().map(|&db| Some(Bar { db, share: 1.0 })).collect();
        Self {
            native: bars.clone(),
            patched: bars,
        }
    }

    /// The bar of a file at a zoom.
    pub(crate) fn of(&self, native: bool, zoom: usize) -> Option<Bar> {
        let bars = if native { &self.native } else { &self.patched };
        bars.get(zoom).copied().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_bars_hold_at_their_zooms() {
        let bars = Bars::usual(&[8.0, 32.0, 1.0]);
        let db = |native, zoom| bars.of(native, zoom).map(|bar| bar.db);
        assert_eq!(
            [0, 1, 2].map(|zoom| db(true, zoom)),
            [Some(38.0), None, Some(40.0)]
        );
        assert_eq!(
            [0, 1, 2].map(|zoom| db(false, zoom)),
            [None, None, Some(35.0)]
        );
        assert_eq!(
            Bars::strict(&[45.0]).of(false, 0).map(|bar| bar.db),
            Some(45.0)
        );
        assert_eq!(bars.of(true, 3), None);
    }
}
