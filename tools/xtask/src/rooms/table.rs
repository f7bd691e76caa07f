//! The figures of crates and rooms as a table.

use std::fmt::Write as _;

use super::arrows::Arrows;
use super::knots::{floors, knots};
use super::{Crate, check, size};

/// Figures of one crate.
struct Figures<'a> {
    files: usize,
    largest: usize,
    floors: usize,
    /// Files that import each other, each set in one room or across rooms.
    knots: Vec<Vec<&'a str>>,
    /// Pairs of files that import each other.
    pairs: usize,
    /// Sets of rooms that import each other.
    between: usize,
    public_lines: usize,
    comments_per_100: f64,
}

impl<'a> Figures<'a> {
    fn of(one: &'a Crate, files: &[String]) -> Self {
        let arrows = &one.arrows;
        let edges = arrows.edges();
        let count = arrows.files.len();
        let source = format!("{}/src", one.folder);
        let rooms = size::folders(files);
        let own = rooms.iter().filter(|(room, _)| room.starts_with(&source));
        let lines = || one.sources.values().flat_map(|text| text.lines());
        let comments = lines().filter(|line| is_comment(line)).count();
        let code = lines().filter(|line| is_code(line)).count();
        Self {
            files: one.sources.len(),
            largest: own.map(|(_, count)| *count).max().unwrap_or(0),
            floors: floors(count, &edges),
            knots: named(arrows, knots(count, &edges)),
            pairs: edges
                .iter()
                .filter(|(a, b)| a < b && edges.contains(&(*b, *a)))
                .count(),
            between: check::circles(arrows).len(),
            public_lines: lines()
                .filter(|line| line.trim_start().starts_with("pub "))
                .count(),
            comments_per_100: 100.0 * comments as f64 / code.max(1) as f64,
        }
    }
}

fn named(arrows: &Arrows, knots: Vec<Vec<usize>>) -> Vec<Vec<&str>> {
    let names = |knot: Vec<usize>| {
        knot.iter()
            .map(|&file| arrows.files[file].as_str())
            .collect()
    };
    knots.into_iter().map(names).collect()
}

/// A comment that is no documentation.
fn is_comment(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with("//") && !line.starts_with("///") && !line.starts_with("//!")
}

fn is_code(line: &str) -> bool {
    let line = line.trim_start();
    !line.is_empty() && !line.starts_with("//")
}

/// The whole table: a line a crate, what is in circles, a line a room.
pub(super) fn text(crates: &[Crate], files: &[String]) -> String {
    let mut text = String::from(
        "files: .rs below src/; largest: source files in its fullest folder; floors: longest chain \
         of imports,\nevery circle as one floor; pairs: two files that import each other; knots: \
         sets of files in import circles,\nand how many files are in them; between: sets of rooms \
         that import each other; pub: lines that start with it;\ncomments: // lines for 100 lines \
         of code\n\ncrate             files  largest  floors  pairs  knots     between   pub  comments\n",
    );
    let mut tangled = String::new();
    for one in crates {
        let figures = Figures::of(one, files);
        let inside: usize = figures.knots.iter().map(Vec::len).sum();
        let knots = format!("{} ({inside})", figures.knots.len());
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:<16} {:>6} {:>8} {:>7} {:>6}  {knots:<9} {:>7} {:>5} {:>9.1}",
            one.folder,
            figures.files,
            figures.largest,
            figures.floors,
            figures.pairs,
            figures.between,
            figures.public_lines,
            figures.comments_per_100
        );
        for knot in &figures.knots {
            let source = format!("{}/src/", one.folder);
            let short: Vec<&str> = knot
                .iter()
                .map(|file| file.strip_prefix(&source).unwrap_or(file))
                .collect();
            let _ = writeln!(tangled, "{source}: {}", short.join(", "));
        }
        for finding in check::circles(&one.arrows) {
            let _ = writeln!(tangled, "{}", finding.text);
        }
    }
    if !tangled.is_empty() {
        let _ = writeln!(text, "\ncircles\n{}", tangled.trim_end());
    }
    text += "\nroom                                     source files\n";
    for (room, count) in size::folders(files) {
        let _ = writeln!(text, "{room:<40} {count:>4}");
    }
    text
}
