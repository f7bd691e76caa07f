//! The commands of stored lists: each list ends, and nothing in it leads beyond it or names what does not
//! exist.

use std::collections::BTreeMap;

use vtex_format::{
    BlendMode, Features, MAX_BLEND_DEPTH, MAX_ENTRIES_PER_CELL, SHALLOW_BLEND_DEPTH, VtexFile,
};

use crate::layout::{cell, cmd, entry_paints};

/// What the commands of a file may name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tables {
    paints: usize,
    images: usize,
    tiles: usize,
    /// What the text that walks the lists has code for.
    features: u32,
}

/// Where a walk is in a list: inside these groups and masks, outermost first. Each has a number of its
/// own, so that a branch out of one is found.
#[derive(Clone, Debug, Default)]
struct Walk {
    open: Vec<usize>,
    /// Commands that are branched to, and the innermost group that each must lie in.
    targets: BTreeMap<usize, Option<usize>>,
    has_groups: bool,
}

impl Tables {
    pub(super) fn new(file: &VtexFile, features: u32) -> Self {
        let side = file.meta.grid.texels_per_cell as usize + 1;
        Self {
            paints: file.paints.len(),
            images: file.images.len(),
            tiles: file.tiles.len() / (4 * side * side),
            features,
        }
    }

    /// The words of cells with the lists that `words` hold one behind the other.
    pub(super) fn lists(&self, words: &[u32]) -> Option<Vec<u32>> {
        let (mut rest, []) = words.as_chunks::<4>() else {
            return None;
        };
        if rest.len() > cell::PAYLOAD_MASK as usize {
            return None;
        }
        let mut lists = Vec::new();
        let mut walk = Walk::default();
        let mut first = 0;
        while !rest.is_empty() {
            let length = self.list(rest, &mut walk)?;
            let tag = match walk.has_groups {
                true => cell::GROUPS,
                false => cell::LIST,
            };
            lists.push(tag << cell::TAG_SHIFT | first);
            first += u32::try_from(length).ok()?;
            rest = &rest[length..];
        }
        Some(lists)
    }

    /// The length of the first list.
    fn list(&self, commands: &[[u32; 4]], walk: &mut Walk) -> Option<usize> {
        walk.has_groups = false;
        let (mut entries, mut begins) = (0, true);
        for (at, command) in commands.iter().take(cmd::LIMIT as usize).enumerate() {
            if begins && !walk.arrive(at) {
                return None;
            }
            let tag = command[3];
            begins = tag & cmd::END_BIT != 0;
            if !begins {
                // Any words make a segment.
                if tag & cmd::LAST_BIT != 0 {
                    return None;
                }
                continue;
            }
            entries += 1;
            if entries > MAX_ENTRIES_PER_CELL || !self.entry(at, command, walk) {
                return None;
            }
            if tag & cmd::LAST_BIT != 0 {
                return walk.is_over().then_some(at + 1);
            }
        }
        None
    }

    fn has(&self, feature: u32) -> bool {
        self.features & feature != 0
    }

    /// Whether an entry with this last command names what exists.
    fn entry(&self, at: usize, command: &[u32; 4], walk: &mut Walk) -> bool {
        let tag = command[3];
        if tag & cmd::CONTROL_BIT != 0 {
            return self.control(at, command, walk);
        }
        let index = (tag & cmd::INDEX_MASK) as usize;
        let known = match tag & cmd::KIND_MASK {
            cmd::IMAGE => self.has(Features::IMAGES) && index < self.images,
            cmd::MSDF => {
                let tile = command[0] as usize;
                self.has(Features::MSDF) && index < self.paints && tile < self.tiles
            }
            cmd::CURVES => self.has(Features::CURVES) && self.has_paints(tag, walk),
            _ => index < self.paints,
        };
        known && self.has(Features::LISTS)
    }

    /// Whether there are the paints of a curve entry. Two of them are for the end of a list without groups.
    fn has_paints(&self, tag: u32, walk: &Walk) -> bool {
        let both = tag & cmd::BACKDROP_BIT != 0;
        let may_be_both = tag & cmd::LAST_BIT != 0 && !walk.has_groups;
        entry_paints(tag).all(|paint| (paint as usize) < self.paints) && (!both || may_be_both)
    }

    fn control(&self, at: usize, command: &[u32; 4], walk: &mut Walk) -> bool {
        let tag = command[3];
        if tag & cmd::KIND_MASK == cmd::CURVES {
            return self.has(Features::CLIPS) && walk.branch(at, tag);
        }
        let op = tag & cmd::CONTROL_MASK;
        if op == cmd::JUMP {
            return self.has(Features::CLIPS) && walk.branch(at, tag);
        }
        walk.has_groups = true;
        if !self.has(Features::GROUPS) {
            return false;
        }
        let depth = match self.has(Features::DEEP_GROUPS) {
            true => MAX_BLEND_DEPTH,
            false => SHALLOW_BLEND_DEPTH,
        };
        match op {
            cmd::OPEN => {
                walk.open.push(at);
                walk.open.len() <= depth as usize
            }
            cmd::CLOSE => {
                let normal = command[1] == BlendMode::Normal as u32;
                (normal || self.has(Features::BLENDS)) && walk.open.pop().is_some()
            }
            cmd::MASK => walk.open.pop().is_some() && walk.branch(at, tag),
            _ => false,
        }
    }
}

impl Walk {
    /// Whether an entry may begin here.
    fn arrive(&mut self, at: usize) -> bool {
        if at == 0 {
            self.open.clear();
            self.targets.clear();
        }
        let inside = self.open.last().copied();
        let target = match self.targets.is_empty() {
            true => None,
            false => self.targets.remove(&at),
        };
        target.is_none_or(|group| group == inside)
    }

    /// Whether the command at `at` may branch: forward, to an entry in the same group. That there is such
    /// an entry shows later.
    fn branch(&mut self, at: usize, tag: u32) -> bool {
        let inside = self.open.last().copied();
        match (tag & cmd::INDEX_MASK) as usize {
            0 => inside.is_none(),
            over => *self.targets.entry(at + 1 + over).or_insert(inside) == inside,
        }
    }

    /// Whether the list may end: no group is open, and all targets were entries of it.
    fn is_over(&self) -> bool {
        self.open.is_empty() && self.targets.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const END: u32 = cmd::END_BIT;
    const LAST: u32 = END | cmd::LAST_BIT;
    const CONTROL: u32 = END | cmd::CONTROL_BIT;
    const BRANCH: u32 = CONTROL | cmd::CURVES;

    const TABLES: Tables = Tables {
        paints: 3,
        images: 2,
        tiles: 5,
        features: Features::ALL & !Features::DEEP_GROUPS,
    };

    fn lists(tables: Tables, commands: &[[u32; 4]]) -> Option<Vec<u32>> {
        tables.lists(commands.as_flattened())
    }

    fn tags(tags: &[u32]) -> Vec<[u32; 4]> {
        tags.iter().map(|&tag| [0, 0, 0, tag]).collect()
    }

    #[test]
    fn lists_follow_each_other() {
        let list = cell::LIST << cell::TAG_SHIFT;
        let groups = cell::GROUPS << cell::TAG_SHIFT;
        let commands = tags(&[
            // A segment and its end, then the next list.
            7,
            LAST | cmd::CURVES | 2,
            // Two branches to the last entry, over one.
            BRANCH | 2,
            CONTROL | cmd::JUMP | 1,
            END,
            LAST,
            // A mask that may pass over its group, which ends the list.
            CONTROL | cmd::OPEN,
            END,
            CONTROL | cmd::MASK,
            CONTROL | cmd::OPEN,
            LAST | CONTROL | cmd::CLOSE,
        ]);
        assert_eq!(
            lists(TABLES, &commands),
            Some(vec![list, list | 2, groups | 6])
        );
        assert_eq!(lists(TABLES, &[]), Some(Vec::new()));
        assert_eq!(
            TABLES.lists(&[0, 0, 0, LAST, 0]),
            None,
            "a part of a command"
        );
    }

    #[test]
    fn what_leads_out_of_a_list_is_refused() {
        let open = CONTROL | cmd::OPEN;
        let close = CONTROL | cmd::CLOSE;
        for (what, commands) in [
            ("no end", tags(&[END])),
            ("an end in a segment", tags(&[cmd::LAST_BIT, LAST])),
            ("no command behind a branch", tags(&[LAST | BRANCH | 1])),
            ("a target in the next list", tags(&[BRANCH | 1, LAST, LAST])),
            (
                "a target inside an entry",
                tags(&[BRANCH | 2, END, 0, LAST]),
            ),
            ("a group without end", tags(&[LAST | open])),
            ("an end without group", tags(&[LAST | close])),
            ("a mask without group", tags(&[LAST | CONTROL | cmd::MASK])),
            (
                "three open groups",
                tags(&[open, open, open, close, close, LAST | close]),
            ),
            ("into a group", tags(&[BRANCH | 1, open, END, LAST | close])),
            ("out of a group", tags(&[open, BRANCH | 1, close, LAST])),
            (
                "out of a group to the end",
                tags(&[open, BRANCH, LAST | close]),
            ),
            (
                "from group to group",
                tags(&[open, BRANCH | 2, close, open, LAST | close]),
            ),
            ("a control MSDF", tags(&[LAST | CONTROL | cmd::MSDF])),
            (
                "too many entries",
                tags(&[vec![END; 4_096], vec![LAST]].concat()),
            ),
            (
                "too many commands",
                tags(&[vec![0; 32_768], vec![LAST]].concat()),
            ),
        ] {
            assert_eq!(lists(TABLES, &commands), None, "{what}");
        }
        let most = [tags(&[0; 32_767]), tags(&[LAST])].concat();
        assert!(lists(TABLES, &most).is_some());
        let most = [tags(&[END; 4_095]), tags(&[LAST])].concat();
        assert!(lists(TABLES, &most).is_some());
    }

    #[test]
    fn entries_name_what_exists_and_what_the_text_has_code_for() {
        for (tag, data, feature, is_known) in [
            (2, 0, Features::LISTS, true),
            (3, 0, Features::LISTS, false),
            (cmd::CURVES | 2, 0, Features::CURVES, true),
            (cmd::CURVES | 3, 0, Features::CURVES, false),
            (cmd::IMAGE | 1, 0, Features::IMAGES, true),
            (cmd::IMAGE | 2, 0, Features::IMAGES, false),
            (cmd::MSDF, 4, Features::MSDF, true),
            (cmd::MSDF, 5, Features::MSDF, false),
            (cmd::MSDF | 3, 0, Features::MSDF, false),
            (cmd::CURVES | cmd::CONTROL_BIT, 0, Features::CLIPS, true),
            (cmd::JUMP | cmd::CONTROL_BIT, 0, Features::CLIPS, true),
        ] {
            let command = [[data, 0, 0, tag | LAST]];
            assert_eq!(
                lists(TABLES, &command).is_some(),
                is_known,
                "{tag:x} {data}"
            );
            let without = Tables {
                features: TABLES.features & !feature,
                ..TABLES
            };
            assert_eq!(lists(without, &command), None, "{tag:x} {data}");
        }
        let blend = [
            [0, 0, 0, CONTROL | cmd::OPEN],
            [
                0,
                BlendMode::Multiply as u32,
                0,
                LAST | CONTROL | cmd::CLOSE,
            ],
        ];
        assert!(lists(TABLES, &blend).is_some());
        for feature in [Features::GROUPS, Features::BLENDS] {
            let without = Tables {
                features: TABLES.features & !feature,
                ..TABLES
            };
            assert_eq!(lists(without, &blend), None);
        }
    }
}
