//! What two bakes of a drawing have in common.

use std::collections::BTreeMap;

use super::table::{Name, Sections};

/// Sections that say which program baked and which shader goes with it; they may change.
pub(crate) const EXEMPT: [&str; 3] = ["SPEC", "SHDR", "PROV"];

/// How two bakes of one file compare.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Comparison {
    /// All sections are the same.
    Same,
    /// Both refused the file with this exit code.
    Refused(i32),
    /// Sections that differ, and how.
    Sections(Vec<(String, String)>),
    /// No comparison of sections: the reason.
    Broken(String),
}

/// All differences by tag: of the section, or of provenance beyond its version.
#[derive(Debug, Default)]
pub(crate) struct Totals {
    files: usize,
    same: usize,
    refused: BTreeMap<i32, usize>,
    broken: usize,
    /// Files and sections.
    by_tag: BTreeMap<String, [usize; 2]>,
}

impl Comparison {
    pub(crate) fn new(old: &Sections, new: &Sections) -> Self {
        let mut names: Vec<&Name> = old.keys().chain(new.keys()).collect();
        names.sort();
        names.dedup();
        let mut found = Vec::new();
        for name in names {
            let how = match (old.get(name), new.get(name)) {
                (Some(a), Some(b)) if a == b => continue,
                (Some(a), Some(b)) if a.raw_bytes() == b.raw_bytes() => "other bytes".to_owned(),
                (Some(a), Some(b)) => format!("{} bytes, now {}", a.raw_bytes(), b.raw_bytes()),
                (Some(_), None) => "gone".to_owned(),
                (None, _) => "new".to_owned(),
            };
            found.push((name.tag.clone(), format!("{name}: {how}")));
        }
        if found.is_empty() {
            Self::Same
        } else {
            Self::Sections(found)
        }
    }

    /// Whether sections of this tag differ.
    pub(crate) fn has(&self, tag: &str) -> bool {
        matches!(self, Self::Sections(found) if found.iter().any(|(other, _)| other == tag))
    }

    /// Adds a difference that no section table shows.
    pub(crate) fn add(&mut self, tag: &str, text: &str) {
        if let Self::Sections(found) = self {
            found.push((tag.to_owned(), format!("{tag}: {text}")));
        }
    }

    /// Whether a change that leaves bakes alone can have made this.
    pub(crate) fn is_allowed(&self) -> bool {
        match self {
            Self::Same | Self::Refused(_) => true,
            Self::Sections(found) => found.iter().all(|(tag, _)| EXEMPT.contains(&tag.as_str())),
            Self::Broken(_) => false,
        }
    }

    /// One line, of each tag the first section that differs; `None` when none does.
    pub(crate) fn text(&self) -> Option<String> {
        match self {
            Self::Same | Self::Refused(_) => None,
            Self::Sections(found) => {
                let mut by_tag: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
                for (tag, text) in found {
                    by_tag.entry(tag).or_default().push(text);
                }
                let first = |texts: Vec<&str>| match texts[..] {
                    [first, _, ..] => format!("{first}, and {} more", texts.len() - 1),
                    _ => texts.concat(),
                };
                let texts: Vec<String> = by_tag.into_values().map(first).collect();
                Some(texts.join("; "))
            }
            Self::Broken(why) => Some(why.clone()),
        }
    }
}

impl Totals {
    pub(crate) fn add(&mut self, comparison: &Comparison) {
        self.files += 1;
        match comparison {
            Comparison::Same => self.same += 1,
            Comparison::Refused(code) => *self.refused.entry(*code).or_default() += 1,
            Comparison::Broken(_) => self.broken += 1,
            Comparison::Sections(found) => {
                let mut tags: Vec<&String> = found.iter().map(|(tag, _)| tag).collect();
                tags.sort();
                for tag in &tags {
                    self.by_tag.entry((*tag).clone()).or_default()[1] += 1;
                }
                tags.dedup();
                for tag in tags {
                    self.by_tag.entry(tag.clone()).or_default()[0] += 1;
                }
            }
        }
    }

    /// Whether some file was baked by both, so that the rest means something.
    pub(crate) fn is_empty(&self) -> bool {
        self.files == self.refused.values().sum::<usize>() + self.broken
    }

    pub(crate) fn text(&self) -> String {
        let refused: usize = self.refused.values().sum();
        let differ = self.files - self.same - refused - self.broken;
        let mut text = format!(
            "{} files: {} identical, {differ} differ, {} without comparison, {refused} refused by both",
            self.files, self.same, self.broken
        );
        for (code, files) in &self.refused {
            text += &format!("\n  exit code {code}: {files} files");
        }
        for (tag, [files, sections]) in &self.by_tag {
            let allowed = EXEMPT.contains(&tag.as_str());
            let verdict = if allowed { "allowed" } else { "NOT ALLOWED" };
            text += &format!("\n  {tag}: {sections} differ in {files} files, {verdict}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bakes::table::{sections, tests::file};

    fn compare(old: &[(&str, u8, u8)], new: &[(&str, u8, u8)]) -> Comparison {
        let [old, new] = [old, new].map(|listed| sections(&file(listed)).unwrap());
        Comparison::new(&old, &new)
    }

    #[test]
    fn only_some_sections_may_differ() {
        let old = [("META", 0, 1), ("SPEC", 0, 1), ("TILE", 0, 1)];
        assert_eq!(compare(&old, &old), Comparison::Same);
        let spec = compare(&old, &[old[0], ("SPEC", 0, 2), old[2]]);
        assert!(spec.is_allowed(), "{spec:?}");
        assert_eq!(spec.text().as_deref(), Some("SPEC: other bytes"));
        let tile = compare(&old, &[old[0], old[1], ("TILE", 0, 2), ("TILE", 0, 3)]);
        assert!(!tile.is_allowed(), "{tile:?}");
        assert_eq!(
            tile.text().as_deref(),
            Some("TILE 0: other bytes, and 1 more")
        );
    }

    #[test]
    fn totals_count_files_and_sections() {
        let mut totals = Totals::default();
        totals.add(&Comparison::Refused(5));
        assert!(totals.is_empty(), "{totals:?}");
        totals.add(&Comparison::Same);
        totals.add(&compare(&[("TILE", 0, 1), ("TILE", 1, 1)], &[]));
        assert!(!totals.is_empty(), "{totals:?}");
        assert_eq!(
            totals.text(),
            "3 files: 1 identical, 1 differ, 0 without comparison, 1 refused by both\n  \
             exit code 5: 1 files\n  TILE: 2 differ in 1 files, NOT ALLOWED"
        );
    }
}
