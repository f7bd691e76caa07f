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
    if named != drawn {
        return Err(format!("{place} names {named:?}, beside it lie {drawn:?}"));
    }
    unique_titles(folder, &drawn)?;
    Ok(cases)
}

/// An error where a drawing has no title, or that of another one of the chapter.
fn unique_titles(folder: &Path, names: &[String]) -> Result<(), String> {
    let mut titles: BTreeMap<String, &str> = BTreeMap::new();
    for name in names {
        let path = folder.join(format!("{name}.svg"));
        let svg = std::fs::read_to_string(&path).map_err(|error| error.to_string())?;
        let title = title(&svg).ok_or_else(|| format!("{} has no <title>", path.display()))?;
        if let Some(other) = titles.insert(title.to_lowercase(), name) {
            return Err(format!("{other} and {name} have the same title {title:?}"));
        }
    }
    Ok(())
}

/// Text of the first title; `None` without one, or where it is empty.
fn title(svg: &str) -> Option<&str> {
    let (_, rest) = svg.split_once("<title>")?;
    let (title, _) = rest.split_once("</title>")?;
    Some(title.trim()).filter(|title| !title.is_empty())
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
        text => match text.parse() {
            Ok(db) if f64::is_finite(db) => Ok(db),
            _ => Err("no number of dB"),
        },
    }
}

/// Words separated by blanks; none for `-`.
fn words(field: &str) -> Vec<String> {
    let words = field.split(' ').filter(|&word| word != "-");
    words.map(str::to_owned).collect()
}

/// A trial of its own: this suite has no `#[test]`.
#[expect(
    clippy::missing_assert_message,
    reason = "a test, whose values say what is wrong"
)]
pub(crate) fn rows_are_read_strictly() {
    let good = "blur\t35\t34.5\t40\tRasterPatch:filter\tyes\tgpu 8x\t-\tneeds a better blur";
    let good = parse(good).unwrap();
    assert_eq!(good.least_db, [35.0, 34.5, 40.0]);
    assert_eq!(good.warnings, ["RasterPatch:filter"]);
    assert!(good.patch && good.fails.len() == 2, "{good:?}");
    let plain = parse("rect\t40\t38\t40\t-\tno\t-\tno-fonts\t-").unwrap();
    let empty = plain.warnings.is_empty() && plain.fails.is_empty();
    assert!(empty && plain.fonts == Fonts::None, "{plain:?}");
    let blind = parse("deep\t40\t-\t40\t-\tno\t-\t-\tresvg leaves it out").unwrap();
    assert_eq!(blind.least_db, [40.0, f64::NEG_INFINITY, 40.0]);
    for bad in [
        "deep\t40\t-\t40\t-\tno\t-\t-\t-",
        "low\t40\t38\t39\t-\tno\t-\t-\t-",
        "low\t40\t38\t39\t-\tno\t-\t-\ttoo short",
        "rect\t40\t38\t40\t-\tno\t-\t-",
        "rect\t40\tmany\t40\t-\tno\t-\t-\t-",
        "rect\t40\t38\tNaN\t-\tno\t-\t-\t-",
        "rect\t40\t38\t40\t-\tperhaps\t-\t-\t-",
        "rect\t40\t38\t40\t-\tno\tsound\t-\tno such check",
        "rect\t40\t38\t40\t-\tno\t-\tno-colours\t-",
        "rect\t40\t38\t40\t-\tno\tgpu\t-\t-",
        "rect\t40\t38\t40\t-\tno\t-\t-\ta reason for nothing",
    ] {
        assert!(parse(bad).is_err(), "{bad}");
    }
    assert_eq!(title("<svg><title> one </title>"), Some("one"));
    assert_eq!(title("<svg><title></title>"), None);
}
