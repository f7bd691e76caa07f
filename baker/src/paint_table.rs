//! Paints, each stored once, in order of first use.

use std::collections::BTreeMap;

use vtex_format::{PAINT_SOLID, PaintRecord};

use crate::drawing::Paint;

/// Solid paints by the bits of their colour.
#[derive(Debug, Default)]
pub(crate) struct PaintTable {
    paints: Vec<PaintRecord>,
    index_of: BTreeMap<[u32; 4], u32>,
}

impl PaintTable {
    /// Index of a paint; components of colours are clamped to \[0, 1\].
    pub(crate) fn intern(&mut self, paint: &Paint) -> u32 {
        let Paint::Solid(color) = paint;
        self.intern_solid(*color)
    }

    fn intern_solid(&mut self, color: [f32; 4]) -> u32 {
        // Adding zero turns -0 into 0.
        let color = color.map(|v| v.clamp(0.0, 1.0) + 0.0);
        let next = u32::try_from(self.paints.len()).unwrap_or(u32::MAX);
        let index = *self.index_of.entry(color.map(f32::to_bits)).or_insert(next);
        if index == next {
            self.paints.push(PaintRecord::solid(color));
        }
        index
    }

    /// Index of what paint `front` over paint `back` looks like.
    pub(crate) fn intern_over(&mut self, front: u32, back: u32) -> u32 {
        let [front, back] = [front, back].map(|index| self.color(index));
        self.intern_solid(over(front, back))
    }

    /// The paint with its alpha multiplied; `None` where it is no single colour.
    pub(crate) fn intern_faded(&mut self, index: u32, opacity: f32) -> Option<u32> {
        let [r, g, b, a] = self.solid(index)?;
        Some(self.intern_solid([r, g, b, a * opacity]))
    }

    /// The colour of a paint that has one, straight alpha, sRGB-encoded.
    pub(crate) fn solid(&self, index: u32) -> Option<[f32; 4]> {
        let paint = self.paints.get(index as usize)?;
        (paint.kind == PAINT_SOLID).then_some(paint.color)
    }

    /// Whether nothing shows behind.
    pub(crate) fn is_opaque(&self, index: u32) -> bool {
        self.paints[index as usize].is_opaque()
    }

    fn color(&self, index: u32) -> [f32; 4] {
        self.paints[index as usize].color
    }

    /// All paints.
    pub(crate) fn into_records(self) -> Vec<PaintRecord> {
        self.paints
    }
}

/// Source-over of straight-alpha colours, on the encoded values.
fn over(front: [f32; 4], back: [f32; 4]) -> [f32; 4] {
    let shown = back[3] * (1.0 - front[3]);
    let alpha = front[3] + shown;
    if alpha <= 0.0 {
        return [0.0; 4];
    }
    let mix = |i: usize| (front[i] * front[3] + back[i] * shown) / alpha;
    [mix(0), mix(1), mix(2), alpha]
}

#[cfg(test)]
mod tests {
    use super::PaintTable;

    #[test]
    fn equal_colours_share_an_index_and_over_is_source_over() {
        let mut paints = PaintTable::default();
        let red = paints.intern_solid([1.0, 0.0, 0.0, 0.5]);
        let green = paints.intern_solid([0.0, 1.0, 0.0, 1.0]);
        assert_eq!(paints.intern_solid([1.0, -0.0, 0.0, 0.5]), red);
        let both = paints.intern_over(red, green);
        assert!(paints.is_opaque(both) && !paints.is_opaque(red));
        assert_eq!(
            paints.into_records()[both as usize].color,
            [0.5, 0.5, 0.0, 1.0]
        );
    }
}
