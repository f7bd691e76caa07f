//! Whether a part of the canvas has one colour: no twin, for the baker.

use super::cell::{Cell, cell};
use super::math::{clamp, to_f32, to_u32};
use super::picture::point;
use super::{Lookup, Sampler, paint, segment};
use crate::layout::{cell, cmd, entry_paints, filter};

impl Sampler<'_> {
    /// The one colour, in linear light, premultiplied, that cells show to point lookups with uv in
    /// the box from `low` to `high`, inside the canvas before the texture matrix; `None` where they
    /// may show more.
    pub fn uniform_color(&self, low: [f32; 2], high: [f32; 2]) -> Option<[f32; 4]> {
        let s = &self.settings;
        let place = |uv: [f32; 2]| [0, 1].map(|axis| uv[axis] * s.scale[axis] + s.offset[axis]);
        let last = |p: [f32; 2]| [0, 1].map(|axis| clamp(p[axis], 0.0, s.last_place[axis]));
        let span = [low, high].map(|uv| last(place(uv)));
        let mut color = None;
        let even = self.cells(s.base_per_cell, span, |base| {
            let per_cell = base.per_cell();
            if per_cell <= s.base_per_cell {
                return self.adds(&mut color, base, span);
            }
            let ends = base.ends_of(s.base_per_cell);
            let within = |p: [f32; 2]| {
                [0, 1].map(|axis| clamp(p[axis], ends[0][axis], ends[1][axis].next_down()))
            };
            self.cells(per_cell, span.map(within), |cell| {
                self.adds(&mut color, cell, span)
            })
        });
        if even { color } else { None }
    }

    /// Whether `visit` says so of all cells, so many to one of the file's, that a box meets.
    fn cells(
        &self,
        per_cell: f32,
        [low, high]: [[f32; 2]; 2],
        mut visit: impl FnMut(Cell) -> bool,
    ) -> bool {
        let at = |p: [f32; 2]| p.map(|p| to_u32(p * per_cell));
        let ([left, top], [right, bottom]) = (at(low), at(high));
        (top..=bottom).all(|y| {
            (left..=right).all(|x| {
                let middle = [x, y].map(|at| (to_f32(at) + 0.5) / per_cell);
                visit(cell(self, middle, &mut ()))
            })
        })
    }

    /// Whether where a cell and a box meet the one colour shows that showed so far.
    fn adds(&self, color: &mut Option<[f32; 4]>, cell: Cell, span: [[f32; 2]; 2]) -> bool {
        let own = self.cell_color(cell, span);
        let known = *color.get_or_insert(own.unwrap_or_default());
        own == Some(known)
    }

    /// The one colour where a cell and the box that spans two places, in the file's cells, meet.
    fn cell_color(&self, found: Cell, span: [[f32; 2]; 2]) -> Option<[f32; 4]> {
        let word = found.word;
        let ends = found.ends();
        let corner = ends[0].map(f32::floor);
        let [low, high] = span.map(|p| {
            [0, 1].map(|axis| clamp(p[axis], ends[0][axis], ends[1][axis]) - corner[axis])
        });
        let payload = word & cell::PAYLOAD_MASK;
        let uniform = match word >> cell::TAG_SHIFT {
            cell::LIST | cell::GROUPS => self.is_uniform(payload, low, high),
            cell::SOLID => !self.varies(word & cell::PAINT_MASK),
            _ => true,
        };
        if !uniform {
            return None;
        }
        let lookup = Lookup::new(self, [0.0; 2], [0.0; 4]);
        Some(point(self, &lookup, word, low, &mut ()))
    }

    /// Whether a paint is no single colour.
    fn varies(&self, index: u32) -> bool {
        paint::varies(paint::words(self, index))
    }

    /// Whether each entry of a list either fills the box or stays out of it.
    fn is_uniform(&self, offset: u32, low: [f32; 2], high: [f32; 2]) -> bool {
        let s = &self.settings;
        if s.filter != filter::POINT || s.outline {
            return false;
        }
        let [units, margin] = s.curve_lattice;
        let [low, high] = [low, high].map(|q| q.map(|q| q * units + margin));
        let mut at = s.commands.wrapping_add(offset.wrapping_mul(cmd::WORDS));
        for _ in 0..cmd::LIMIT {
            let words: [u32; 4] = self.words(at);
            let tag = words[3];
            // Of a curve's segments only the last says what they are.
            let kind = tag & cmd::KIND_MASK;
            let end = tag & cmd::END_BIT != 0;
            let full = end && kind == cmd::FULL;
            if kind == cmd::MSDF || kind == cmd::IMAGE {
                return false;
            }
            if end && entry_paints(tag).any(|paint| self.varies(paint)) {
                return false;
            }
            if !full && !segment::is_constant(words, low, high) {
                return false;
            }
            at = at.wrapping_add(cmd::WORDS);
            if tag & cmd::LAST_BIT != 0 || self.is_past(at) {
                break;
            }
        }
        true
    }
}
