//! Trees as entries of a list.

use vtex_format::{Entry, EntryKind, OPEN_ISOLATED};

use super::tree::{Clip, Compositing, Group, Node};

/// The entries of a list, none of them marked last or opaque; `places` are those of the records.
///
/// # Panics
/// When a list is longer than a branch can lead.
pub(super) fn entries(nodes: &[Node], places: &[u32]) -> Vec<Entry> {
    let mut writer = Writer {
        places,
        entries: Vec::new(),
        branches: Vec::new(),
        labels: Vec::new(),
    };
    writer.nodes(nodes);
    for &(from, label) in &writer.branches {
        let over = writer.labels[label] - from - 1;
        writer.entries[from].index = u32::try_from(over).expect("short lists");
    }
    writer.entries
}

struct Writer<'a> {
    places: &'a [u32],
    entries: Vec<Entry>,
    /// Entries that branch, and the labels they branch to.
    branches: Vec<(usize, usize)>,
    /// Where labels stand.
    labels: Vec<usize>,
}

impl Writer<'_> {
    fn push(&mut self, kind: EntryKind, index: u32, data: u32) {
        self.entries.push(Entry {
            kind,
            last: false,
            opaque: false,
            index,
            data,
        });
    }

    fn label(&mut self) -> usize {
        self.labels.push(0);
        self.labels.len() - 1
    }

    fn put(&mut self, label: usize) {
        self.labels[label] = self.entries.len();
    }

    /// Lists are front to back, trees back to front.
    fn nodes(&mut self, nodes: &[Node]) {
        for node in nodes.iter().rev() {
            match node {
                Node::Shape { outline, paint } => {
                    let paint = u32::try_from(*paint).expect("few paints");
                    match outline {
                        Some(record) => {
                            self.push(EntryKind::Curves, paint, self.places[*record]);
                        }
                        None => self.push(EntryKind::Full, paint, 0),
                    }
                }
                Node::Group(group) => self.group(group),
            }
        }
    }

    fn group(&mut self, group: &Group) {
        let end = self.label();
        if let Some(clip) = &group.clip {
            let body = self.label();
            self.clip(clip, body, end);
            self.put(body);
        }
        match &group.compositing {
            Some(how) => self.composite(how, &group.body),
            None => self.nodes(&group.body),
        }
        self.put(end);
    }

    /// Branches that fall through, to where `inside` will stand, or lead to a label.
    fn clip(&mut self, clip: &Clip, inside: usize, outside: usize) {
        if let Some(also) = &clip.also {
            let both = self.label();
            self.clip(also, both, outside);
            self.put(both);
        }
        for (place, part) in clip.parts.iter().enumerate() {
            let next = self.label();
            let last = place + 1 == clip.parts.len();
            let fails = if last { outside } else { next };
            if let Some(own) = &part.clip {
                let passes = self.label();
                self.clip(own, passes, fails);
                self.put(passes);
            }
            let to = if last { outside } else { inside };
            self.branches.push((self.entries.len(), to));
            self.push(EntryKind::Branch, 0, self.places[part.outline]);
            if let Some(branch) = self.entries.last_mut() {
                branch.opaque = !last;
            }
            self.put(next);
        }
    }

    fn composite(&mut self, how: &Compositing, body: &[Node]) {
        let end = self.label();
        for mask in &how.masks {
            self.push(EntryKind::Open, 0, OPEN_ISOLATED);
            self.nodes(&mask.body);
            self.branches.push((self.entries.len(), end));
            self.push(EntryKind::Mask, 0, mask.kind as u32);
        }
        let isolated = if how.isolated { OPEN_ISOLATED } else { 0 };
        self.push(EntryKind::Open, 0, isolated);
        self.nodes(body);
        let mode = how.mode as u32;
        self.push(EntryKind::Close, mode, how.opacity.to_bits());
        self.put(end);
    }
}
