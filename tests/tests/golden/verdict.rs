//! What was found of a case against what is expected.

use std::collections::BTreeMap;

use vtex_tests::parity::Parities;
use vtex_truth::texture::patch_cover;

use crate::look::Found;
use crate::table::Expected;

/// What a case is checked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Check {
    /// It bakes.
    Bake,
    /// The file is valid and reads back as it was.
    File,
    /// The whole canvas against the truth.
    At1x,
    /// A window at zoom 8.
    At8x,
    /// The mips alone, in their place on the canvas.
    Mips,
    /// The GPU gives the twin's answers, to the pictures' lookups and to random ones.
    Gpu,
    /// The warnings are those expected.
    Warnings,
    /// There are raster patches exactly where expected.
    Patch,
}

impl Check {
    const ALL: [(&'static str, Self); 8] = [
        ("bake", Self::Bake),
        ("file", Self::File),
        ("1x", Self::At1x),
        ("8x", Self::At8x),
        ("mips", Self::Mips),
        ("gpu", Self::Gpu),
        ("warnings", Self::Warnings),
        ("patch", Self::Patch),
    ];

    pub(crate) fn named(name: &str) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|(known, _)| *known == name)
            .map(|(_, check)| check)
    }

    fn name(self) -> &'static str {
        let mut all = Self::ALL.into_iter();
        all.find(|(_, known)| *known == self)
            .map_or("", |(name, _)| name)
    }
}

/// Outcome of a case.
#[derive(Debug)]
pub(crate) struct Verdict {
    pub(crate) chapter: String,
    pub(crate) name: String,
    /// PSNR at each zoom and of the mips, dB; NaN when it does not bake.
    pub(crate) psnr_db: [f64; 3],
    /// How far above its bounds the worst of them is, dB.
    pub(crate) margin_db: f64,
    /// How GPU and twin differ.
    pub(crate) parities: Parities,
    /// Checks that failed, with what was found.
    failed: BTreeMap<Check, String>,
    /// What of that, or of what did not fail, was not expected; empty when all is well.
    pub(crate) surprises: Vec<String>,
}

impl Verdict {
    pub(crate) fn new(chapter: &str, expected: &Expected, found: Result<&Found, &str>) -> Self {
        let mut failed = BTreeMap::new();
        let mut psnr_db = [f64::NAN; 3];
        let mut margin_db = f64::NEG_INFINITY;
        let mut parities = Parities::default();
        match found {
            Err(why) => _ = failed.insert(Check::Bake, why.to_owned()),
            Ok(found) => {
                let [whole, close] = &found.views;
                psnr_db = [whole.least_db(), close.least_db(), found.mips_db];
                let margins = psnr_db.iter().zip(expected.least_db);
                margin_db = margins
                    .map(|(db, bar)| db - bar)
                    .fold(f64::INFINITY, f64::min);
                parities = found.parities;
                failed = failures(expected, found, psnr_db);
            }
        }
        let surprises = surprises(expected, &failed);
        Self {
            chapter: chapter.to_owned(),
            name: expected.name.clone(),
            psnr_db,
            margin_db,
            parities,
            failed,
            surprises,
        }
    }

    /// Names of the checks that failed, `-` for none.
    pub(crate) fn failed_names(&self) -> String {
        let names: Vec<&str> = self.failed.keys().map(|check| check.name()).collect();
        match names.as_slice() {
            [] => "-".to_owned(),
            names => names.join(" "),
        }
    }

    /// `chapter::name  45.1  43.0  44.2  failed checks`.
    pub(crate) fn line(&self) -> String {
        let name = format!("{}::{}", self.chapter, self.name);
        let db = self.psnr_db.map(|db| format!("{db:5.1}")).join(" ");
        format!("{name:40} {db}  {}", self.failed_names())
    }
}

/// Checks that failed, with what was found.
fn failures(expected: &Expected, found: &Found, psnr_db: [f64; 3]) -> BTreeMap<Check, String> {
    let mut failed = BTreeMap::new();
    if let Some(why) = &found.invalid {
        failed.insert(Check::File, why.clone());
    }
    let checks = [Check::At1x, Check::At8x, Check::Mips];
    for ((db, least), check) in psnr_db.into_iter().zip(expected.least_db).zip(checks) {
        // Not `db < least`, which is false for NaN.
        let reached = db >= least;
        if !reached {
            failed.insert(check, format!("{db:.1} dB, below {least}"));
        }
    }
    if let Err(why) = found.parities.check() {
        failed.insert(Check::Gpu, why);
    }
    let provenance = found.file.provenance.as_ref();
    let warnings = provenance.map_or(&[][..], |provenance| &provenance.warnings);
    let mut warnings: Vec<String> = warnings
        .iter()
        .map(|warning| format!("{:?}:{}", warning.code, warning.feature))
        .collect();
    warnings.sort();
    warnings.dedup();
    if warnings != expected.warnings {
        failed.insert(Check::Warnings, format!("{warnings:?}"));
    }
    let patches = patch_cover(&found.file).count;
    if (patches > 0) != expected.patch {
        failed.insert(Check::Patch, format!("{patches} patches"));
    }
    failed
}

fn surprises(expected: &Expected, failed: &BTreeMap<Check, String>) -> Vec<String> {
    let fresh = failed
        .iter()
        .filter(|(check, _)| !expected.fails.contains(check))
        .map(|(check, found)| format!("{}: {found}", check.name()));
    let mended = expected
        .fails
        .iter()
        .filter(|check| !failed.contains_key(check))
        .map(|check| format!("{}: known to fail, but passes: drop the mark", check.name()));
    fresh.chain(mended).collect()
}
