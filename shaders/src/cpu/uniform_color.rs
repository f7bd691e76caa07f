//! Whether a part of the canvas has one colour: no twin, for the baker.

use super::math::{clamp, to_f32, to_u32};
use super::picture::{point, word_at};
use super::{Lookup, Sampler, paint, segment};
use crate::layout::{cell, cmd, filter};

impl Sampler<'_> {
    /// The one colour, in linear light, premultiplied, that cells show to point lookups with uv in
    /// the box from `low` to `high`, inside the canvas before the texture matrix; `None` where they
    /// may show more.
    pub fn uniform_color(&self, low: [f32; 2], high: [f32; 2]) -> Option<[f32; 4]> {
        let s = &self.settings;
        let place = |uv: [f32; 2]| [0, 1].map(|axis| uv[axis] * s.scale[axis] + s.offset[axis]);
        let span = [place(low), place(high)];
        let [first, last] = span.map(|p| {
            let fine = |axis: usize| (p[axis] * s.fine_per_cell).floor();
            [0, 1].map(|axis| to_u32(clamp(fine(axis), 0.0, s.fine_size[axis] - 1.0)))
        });
        let rows = first[1]..=last[1];
        let fine = rows.flat_map(|y| (first[0]..=last[0]).map(move |x| [x, y]));
        let mut colors = fine.map(|fine| self.cell_color(fine, span));
        let color = colors.next()??;
        colors.all(|other| other == Some(color)).then_some(color)
    }

    /// The one colour where a fine cell and the box that spans two places, in cells, meet.
    fn cell_color(&self, fine: [u32; 2], span: [[f32; 2]; 2]) -> Option<[f32; 4]> {
        let s = &self.settings;
        let word = word_at(self, fine);
        let ends = [0.0, 1.0].map(|end| fine.map(|part| (to_f32(part) + end) * s.cell_per_fine));
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
            if end && self.varies(tag & cmd::INDEX_MASK) {
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
