//! Circles between rooms.

use std::collections::{BTreeMap, BTreeSet};

use super::arrows::Arrows;
use super::exemptions::{Finding, Rule};
use super::knots::{Edges, knots, shortest_circle};
use super::tree::parent_folder;

/// What stands in a folder: a sub-folder with all that lies below it, or a file of its own.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Node<'a> {
    Folder(&'a str),
    File(&'a str),
}

impl<'a> Node<'a> {
    /// Where `file`, which belongs to `room`, stands as seen from `folder`.
    fn of(file: &'a str, room: &'a str, folder: &str) -> Option<Self> {
        if room == folder {
            return Some(Node::File(file));
        }
        let below = room.strip_prefix(folder)?.strip_prefix('/')?;
        let name = below.split('/').next()?;
        Some(Node::Folder(&room[..folder.len() + 1 + name.len()]))
    }

    fn name(self) -> &'a str {
        match self {
            Node::Folder(name) | Node::File(name) => name,
        }
    }
}

/// One finding for each set of rooms and files of a folder that import each other in a circle.
pub(super) fn circles(arrows: &Arrows) -> Vec<Finding> {
    let rooms = arrows.rooms();
    let mut folders = BTreeSet::new();
    for room in &rooms {
        let mut folder = *room;
        // `src` itself has a slash before it: the package's folder is no room.
        while folder.contains('/') && folders.insert(folder) && !folder.ends_with("/src") {
            folder = parent_folder(folder);
        }
    }
    let found = folders.iter().flat_map(|folder| {
        let graph = Graph::of(arrows, &rooms, folder);
        let knots = knots(graph.nodes.len(), &graph.edges());
        let between = knots
            .into_iter()
            .filter_map(move |knot| graph.describe(arrows, &knot));
        between.map(move |text| Finding {
            rule: Rule::Circle,
            room: (*folder).to_owned(),
            text: format!("{folder}: {text}"),
        })
    });
    found.collect()
}

/// The imports between the nodes of one folder, each with the arrow between files that stands for it.
struct Graph<'a> {
    nodes: Vec<Node<'a>>,
    arrows: BTreeMap<(usize, usize), (usize, usize)>,
}

impl<'a> Graph<'a> {
    fn of(arrows: &'a Arrows, rooms: &[&'a str], folder: &str) -> Self {
        let node = |file: usize| Node::of(&arrows.files[file], rooms[file], folder);
        let all: BTreeSet<Node<'a>> = (0..rooms.len()).filter_map(node).collect();
        let nodes: Vec<Node<'a>> = all.into_iter().collect();
        let index = |file| nodes.binary_search(&node(file)?).ok();
        let mut between = BTreeMap::new();
        for &(from, to) in arrows.lines.keys() {
            if let (Some(importer), Some(imported)) = (index(from), index(to))
                && importer != imported
            {
                between.entry((importer, imported)).or_insert((from, to));
            }
        }
        Self {
            nodes,
            arrows: between,
        }
    }

    fn edges(&self) -> Edges {
        self.arrows.keys().copied().collect()
    }

    /// The shortest circle through a sub-folder, arrow by arrow; `None` when the knot has none.
    fn describe(&self, arrows: &Arrows, knot: &[usize]) -> Option<String> {
        let edges = self.edges();
        let is_folder = |node: &&usize| matches!(self.nodes[**node], Node::Folder(_));
        let starts = knot.iter().filter(is_folder);
        let circle = starts
            .map(|&node| shortest_circle(node, &edges))
            .min_by_key(Vec::len)?;
        let names: Vec<&str> = knot.iter().map(|&node| self.nodes[node].name()).collect();
        let mut text = format!("rooms import each other: {}", names.join(", "));
        for edge in circle {
            text += "\n    ";
            text += &arrows.describe(self.arrows[&edge]);
        }
        Some(text)
    }
}
