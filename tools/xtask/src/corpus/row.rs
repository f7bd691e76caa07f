//! What is known of one file.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use serde_json::Value;

use super::bars::Bars;

/// Feature of images that an SVG embeds: kept as they are, they are no patches.
const EMBEDDED: &str = "image";

/// What happened to one file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Row {
    /// First folder below the corpus, or empty.
    pub(crate) folder: String,
    /// Path below the corpus.
    pub(crate) file: String,
    /// What was not done and why.
    pub(crate) error: Option<String>,
    pub(crate) bake_seconds: Option<f64>,
    pub(crate) content: Content,
    /// One a zoom; empty when nothing was compared.
    pub(crate) zooms: Vec<Zoom>,
    /// Baked, but not compared because it was not asked for.
    pub(crate) skipped: bool,
    /// PNGs of the worst window: SVG, vtex, difference.
    pub(crate) pictures: Vec<Vec<u8>>,
}

/// What is in a file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Content {
    pub(crate) bytes: u64,
    /// How many shapes there are of each kind of coverage, such as `curves 12`.
    pub(crate) coverage: BTreeMap<String, usize>,
    /// Raster patches.
    pub(crate) patches: usize,
    /// Share of the canvas that they cover together.
    pub(crate) patch_area: f64,
    /// Images besides them and the canvas' mips: those that the SVG embeds.
    pub(crate) embedded: usize,
    /// Features that were warned of, with their counts.
    pub(crate) warnings: BTreeMap<String, usize>,
    /// Features that became raster patches, each with the share of the canvas that its patches
    /// cover, at most 1.
    pub(crate) patched: BTreeMap<String, f64>,
    /// No raster patch and no warning of one; embedded images do not count.
    pub(crate) native: bool,
}

/// The worst window of one zoom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Zoom {
    pub(crate) psnr_db: f64,
    pub(crate) wrong_share: f64,
    /// PSNR of the truth with half the samples along each side, where it was asked for.
    pub(crate) noise_db: Option<f64>,
}

impl Content {
    /// Reads what `vtex info --format json` says.
    pub(crate) fn parse(json: &[u8]) -> Result<Self> {
        let info: Value = serde_json::from_slice(json)?;
        let list = |key: &str| {
            info[key]
                .as_array()
                .with_context(|| format!("no {key} in info"))
        };
        let patches = &info["patches"];
        let count = patches["count"].as_u64().context("no patches in info")?;
        let mut content = Self {
            bytes: info["file_bytes"]
                .as_u64()
                .context("no file_bytes in info")?,
            patches: usize::try_from(count)?,
            patch_area: patches["area"].as_f64().context("no area of patches")?,
            ..Self::default()
        };
        for shape in list("shapes")? {
            let kind = shape["coverage"].as_str().unwrap_or("unknown");
            *content.coverage.entry(kind.to_owned()).or_default() += 1;
        }
        // Image 0 is the canvas where the spec key says so.
        let features = info["shader"]["features"].as_array();
        let has_mips = features.is_some_and(|all| all.iter().any(|feature| feature == "mips"));
        let others = content.patches + usize::from(has_mips);
        content.embedded = list("images")?.len().saturating_sub(others);
        for warning in list("warnings")? {
            content.add_warning(warning);
        }
        let only_embedded = content.patched.keys().all(|feature| feature == EMBEDDED);
        content.native = content.patches == 0 && only_embedded;
        Ok(content)
    }

    fn add_warning(&mut self, warning: &Value) {
        let feature = warning["feature"].as_str().unwrap_or("unknown");
        *self.warnings.entry(feature.to_owned()).or_default() += 1;
        if warning["name"] == "RasterPatch" {
            let area = self.patched.entry(feature.to_owned()).or_default();
            *area = (*area + warning["area"].as_f64().unwrap_or(0.0)).min(1.0);
        }
    }

    /// `curves 12, msdf 3, image 1`.
    pub(crate) fn coverage_text(&self) -> String {
        counts(&self.coverage)
    }

    /// `filter 2, mask 1`.
    pub(crate) fn warning_text(&self) -> String {
        counts(&self.warnings)
    }
}

fn counts(of: &BTreeMap<String, usize>) -> String {
    let all: Vec<String> = of
        .iter()
        .map(|(name, count)| format!("{name} {count}"))
        .collect();
    all.join(", ")
}

impl Zoom {
    /// Reads what `vtex compare --format json` says.
    pub(crate) fn parse_all(json: &[u8]) -> Result<Vec<Self>> {
        let report: Value = serde_json::from_slice(json)?;
        let zooms = report["zooms"]
            .as_array()
            .context("no zooms in the comparison")?;
        let one = |zoom: &Value| {
            Some(Self {
                psnr_db: zoom["psnr_db"].as_f64()?,
                wrong_share: zoom["wrong_share"].as_f64()?,
                noise_db: zoom["noise_db"].as_f64(),
            })
        };
        zooms
            .iter()
            .map(|zoom| one(zoom).context("a zoom without figures"))
            .collect()
    }
}

impl Row {
    /// What the file is held to at a zoom: its bar, or the truth's own noise where that is lower.
    pub(crate) fn bar_db(&self, bars: &Bars, zoom: usize) -> Option<f64> {
        let bar = bars.of(self.content.native, zoom)?;
        let noise_db = self.zooms.get(zoom).and_then(|zoom| zoom.noise_db);
        Some(noise_db.map_or(bar.db, |noise| noise.min(bar.db)))
    }

    /// How far above its bar a zoom is, dB; `None` without a bar or a comparison.
    pub(crate) fn above_db(&self, bars: &Bars, zoom: usize) -> Option<f64> {
        Some(self.zooms.get(zoom)?.psnr_db - self.bar_db(bars, zoom)?)
    }

    /// The zoom furthest below its bar (where no bar holds: the one of least PSNR) and how far
    /// above it is in dB; `None` when nothing was compared.
    pub(crate) fn margin(&self, bars: &Bars) -> Option<(usize, f64)> {
        let zooms = 0..self.zooms.len();
        let least = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
        let above = zooms.filter_map(|zoom| Some((zoom, self.above_db(bars, zoom)?)));
        above.min_by(least).or_else(|| {
            let all = self.zooms.iter().map(|zoom| zoom.psnr_db).enumerate();
            all.min_by(least)
        })
    }

    /// Whether it failed, or is below a bar.
    pub(crate) fn misses(&self, bars: &Bars) -> bool {
        let below = |zoom| self.above_db(bars, zoom).is_some_and(|above| above < 0.0);
        self.error.is_some() || (0..self.zooms.len()).any(below)
    }

    /// Key of "worst first": failures, then by margin, then what was not compared.
    pub(crate) fn rank(&self, bars: &Bars) -> f64 {
        match (&self.error, self.margin(bars)) {
            (Some(_), _) => f64::NEG_INFINITY,
            (None, Some((_, margin))) => margin,
            (None, None) => f64::INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INFO: &str = r#"{"file_bytes": 70, "images": [{}], "shader": {"features": ["mips"]},
        "patches": {"count": 0, "area": 0.0},
        "shapes": [{"coverage": "curves"}, {"coverage": "msdf"}, {"coverage": "curves"}],
        "warnings": [{"name": "MissingFont", "feature": "text", "area": 0.0}]}"#;

    #[test]
    fn patches_make_a_file_not_native_and_embedded_images_do_not() {
        let native = Content::parse(INFO.as_bytes()).unwrap();
        assert!(native.native, "{native:?}");
        assert_eq!(native.coverage_text(), "curves 2, msdf 1");
        assert_eq!(native.warning_text(), "text 1");
        for patched in [
            INFO.replace("MissingFont", "RasterPatch"),
            INFO.replace("\"count\": 0", "\"count\": 1"),
        ] {
            let content = Content::parse(patched.as_bytes()).unwrap();
            assert!(!content.native, "{patched}");
        }
        let embedded = INFO
            .replace("MissingFont", "RasterPatch")
            .replace("\"text\"", "\"image\"")
            .replace("[{}]", "[{}, {}]");
        let embedded = Content::parse(embedded.as_bytes()).unwrap();
        assert!(embedded.native && embedded.embedded == 1, "{embedded:?}");
    }

    #[test]
    fn areas_of_a_feature_add_up_to_all_at_most() {
        let warnings = [0.25, 0.5, 0.5].map(|area| {
            format!(r#"{{"name": "RasterPatch", "feature": "filter", "area": {area}}}"#)
        });
        let info = INFO.replace(
            "\"warnings\": [",
            &format!("\"warnings\": [{},", warnings.join(",")),
        );
        let content = Content::parse(info.as_bytes()).unwrap();
        assert_eq!(
            content.patched.into_iter().collect::<Vec<_>>(),
            [("filter".into(), 1.0)]
        );
    }

    fn row(zooms: &[u8]) -> Row {
        Row {
            zooms: Zoom::parse_all(zooms).unwrap(),
            ..Row::default()
        }
    }

    #[test]
    fn the_worst_zoom_is_the_one_furthest_below_its_bar() {
        let row = row(br#"{"zooms": [{"psnr_db": 41.0, "wrong_share": 0.0},
            {"psnr_db": 44.0, "wrong_share": 0.5}]}"#);
        let [high, low] = [[40.0, 45.0], [40.0, 44.0]].map(|db| Bars::strict(&db));
        assert_eq!(row.margin(&Bars::default()), Some((0, 41.0)));
        assert_eq!(row.margin(&high), Some((1, -1.0)));
        assert!(row.misses(&high) && !row.misses(&low) && !row.misses(&Bars::default()));
        assert!(Zoom::parse_all(b"{\"zooms\": [{}]}").is_err());
    }

    #[test]
    fn noise_below_the_bar_is_the_bar() {
        let at = |psnr: f64, noise: f64| {
            let json = format!(
                r#"{{"zooms": [{{"psnr_db": {psnr}, "wrong_share": 0, "noise_db": {noise}}}]}}"#
            );
            row(json.as_bytes())
        };
        let bars = Bars::strict(&[40.0]);
        assert!(!at(35.0, 34.0).misses(&bars));
        assert!(at(35.0, 36.0).misses(&bars) && at(35.0, 60.0).misses(&bars));
        assert_eq!(at(35.0, 60.0).bar_db(&bars, 0), Some(40.0));
    }
}
