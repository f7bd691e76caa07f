//! Layouts that may change only together with their version.
//!
//! A crate describes its layout as text: names, offsets, types, values. Beside its tests lie
//! `versions.tsv`, a row `version, hash of the text` for every version there was, and the text of
//! the newest, so that a failure shows which line changed. A row is never replaced: a changed
//! layout needs a new version, and a new version a new row.

use std::path::Path;

/// A layout and its version.
#[derive(Clone, Copy, Debug)]
pub struct Frozen<'a> {
    /// Folder with `versions.tsv` and `layout.txt`.
    pub folder: &'a Path,
    /// Where the version is defined, for messages.
    pub constant: &'a str,
    /// Its value.
    pub version: &'a str,
    /// The layout.
    pub text: &'a str,
}

/// What to do about a layout.
#[derive(Debug, PartialEq, Eq)]
enum Verdict {
    Same,
    /// A version without a row.
    New,
    /// A message.
    Wrong(String),
}

impl Frozen<'_> {
    /// Compares the layout with the row of its version. With `VTEX_BLESS=1` a version without a row
    /// gets one.
    ///
    /// # Panics
    /// When the layout changed without its version, when a version has no row, or when the files
    /// cannot be read or written.
    pub fn check(self) {
        let table = self.folder.join("versions.tsv");
        let rows = std::fs::read_to_string(&table).unwrap_or_default();
        let blessed = self.folder.join("layout.txt");
        let before = std::fs::read_to_string(&blessed).unwrap_or_default();
        let bless = std::env::var("VTEX_BLESS").is_ok_and(|value| value == "1");
        match self.judge(&rows, &before) {
            Verdict::Same => {}
            Verdict::New if bless => {
                let rows = format!("{rows}{}\t{}\n", self.version, hash(self.text));
                let write = std::fs::create_dir_all(self.folder)
                    .and_then(|()| std::fs::write(&table, rows))
                    .and_then(|()| std::fs::write(&blessed, self.text));
                write.unwrap_or_else(|error| panic!("{}: {error}", self.folder.display()));
            }
            Verdict::New => panic!(
                "version {} of {} has no row in {}: run this test once with VTEX_BLESS=1 and commit \
                 what it writes",
                self.version,
                self.constant,
                table.display()
            ),
            Verdict::Wrong(message) => panic!("{message}"),
        }
    }

    fn judge(self, rows: &str, before: &str) -> Verdict {
        let (version, constant) = (self.version, self.constant);
        let rows: Vec<(&str, &str)> = rows
            .lines()
            .filter_map(|row| row.split_once('\t'))
            .collect();
        let Some(at) = rows.iter().position(|(known, _)| *known == version) else {
            return Verdict::New;
        };
        if at + 1 != rows.len() {
            return Verdict::Wrong(format!(
                "{constant} is {version}, an older version than the last row"
            ));
        }
        if rows[at].1 != hash(self.text) {
            let change = first_change(before, self.text);
            return Verdict::Wrong(format!(
                "the layout changed, but {constant} is still {version}: what was made with the old \
                 layout would be misread.\n{change}\nUndo the change; or raise {constant}, run this \
                 test once with VTEX_BLESS=1 and commit the row that it adds. No row is ever replaced."
            ));
        }
        match before == self.text {
            true => Verdict::Same,
            false => {
                Verdict::Wrong("layout.txt is not the layout that its row's hash is of".to_owned())
            }
        }
    }
}

fn first_change(before: &str, now: &str) -> String {
    let mut lines = before.lines().zip(now.lines()).enumerate();
    let changed = lines.find(|(_, (before, now))| before != now);
    let (before_count, now_count) = (before.lines().count(), now.lines().count());
    match changed {
        Some((i, (before, now))) => format!("line {}: {before:?} became {now:?}", i + 1),
        None => format!("{before_count} lines became {now_count}"),
    }
}

/// FNV-1a of 64 bits: it guards against oversight, not against intent.
fn hash(text: &str) -> String {
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    format!("{:016x}", text.bytes().fold(0xcbf2_9ce4_8422_2325, step))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judge(version: &str, text: &str, rows: &str, before: &str) -> Verdict {
        let frozen = Frozen {
            folder: Path::new(""),
            constant: "ABI",
            version,
            text,
        };
        frozen.judge(rows, before)
    }

    #[test]
    fn a_change_needs_a_version_and_a_version_a_row() {
        let rows = format!("1\t{}\n", hash("a 0\nb 4\n"));
        assert_eq!(judge("1", "a 0\nb 4\n", &rows, "a 0\nb 4\n"), Verdict::Same);
        let changed = judge("1", "a 0\nb 8\n", &rows, "a 0\nb 4\n");
        let Verdict::Wrong(message) = changed else {
            panic!("{changed:?}");
        };
        assert!(
            message.contains("line 2: \"b 4\" became \"b 8\""),
            "{message}"
        );
        assert_eq!(judge("2", "a 0\nb 8\n", &rows, "a 0\nb 4\n"), Verdict::New);
        let two = format!("{rows}2\t{}\n", hash("a 0\nb 8\n"));
        assert_eq!(judge("2", "a 0\nb 8\n", &two, "a 0\nb 8\n"), Verdict::Same);
        assert!(
            matches!(judge("1", "a 0\nb 4\n", &two, ""), Verdict::Wrong(_)),
            "going back"
        );
        assert!(
            matches!(judge("2", "a 0\nb 8\n", &two, "edited"), Verdict::Wrong(_)),
            "edited"
        );
    }

    #[test]
    fn the_hash_is_fnv_1a() {
        assert_eq!(hash(""), "cbf29ce484222325");
        assert_eq!(hash("a"), "af63dc4c8601ec8c");
    }
}
