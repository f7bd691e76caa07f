//! Fine cells against the records they are made from.

mod clips_and_groups;

use vtex_format::CurveHeader;

use super::commands::{Order, write};
use super::list::{Arena, List};
use super::outline::Region;
use crate::layout::cmd;
use crate::record;

/// A list and what it is made of.
#[derive(Clone)]
pub(super) struct Sample {
    arena: Arena,
    list: List,
}

impl Sample {
    pub(super) fn decode(words: &[u32], curves: &[u32]) -> Self {
        let mut arena = Arena::default();
        let list = arena.decode(words, curves);
        Self { arena, list }
    }

    pub(super) fn within(&self, region: &Region) -> Self {
        let mut arena = self.arena.clone();
        arena.trace(&self.list, region.y);
        let list = arena.within(&self.list, region.x);
        Self { arena, list }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.list.nodes.is_empty()
    }

    pub(super) fn solid(&self) -> Option<u32> {
        self.arena.solid(self.list.nodes)
    }

    pub(super) fn has_groups(&self) -> bool {
        self.arena.has_groups(self.list.nodes)
    }

    pub(super) fn commands(&self) -> Vec<[u32; 4]> {
        let mut commands = Vec::new();
        write(
            &self.arena,
            self.list.nodes,
            Order::FrontToBack,
            &mut commands,
        );
        commands
    }
}

/// A generator that needs no crate.
struct Random(u64);

impl Random {
    fn below(&mut self, end: u32) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let high = u32::try_from(self.0 >> 33).unwrap_or(0);
        high % end
    }
}

const MARGIN: u32 = 300;
const UNITS: u32 = 4000;

/// A record of `count` random monotone segments; nothing says that they close.
fn random_record(random: &mut Random, count: u32) -> Vec<u32> {
    let end = UNITS + 2 * MARGIN;
    let mut segments: [Vec<[u32; 3]>; 4] = Default::default();
    for _ in 0..count {
        let mut xs = [0; 3].map(|_: u32| random.below(end));
        let mut ys = [0; 3].map(|_: u32| random.below(end));
        xs.sort_unstable();
        ys.sort_unstable();
        if random.below(2) == 0 {
            xs.reverse();
        }
        let points: [u32; 3] = std::array::from_fn(|i| xs[i] | ys[i] << 16);
        segments[random.below(4) as usize].push(points);
    }
    let [down_lines, up_lines, down_quads, up_quads] = &segments;
    let count = |list: &[[u32; 3]]| u32::try_from(list.len()).unwrap_or(0);
    let steps: Vec<u32> = (0..random.below(4))
        .map(|_| random.below(end) | (random.below(5).wrapping_sub(2) << 16))
        .collect();
    let header = CurveHeader {
        line_count: count(down_lines) + count(up_lines),
        down_line_count: count(down_lines),
        quad_count: count(down_quads) + count(up_quads),
        down_quad_count: count(down_quads),
        step_count: u32::try_from(steps.len()).unwrap_or(0),
        even_odd: random.below(2) == 0,
        base_winding: i32::try_from(random.below(31)).unwrap_or(0) - 15,
    };
    let mut words = header.encode().expect("fits").to_vec();
    words.extend(steps);
    let lines = down_lines.iter().chain(up_lines);
    words.extend(lines.flat_map(|&[a, _, b]| [a, b]));
    words.extend(down_quads.iter().chain(up_quads).flatten());
    words
}

fn region(random: &mut Random, depth: u32) -> Region {
    let whole = f64::from(UNITS);
    let side = whole / f64::from(1 << depth);
    let axis = |at: u32| {
        let low = f64::from(MARGIN) + f64::from(at) * side;
        [low, low + side]
    };
    Region {
        x: axis(random.below(1 << depth)),
        y: axis(random.below(1 << depth)),
    }
}

fn entry_words(even_odd_ignored: u32) -> [u32; 2] {
    let entry = vtex_format::Entry {
        kind: vtex_format::EntryKind::Curves,
        last: true,
        opaque: true,
        index: even_odd_ignored,
        data: 0,
    };
    entry.encode().expect("fits")
}

/// The winding that the commands of a list give at `p`.
fn fills(commands: &[[u32; 4]], p: [f32; 2]) -> bool {
    let words: Vec<u32> = commands.as_flattened().to_vec();
    crate::cpu::commands_fill(&words, p)
}

#[test]
fn parts_of_a_cell_fill_as_the_record_does() {
    let mut random = Random(1);
    let mut both = [0; 2];
    for round in 0..400 {
        let record = random_record(&mut random, 1 + round % 12);
        let list = Sample::decode(&entry_words(3), &record);
        for depth in 0..5 {
            let region = region(&mut random, depth);
            let inner = list.within(&region);
            for _ in 0..40 {
                let at = |range: [f64; 2], random: &mut Random| {
                    let t = f64::from(random.below(1 << 20)) / f64::from(1 << 20);
                    #[expect(clippy::cast_possible_truncation, reason = "a lookup's f32")]
                    let at = (range[0] + t * (range[1] - range[0])) as f32;
                    at
                };
                let p = [at(region.x, &mut random), at(region.y, &mut random)];
                let expected = record::inside(&record, p);
                let got = if inner.is_empty() {
                    false
                } else {
                    inner.solid().is_some() || fills(&inner.commands(), p)
                };
                assert_eq!(got, expected, "round {round}, depth {depth}, {p:?}");
                both[usize::from(expected)] += 1;
            }
        }
    }
    assert!(both.iter().all(|&count| count > 10_000), "{both:?}");
}

#[test]
fn windings_beyond_an_item_are_lines_beside_the_cell() {
    for base_winding in [-512, -9, -8, 0, 7, 8, 511] {
        let header = CurveHeader {
            base_winding,
            step_count: 1,
            even_odd: true,
            ..CurveHeader::default()
        };
        let mut words = header.encode().expect("fits").to_vec();
        words.push(1000 | 1 << 16);
        let commands = Sample::decode(&entry_words(0), &words).commands();
        assert!(commands.iter().all(|words| words[3] & cmd::LINE_BIT != 0));
        for (y, added) in [(999.0, 0), (1000.0, 1), (4000.0, 1)] {
            let odd = (base_winding + added) & 1 != 0;
            assert_eq!(fills(&commands, [50.0, y]), odd, "{base_winding} at {y}");
        }
    }
}
