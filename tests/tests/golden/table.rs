//! What is expected of the cases of a chapter.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::verdict::Check;

/// Name of a chapter's table.
pub(crate) const FILE: &str = "cases.tsv";

/// Columns, separated by tabs: `tests/data/svg/README.md` says what they mean.
const HEAD: &str = "case\t1x\t8x\tmips\twarnings\tpatch\tfails\toptions\twhy";

/// A reason is more than a word.
const MIN_REASON_BYTES: usize = 12;

/// Least PSNR that needs no reason: of the whole canvas, of a window at zoom 8, of the mips, dB.
/// The noise of 64 samples a pixel leaves about 45 dB on drawings of this kind.
const USUAL_DB: [f64; 3] = [40.0, 38.0, 40.0];

/// What one case has to do.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Expected {
    /// Name of the drawing, without `.svg`.
    pub(crate) name: String,
    /// Least PSNR of the whole canvas, of a window at zoom 8 and of the mips, dB; `-` in the table
    /// where resvg's own picture is wrong.
    pub(crate) least_db: [f64; 3],
    /// `Code:feature` of every warning, sorted; `-` in the table for none.
    pub(crate) warnings: Vec<String>,
    /// `yes` or `no`: whether there are raster patches.
    pub(crate) patch: bool,
    /// Checks that are known to fail, `-` for none. They must fail, and no others.
    pub(crate) fails: BTreeSet<Check>,
    /// `no-fonts` in the table for none.
    pub(crate) fonts: Fonts,
}

/// What text is set with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fonts {
    /// The fonts of the tests.
    Library,
    /// No font at all.
    None,
}

/// Reads the table of a chapter; an error when it breaks a rule, or does not name the drawings
/// beside it, each once.
pub(crate) fn read(folder: &Path) -> Result<Vec<Expected>, String> {
    let path = folder.join(FILE);
    let place = path.display();
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{place}: {error}"))?;
    let mut lines = text.lines();
    if lines.next() != Some(HEAD) {
        return Err(format!("{place}: the first line is not {HEAD:?}"));
    }
    let row = |line| parse(line).map_err(|why| format!("{place}: {line}: {why}"));
    let cases = lines.map(row).collect::<Result<Vec<Expected>, String>>()?;
    let mut named: Vec<String> = cases.iter().map(|case| case.name.clone()).collect();
    named.sort();
    let drawn = drawings(folder);
    match named == drawn {
        true => Ok(cases),
        false => Err(format!("{place} names {named:?}, beside it lie {drawn:?}")),
    }
}

/// Puts into the column `fails` what did fail, for the cases that `failed` names. A reason stays;
/// where one is wanted now, `?` stands in its place until a person writes it.
pub(crate) fn write_marks(folder: &Path, failed: &BTreeMap<&str, String>) {
    let path = folder.join(FILE);
    let marked = |line: &str| {
        let mut fields: Vec<&str> = line.split('\t').collect();
        if let [name, .., fails, _, why] = fields.as_mut_slice()
            && let Some(now) = failed.get(name)
        {
            *fails = now;
            if now != "-" && *why == "-" {
                *why = "?";
            }
        }
        fields.join("\t") + "\n"
    };
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.lines().map(marked).collect::<String>()).unwrap();
}

fn drawings(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter_map(|name| Some(name.strip_suffix(".svg")?.to_owned()))
        .collect();
    names.sort();
    names
}

fn parse(line: &str) -> Result<Expected, &'static str> {
    let fields: Vec<&str> = line.split('\t').collect();
    let &[
        name,
        at_1x,
        at_8x,
        mips,
        warnings,
        patch,
        fails,
        options,
        why,
    ] = fields.as_slice()
    else {
        return Err("nine fields are wanted");
    };
    let least_db = [bound(at_1x)?, bound(at_8x)?, bound(mips)?];
    let mut warnings = words(warnings);
    warnings.sort();
    let fails = words(fails);
    let fails: Option<BTreeSet<Check>> = fails.iter().map(|name| Check::named(name)).collect();
    let fails = fails.ok_or("no such check")?;
    let low = least_db
        .iter()
        .zip(USUAL_DB)
        .any(|(least, usual)| *least < usual);
    let excused = !fails.is_empty() || low;
    if excused && why.len() < MIN_REASON_BYTES {
        return Err("a known failure, a lower bound and no bound have a reason");
    }
    if !excused && why != "-" {
        return Err("a reason, but nothing to excuse");
    }
    Ok(Expected {
        name: name.to_owned(),
        least_db,
        warnings,
        patch: match patch {
            "yes" => true,
            "no" => false,
            _ => return Err("yes or no"),
        },
        fails,
        fonts: match options {
            "-" => Fonts::Library,
            "no-fonts" => Fonts::None,
            _ => return Err("no such option"),
        },
    })
}

fn bound(text: &str) -> Result<f64, &'static str> {
    match text {
        "-" => Ok(f64::NEG_INFINITY),
        text => text.parse().map_err(|_| "no number of dB"),
    }
}

/// Words separated by blanks; none for `-`.
fn words(field: &str) -> Vec<String> {
    let words = field.split(' ').filter(|&word| word != "-");
    words.map(str::to_owned).collect()
}
