//! Boxes of HTML to lines of text: blocks, lines that break at spaces, and flex boxes (CSS 2, Flexbox
//! 1), as far as labels need it.

use std::cell::Cell;
use std::rc::Rc;

use super::fonts::Fonts;
use super::line::{Open, Run};
use super::look::{Display, Frame, Look};
use crate::style::value::length::Quantity;

/// Most boxes and words that are laid out in one document, counted each time. A page of text has some
/// hundreds; boxes as wide as their content are laid out twice on each level.
const MAX_WORK: usize = 1 << 20;

/// How far a label may reach over its box unclipped.
const SLACK_PX: f64 = 0.5;

/// Wide enough that no line breaks.
const UNBOUNDED_PX: f64 = 1e6;

/// Content of an element, in its order.
#[derive(Debug)]
pub(super) enum Item {
    Text(Rc<Look>, String),
    Break,
    Part(Part),
}

/// A box.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) look: Rc<Look>,
    pub(super) frame: Frame,
    pub(super) items: Vec<Item>,
}

/// A line of text. `x` is its left end, its middle or its right end, as `align` says.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) x: f64,
    pub(super) baseline: f64,
    pub(super) align: i8,
    pub(super) width: f64,
    pub(super) runs: Vec<(Rc<Look>, String)>,
}

/// A coloured rectangle: left, top, width, height.
type Ground = ([f64; 4], String);

/// A box with places in it.
#[derive(Clone, Debug, Default)]
pub(super) struct Laid {
    pub(super) width: f64,
    pub(super) height: f64,
    /// Width that the content takes at most.
    natural: f64,
    /// The margin of the last box in it, which is shared with that of the box itself.
    below: f64,
    pub(super) lines: Vec<Line>,
    pub(super) grounds: Vec<Ground>,
}

impl Laid {
    /// Whether the lines stay in a box at the same place. Letters seldom fill their lines, so that a
    /// part of a pixel does not count.
    pub(super) fn is_within(&self, [width, height]: [f64; 2]) -> bool {
        self.lines.iter().all(|line| {
            let left = line.x - line.width * f64::from(line.align + 1) / 2.0;
            let sizes = line.runs.iter().map(|(look, _)| look.font_size_px);
            let size = sizes.fold(0.0, f64::max);
            left > -SLACK_PX
                && left + line.width < width + SLACK_PX
                && line.baseline - 0.75 * size > -SLACK_PX
                && line.baseline + 0.25 * size < height + SLACK_PX
        })
    }

    fn put(&mut self, other: Self, x: f64, y: f64) {
        self.lines.extend(other.lines.into_iter().map(|line| Line {
            x: line.x + x,
            baseline: line.baseline + y,
            ..line
        }));
        let moved = |([left, top, width, height], color): Ground| {
            ([left + x, top + y, width, height], color)
        };
        self.grounds.extend(other.grounds.into_iter().map(moved));
    }
}

/// Lays out with some fonts.
pub(super) struct Flow<'a> {
    pub(super) fonts: &'a Fonts,
    pub(super) work: &'a Cell<usize>,
}

impl Flow<'_> {
    /// Whether the layout has taken too much work and stopped.
    pub(super) fn is_over(&self) -> bool {
        self.work.get() > MAX_WORK
    }

    /// Lays out a box in a width, without its margins.
    pub(super) fn part(&self, part: &Part, room: [f64; 2]) -> Laid {
        self.work.set(self.work.get() + 1);
        if self.is_over() {
            return Laid::default();
        }
        let frame = &part.frame;
        let [top, right, bottom, left] = frame.padding;
        let beside = left + right;
        let written = |quantity: Option<Quantity>, whole: f64, padding: f64| {
            let quantity = quantity?;
            // A share of an unknown height is none.
            let is_share = matches!(quantity, Quantity::Length(_, share) if share != 0.0);
            if is_share && whole.is_nan() {
                return None;
            }
            let px = quantity.length_px(if is_share { whole } else { 0.0 })?;
            Some(
                if frame.includes_padding {
                    px
                } else {
                    px + padding
                }
                .max(padding),
            )
        };
        let width = written(frame.width, room[0], beside);
        let fills = matches!(frame.display, Display::Block | Display::Flex);
        let outer = room[0] - frame.margin[1] - frame.margin[3];
        let mut width = width.unwrap_or_else(|| match fills {
            true => outer,
            false => (self.content(part, UNBOUNDED_PX, None).natural + beside).min(outer),
        });
        if let Some(most) = written(frame.max_width, room[0], beside) {
            width = width.min(most);
        }
        let height = written(frame.height, room[1], top + bottom);
        let inner_height = height.map(|height| height - top - bottom);
        let content = self.content(part, (width - beside).max(0.0), inner_height);
        let mut laid = Laid {
            width,
            height: height.unwrap_or(content.height + top + bottom),
            natural: match frame.width {
                Some(_) => width,
                None => content.natural + beside,
            },
            below: content.below,
            ..Laid::default()
        };
        if let Some(color) = &frame.background {
            let ground = [0.0, 0.0, laid.width, laid.height];
            laid.grounds.push((ground, color.clone()));
        }
        laid.put(content, left, top);
        laid
    }

    fn content(&self, part: &Part, width: f64, height: Option<f64>) -> Laid {
        match part.frame.display {
            Display::Flex => self.flex(part, width, height),
            _ => self.blocks(part, width, height),
        }
    }

    /// Boxes under each other, and lines between them.
    fn blocks(&self, part: &Part, width: f64, height: Option<f64>) -> Laid {
        let mut laid = Laid {
            width,
            ..Laid::default()
        };
        let mut inline: Vec<&Item> = Vec::new();
        let shares_margin = !part.frame.is_root && part.frame.padding[0] == 0.0;
        // The margin below the last box, of which the next one's may be a part.
        let mut below = 0.0;
        for item in &part.items {
            let Item::Part(inner) = item else {
                inline.push(item);
                continue;
            };
            self.lines(&mut inline, part, &mut laid, &mut below);
            let [_, right, after, left] = inner.frame.margin;
            let above = match shares_margin && laid.height == 0.0 {
                true => 0.0,
                false => above(inner),
            };
            let child = self.part(inner, [width, height.unwrap_or(f64::NAN)]);
            let free = width - child.width - left - right;
            let share = match inner.frame.display {
                Display::InlineBlock => f64::from(part.look.align + 1) / 2.0,
                _ => 0.0,
            };
            let (x, y) = (
                left + (free * share).max(0.0),
                laid.height + f64::max(below, above),
            );
            laid.natural = laid.natural.max(child.natural + left + right);
            laid.height = y + child.height;
            below = after.max(child.below);
            laid.put(child, x, y);
        }
        self.lines(&mut inline, part, &mut laid, &mut below);
        match part.frame.is_root || part.frame.padding[2] != 0.0 || height.is_some() {
            true => laid.height += below,
            false => laid.below = below,
        }
        laid
    }

    /// Adds the lines that `inline` makes.
    fn lines(&self, inline: &mut Vec<&Item>, part: &Part, laid: &mut Laid, below: &mut f64) {
        let mut line = Open::default();
        let mut lines = Vec::new();
        for item in inline.drain(..) {
            match item {
                Item::Text(look, text) => self.text(look, text, laid.width, &mut line, &mut lines),
                Item::Break => {
                    line.is_forced = true;
                    lines.push(std::mem::take(&mut line));
                }
                Item::Part(_) => {}
            }
        }
        lines.push(line);
        for line in lines {
            let Open {
                runs,
                width,
                is_forced,
                hang,
                ..
            } = line;
            if runs.is_empty() && !is_forced {
                continue;
            }
            laid.height += std::mem::take(below);
            let align = if width > laid.width {
                -1
            } else {
                part.look.align
            };
            self.place(runs, [width, hang], align, part, laid);
        }
    }

    fn place(
        &self,
        runs: Vec<Run>,
        [width, hang]: [f64; 2],
        align: i8,
        part: &Part,
        laid: &mut Laid,
    ) {
        let (mut above, mut under) = self.strut(&part.look);
        for run in &runs {
            let (a, u) = self.strut(&run.look);
            above = above.max(a + run.look.raise_px);
            under = under.max(u - run.look.raise_px);
        }
        let share = f64::from(align + 1) / 2.0;
        let baseline = laid.height + above;
        let mut x = (laid.width - width - hang) * share;
        for run in &runs {
            if let Some(color) = &run.look.background {
                let extent = self.fonts.extent(&run.look, "x");
                let ground = [
                    x,
                    baseline - extent.ascent,
                    run.width,
                    extent.ascent + extent.descent,
                ];
                laid.grounds.push((ground, color.clone()));
            }
            x += run.width;
        }
        laid.natural = laid.natural.max(width);
        laid.height += above + under;
        if !runs.is_empty() {
            laid.lines.push(Line {
                x: (laid.width - hang) * share,
                width,
                baseline,
                align,
                runs: runs.into_iter().map(|run| (run.look, run.text)).collect(),
            });
        }
    }

    /// How far a line of `look` reaches above and under its baseline.
    fn strut(&self, look: &Look) -> (f64, f64) {
        let extent = self.fonts.extent(look, "x");
        // Browsers lay lines out with whole pixels of these two.
        let (ascent, descent) = (extent.ascent.round(), extent.descent.round());
        let own = ascent + descent;
        let height = look.line_height_px().unwrap_or(own);
        let above = (height - own) / 2.0 + ascent;
        (above, height - above)
    }

    /// Adds a text to the open line, and closes lines that are full.
    fn text(
        &self,
        look: &Rc<Look>,
        text: &str,
        width: f64,
        line: &mut Open,
        lines: &mut Vec<Open>,
    ) {
        let mut rest = text;
        while let Some(first) = rest.chars().next() {
            self.work.set(self.work.get() + 1);
            if self.is_over() {
                return;
            }
            let is_space = |c: char| c.is_ascii_whitespace();
            let end = match is_space(first) {
                true => rest.find(|c: char| !is_space(c)),
                false => rest.find(is_space),
            };
            let (piece, after) = rest.split_at(end.unwrap_or(rest.len()));
            rest = after;
            if is_space(first) {
                for _ in piece.matches('\n').filter(|_| look.keeps_breaks) {
                    line.is_forced = true;
                    lines.push(std::mem::take(line));
                }
                line.space(look);
                continue;
            }
            let word = self.fonts.extent(look, piece).width;
            if look.wraps && line.breaks(word, self.space_width(look), width) {
                if look.keeps_spaces {
                    line.hang = self.space_width(look);
                }
                lines.push(std::mem::take(line));
            }
            line.word(look, piece, word, self.space_width(look));
        }
    }

    fn space_width(&self, look: &Look) -> f64 {
        // A space alone has no extent in usvg.
        let both = self.fonts.extent(look, "x x").width;
        both - 2.0 * self.fonts.extent(look, "x").width
    }

    /// Boxes beside each other, or under each other in a column.
    fn flex(&self, part: &Part, width: f64, height: Option<f64>) -> Laid {
        let frame = &part.frame;
        let mut laid = Laid {
            width,
            ..Laid::default()
        };
        let room = [width, height.unwrap_or(f64::NAN)];
        let children = self.flex_items(part, room);
        let outer = |child: &Laid, margin: &[f64; 4]| {
            [
                child.width + margin[1] + margin[3],
                child.height + margin[0] + margin[2],
            ]
        };
        let sizes: Vec<[f64; 2]> = children
            .iter()
            .map(|(child, margin)| outer(child, margin))
            .collect();
        let sum = |axis: usize| sizes.iter().map(|size| size[axis]).sum::<f64>();
        let greatest = |axis: usize| sizes.iter().map(|size| size[axis]).fold(0.0, f64::max);
        let (along, across) = if frame.is_column { (1, 0) } else { (0, 1) };
        laid.natural = if frame.is_column { greatest(0) } else { sum(0) };
        laid.height = height.unwrap_or(if frame.is_column { sum(1) } else { greatest(1) });
        let whole = [width, laid.height];
        let mut place = (whole[along] - sum(along)) * frame.justify;
        for ((child, margin), size) in children.into_iter().zip(sizes) {
            let aside = (whole[across] - size[across]) * frame.align_items.unwrap_or(0.0);
            let [x, y] = if frame.is_column {
                [aside, place]
            } else {
                [place, aside]
            };
            laid.put(child, x + margin[3], y + margin[0]);
            place += size[along];
        }
        laid
    }

    /// The boxes of a flex box; texts between boxes are boxes too.
    fn flex_items(&self, part: &Part, room: [f64; 2]) -> Vec<(Laid, [f64; 4])> {
        let stretches = part.frame.is_column && part.frame.align_items.is_none();
        let mut children = Vec::new();
        let mut inline: Vec<&Item> = Vec::new();
        let close = |inline: &mut Vec<&Item>, children: &mut Vec<(Laid, [f64; 4])>| {
            let lay = |inline: &[&Item], width: f64| {
                let mut laid = Laid {
                    width,
                    ..Laid::default()
                };
                self.lines(&mut inline.to_vec(), part, &mut laid, &mut 0.0);
                laid
            };
            let natural = lay(inline, UNBOUNDED_PX).natural;
            if natural > 0.0 {
                let width = if stretches {
                    room[0]
                } else {
                    natural.min(room[0])
                };
                children.push((lay(inline, width), [0.0; 4]));
            }
            inline.clear();
        };
        for item in &part.items {
            let Item::Part(inner) = item else {
                inline.push(item);
                continue;
            };
            close(&mut inline, &mut children);
            let margin = inner.frame.margin;
            let is_free = stretches || inner.frame.width.is_some();
            let width = match is_free {
                true => room[0],
                false => {
                    let natural = self.part(inner, [UNBOUNDED_PX, room[1]]).natural;
                    (natural + margin[1] + margin[3]).min(room[0])
                }
            };
            children.push((self.part(inner, [width, room[1]]), margin));
        }
        close(&mut inline, &mut children);
        children
    }
}

/// The margin above a box, of which that of the first box in it may be a part.
fn above(part: &Part) -> f64 {
    let own = part.frame.margin[0];
    if part.frame.is_root || part.frame.padding[0] != 0.0 {
        return own;
    }
    let mut items = part.items.iter();
    let is_blank = |item: &&Item| match item {
        Item::Text(_, text) => text.trim().is_empty(),
        _ => false,
    };
    match items.find(|item| !is_blank(item)) {
        Some(Item::Part(inner)) => own.max(above(inner)),
        _ => own,
    }
}
