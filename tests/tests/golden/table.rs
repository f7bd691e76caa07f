//! What is expected of the cases of a chapter.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::verdict::Check;

/// Name of a chapter's table.
pub(crate) const FILE: &str = "cases.tsv";

/// Columns, separated by tabs. Lines that begin with `#` are remarks.
const HEAD: &str = "case\t1x\t8x\twarnings\tpatch\tfails\twhy";

/// A reason is more than a word.
const MIN_REASON_BYTES: usize = 12;

/// What one case has to do.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Expected {
    /// Name of the drawing, without `.svg`.
    pub(crate) name: String,
    /// Least PSNR of the whole canvas and of a window at zoom 8, dB; `-` in the table where resvg's
    /// own picture is wrong, for which there is a reason too.
    pub(crate) least_db: [f64; 2],
    /// `Code:feature` of every warning, sorted; `-` in the table for none.
    pub(crate) warnings: Vec<String>,
    /// `yes` or `no`: whether there are raster patches.
    pub(crate) patch: bool,
    /// Checks that are known to fail, `-` for none. They must fail, and no others.
    pub(crate) fails: BTreeSet<Check>,
}

/// Reads the table of a chapter.
///
/// # Panics
/// When it breaks a rule, or does not name the drawings beside it, each once.
pub(crate) fn read(folder: &Path) -> Vec<Expected> {
    let path = folder.join(FILE);
    let text = std::fs::read_to_string(&path).unwrap();
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    assert_eq!(lines.next(), Some(HEAD), "{}", path.display());
    let cases: Vec<Expected> = lines
        .map(|line| parse(line).unwrap_or_else(|why| panic!("{}: {line}: {why}", path.display())))
        .collect();
    let mut named: Vec<String> = cases.iter().map(|case| case.name.clone()).collect();
    named.sort();
    assert_eq!(named, drawings(folder), "{}", path.display());
    cases
}

/// Puts into the column `fails` what did fail, for the cases that `failed` names. Reasons stay with
/// what fails still; a new one is to be written by hand.
pub(crate) fn write_marks(folder: &Path, failed: &BTreeMap<&str, String>) {
    let path = folder.join(FILE);
    let marked = |line: &str| {
        let mut fields: Vec<&str> = line.split('\t').collect();
        let no_truth = fields.get(1..3).is_some_and(|bars| bars.contains(&"-"));
        if let ([name, .., fails, why], true) = (fields.as_mut_slice(), line != HEAD)
            && let Some(now) = failed.get(name)
        {
            *fails = now;
            *why = match (now.as_str(), *why) {
                ("-", _) if !no_truth => "-",
                (_, "-") => "?",
                (_, why) => why,
            };
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
    let &[name, at_1x, at_8x, warnings, patch, fails, why] = fields.as_slice() else {
        return Err("seven fields are wanted");
    };
    let db = |text: &str| match text {
        "-" => Ok(f64::NEG_INFINITY),
        text => text.parse().map_err(|_| "no number of dB"),
    };
    let mut warnings = words(warnings);
    warnings.sort();
    let fails = words(fails);
    let fails: Option<BTreeSet<Check>> = fails.iter().map(|name| Check::named(name)).collect();
    let fails = fails.ok_or("no such check")?;
    let excused = !fails.is_empty() || [at_1x, at_8x].contains(&"-");
    if excused == (why == "-") || excused && why.len() < MIN_REASON_BYTES {
        return Err("a known failure has a reason, and what is none has not");
    }
    Ok(Expected {
        name: name.to_owned(),
        least_db: [db(at_1x)?, db(at_8x)?],
        warnings,
        patch: match patch {
            "yes" => true,
            "no" => false,
            _ => return Err("yes or no"),
        },
        fails,
    })
}

/// Words separated by blanks; none for `-`.
fn words(field: &str) -> Vec<String> {
    let words = field.split(' ').filter(|&word| word != "-");
    words.map(str::to_owned).collect()
}

#[test]
fn lines_are_read_strictly() {
    let good =
        parse("blur\t35\t34.5\tRasterPatch:filter\tyes\tgpu 8x\tneeds a better blur").unwrap();
    assert_eq!(good.least_db, [35.0, 34.5]);
    assert_eq!(good.warnings, ["RasterPatch:filter"]);
    assert!(good.patch && good.fails.len() == 2, "{good:?}");
    let plain = parse("rect\t40\t38\t-\tno\t-\t-").unwrap();
    assert!(
        plain.warnings.is_empty() && plain.fails.is_empty(),
        "{plain:?}"
    );
    let blind = parse("deep\t40\t-\t-\tno\t-\tresvg leaves it out").unwrap();
    assert_eq!(blind.least_db, [40.0, f64::NEG_INFINITY]);
    for bad in [
        "deep\t40\t-\t-\tno\t-\t-",
        "rect\t40\t38\t-\tno\t-",
        "rect\t40\tmany\t-\tno\t-\t-",
        "rect\t40\t38\t-\tperhaps\t-\t-",
        "rect\t40\t38\t-\tno\tsound\tno such check",
        "rect\t40\t38\t-\tno\tgpu\t-",
        "rect\t40\t38\t-\tno\t-\ta reason for nothing",
    ] {
        assert!(parse(bad).is_err(), "{bad}");
    }
}
