//! Circles and chains in a small directed graph. Nodes are `0..count`; the graphs here have at most
//! a hundred, so plain searches from every node do.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Pairs `(from, to)`.
pub(super) type Edges = BTreeSet<(usize, usize)>;

/// The sets of two or more nodes that all reach each other, each in order.
pub(super) fn knots(count: usize, edges: &Edges) -> Vec<Vec<usize>> {
    let mut groups = components(count, edges);
    groups.retain(|group| group.len() > 1);
    groups
}

/// Every node in one set, together with those it reaches and is reached by.
fn components(count: usize, edges: &Edges) -> Vec<Vec<usize>> {
    let reached: Vec<BTreeSet<usize>> = (0..count).map(|node| reach(node, edges)).collect();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for node in 0..count {
        let together =
            |other: usize| reached[node].contains(&other) && reached[other].contains(&node);
        match groups.iter_mut().find(|group| together(group[0])) {
            Some(group) => group.push(node),
            None => groups.push(vec![node]),
        }
    }
    groups
}

fn reach(start: usize, edges: &Edges) -> BTreeSet<usize> {
    let mut reached = BTreeSet::new();
    let mut open = vec![start];
    while let Some(node) = open.pop() {
        for next in successors(node, edges) {
            if reached.insert(next) {
                open.push(next);
            }
        }
    }
    reached
}

fn successors(node: usize, edges: &Edges) -> impl Iterator<Item = usize> + '_ {
    edges
        .range((node, 0)..=(node, usize::MAX))
        .map(|edge| edge.1)
}

/// The shortest circle through `start` as a list of edges; empty when there is none.
pub(super) fn shortest_circle(start: usize, edges: &Edges) -> Vec<(usize, usize)> {
    let mut came_from = BTreeMap::new();
    let mut open = VecDeque::from([start]);
    while let Some(node) = open.pop_front() {
        for next in successors(node, edges) {
            came_from.entry(next).or_insert_with(|| {
                open.push_back(next);
                node
            });
        }
    }
    let mut circle = Vec::new();
    let mut node = start;
    while let Some(&before) = came_from.get(&node) {
        circle.push((before, node));
        node = before;
        if node == start {
            break;
        }
    }
    circle.reverse();
    circle
}

/// Nodes on the longest chain, with every knot as one node.
pub(super) fn floors(count: usize, edges: &Edges) -> usize {
    let groups = components(count, edges);
    let group_of: BTreeMap<usize, usize> = (0..)
        .zip(&groups)
        .flat_map(|(index, group)| group.iter().map(move |&node| (node, index)))
        .collect();
    let between: Edges = edges
        .iter()
        .map(|(from, to)| (group_of[from], group_of[to]))
        .filter(|(from, to)| from != to)
        .collect();
    let mut heights = BTreeMap::new();
    (0..groups.len())
        .map(|group| height(group, &between, &mut heights))
        .max()
        .unwrap_or(0)
}

fn height(node: usize, edges: &Edges, heights: &mut BTreeMap<usize, usize>) -> usize {
    if let Some(&height) = heights.get(&node) {
        return height;
    }
    let below = successors(node, edges)
        .map(|next| height(next, edges, heights))
        .max();
    let own = 1 + below.unwrap_or(0);
    heights.insert(node, own);
    own
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(pairs: &[(usize, usize)]) -> Edges {
        pairs.iter().copied().collect()
    }

    #[test]
    fn knots_are_found_and_counted_as_one_floor() {
        // 0 -> 1 <-> 2 -> 3, and 4 alone.
        let edges = edges(&[(0, 1), (1, 2), (2, 1), (2, 3)]);
        assert_eq!(knots(5, &edges), [vec![1, 2]]);
        assert_eq!(floors(5, &edges), 3);
        assert_eq!(floors(0, &Edges::new()), 0);
    }

    #[test]
    fn the_shortest_circle_is_found() {
        let edges = edges(&[(0, 1), (1, 2), (2, 0), (1, 3), (3, 4), (4, 0), (2, 3)]);
        assert_eq!(shortest_circle(0, &edges), [(0, 1), (1, 2), (2, 0)]);
        assert_eq!(shortest_circle(4, &edges), [(4, 0), (0, 1), (1, 3), (3, 4)]);
        assert_eq!(shortest_circle(5, &edges), []);
    }
}
