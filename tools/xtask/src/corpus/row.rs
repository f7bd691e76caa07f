//! What is known of one file.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use serde_json::Value;

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
    /// Images besides the canvas' mips.
    pub(crate) patches: usize,
    /// Features that were warned of, with their counts.
    pub(crate) warnings: BTreeMap<String, usize>,
    /// No raster patch: neither a warning of one nor an image besides the canvas' mips.
    pub(crate) solid: bool,
}

/// The worst window of one zoom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Zoom {
    pub(crate) psnr_db: f64,
    pub(crate) wrong_share: f64,
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
        let mut content = Self {
            bytes: info["file_bytes"]
                .as_u64()
                .context("no file_bytes in info")?,
            ..Self::default()
        };
        for shape in list("shapes")? {
            let kind = shape["coverage"].as_str().unwrap_or("unknown");
            *content.coverage.entry(kind.to_owned()).or_default() += 1;
        }
        // Image 0 is the canvas where the shader key says so.
        let features = info["shader"]["features"].as_array();
        let has_mips = features.is_some_and(|all| all.iter().any(|feature| feature == "mips"));
        content.patches = list("images")?.len() - usize::from(has_mips);
        let mut patch_warnings = 0;
        for warning in list("warnings")? {
            let feature = warning["feature"].as_str().unwrap_or("unknown");
            *content.warnings.entry(feature.to_owned()).or_default() += 1;
            patch_warnings += usize::from(warning["name"] == "RasterPatch");
        }
        content.solid = content.patches == 0 && patch_warnings == 0;
        Ok(content)
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
            })
        };
        zooms
            .iter()
            .map(|zoom| one(zoom).context("a zoom without figures"))
            .collect()
    }
}

impl Row {
    /// The zoom furthest below its bar (without bars: the one of least PSNR) and how far above it
    /// is in dB; `None` when nothing was compared.
    pub(crate) fn margin(&self, bars: &[f64]) -> Option<(usize, f64)> {
        let above = |(index, zoom): (usize, &Zoom)| {
            (
                index,
                zoom.psnr_db - bars.get(index).copied().unwrap_or_default(),
            )
        };
        let all = self.zooms.iter().enumerate().map(above);
        all.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Whether it failed, or is below a bar.
    pub(crate) fn misses(&self, bars: &[f64]) -> bool {
        let below = !bars.is_empty() && self.margin(bars).is_some_and(|(_, margin)| margin < 0.0);
        self.error.is_some() || below
    }

    /// Key of "worst first": failures, then by margin, then what was not compared.
    pub(crate) fn rank(&self, bars: &[f64]) -> f64 {
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
        "shapes": [{"coverage": "curves"}, {"coverage": "msdf"}, {"coverage": "curves"}],
        "warnings": [{"name": "MissingFont", "feature": "text"}]}"#;

    #[test]
    fn a_patch_is_an_image_besides_the_mips_or_a_warning_of_one() {
        let solid = Content::parse(INFO.as_bytes()).unwrap();
        assert!(solid.solid, "{solid:?}");
        assert_eq!(solid.coverage_text(), "curves 2, msdf 1");
        assert_eq!(solid.warning_text(), "text 1");
        for patched in [
            INFO.replace("MissingFont", "RasterPatch"),
            INFO.replace("[{}]", "[{}, {}]"),
            INFO.replace("\"mips\"", ""),
        ] {
            assert!(
                !Content::parse(patched.as_bytes()).unwrap().solid,
                "{patched}"
            );
        }
    }

    #[test]
    fn the_worst_zoom_is_the_one_furthest_below_its_bar() {
        let json = br#"{"zooms": [{"psnr_db": 41.0, "wrong_share": 0.0},
            {"psnr_db": 44.0, "wrong_share": 0.5}]}"#;
        let row = Row {
            zooms: Zoom::parse_all(json).unwrap(),
            ..Row::default()
        };
        assert_eq!(row.margin(&[]), Some((0, 41.0)));
        assert_eq!(row.margin(&[40.0, 45.0]), Some((1, -1.0)));
        assert!(row.misses(&[40.0, 45.0]) && !row.misses(&[40.0, 44.0]) && !row.misses(&[]));
        assert!(Zoom::parse_all(b"{\"zooms\": [{}]}").is_err());
    }
}
