//! The file's paints: each stored once, in order of first use.

use std::collections::BTreeMap;

use vtex_format::{Gradient, PaintRecord};

use crate::{
    coverage::placed::{Placed, PlacedKind},
    drawing::Paint,
};

/// The paints so far, found again by their bits: equal bits are the same paint.
#[derive(Debug, Default)]
pub(crate) struct PaintTable {
    paints: Vec<PaintRecord>,
    /// The numbers of gradients, paint by paint.
    numbers: Vec<f32>,
    solids: BTreeMap<[u32; 4], u32>,
    /// Found by kind, flags and numbers.
    gradients: BTreeMap<Vec<u32>, u32>,
}

impl PaintTable {
    /// Index of a paint; components of colours are clamped to \[0, 1\].
    pub(crate) fn intern(&mut self, paint: &Paint) -> u32 {
        match paint {
            Paint::Solid(color) => self.intern_solid(*color),
            Paint::Gradient(gradient) => self.intern_gradient(gradient),
        }
    }

    fn intern_solid(&mut self, color: [f32; 4]) -> u32 {
        // Adding zero turns -0 into 0, which has other bits but is the same colour.
        let color = color.map(|v| v.clamp(0.0, 1.0) + 0.0);
        let next = self.next();
        let index = *self.solids.entry(color.map(f32::to_bits)).or_insert(next);
        if index == next {
            self.paints.push(PaintRecord::solid(color));
        }
        index
    }

    fn intern_gradient(&mut self, gradient: &Gradient) -> u32 {
        let mut own = Vec::new();
        let record = gradient.store(&mut own);
        // Stored twice: first apart, for its bits, then behind all others if it is new.
        let head = [record.kind, record.flags];
        // Adding zero turns -0 into 0.
        let bits = own.iter().map(|number| (number + 0.0).to_bits());
        let key = head.into_iter().chain(bits).collect();
        let next = self.next();
        let index = *self.gradients.entry(key).or_insert(next);
        if index == next {
            self.paints.push(gradient.store(&mut self.numbers));
        }
        index
    }

    fn next(&self) -> u32 {
        u32::try_from(self.paints.len()).unwrap_or(u32::MAX)
    }

    /// Index of the solid paint that `front` over `back` looks like; `None` unless both are solid.
    pub(crate) fn intern_over(&mut self, front: u32, back: u32) -> Option<u32> {
        let (front, back) = (self.color(front)?, self.color(back)?);
        Some(self.intern_solid(over(front, back)))
    }

    /// Index of the paint with its alpha multiplied by `opacity`; `None` unless it is solid.
    pub(crate) fn intern_faded(&mut self, index: u32, opacity: f32) -> Option<u32> {
        let [r, g, b, a] = self.color(index)?;
        Some(self.intern_solid([r, g, b, a * opacity]))
    }

    /// Whether nothing behind it shows.
    pub(crate) fn is_opaque(&self, index: u32) -> bool {
        self.paints[index as usize].is_opaque()
    }

    /// The colour of a solid paint: straight alpha, sRGB-encoded.
    pub(crate) fn color(&self, index: u32) -> Option<[f32; 4]> {
        let paint = &self.paints[index as usize];
        (!paint.is_gradient()).then_some(paint.color)
    }

    /// All paints, and the numbers that gradients refer to.
    pub(crate) fn into_records(self) -> (Vec<PaintRecord>, Vec<f32>) {
        (self.paints, self.numbers)
    }
}

/// The paint of each item, or for a patch the index of its image, the first of which is
/// `first_image`.
pub(crate) fn number_paints(
    placed: &[Placed],
    first_image: u32,
    paints: &mut PaintTable,
) -> Vec<u32> {
    let mut images = first_image..;
    placed
        .iter()
        .map(|item| match &item.kind {
            PlacedKind::Shape { paint, .. } => paints.intern(paint),
            PlacedKind::Image => images.next().unwrap_or(u32::MAX),
            // A clip is never painted; any number does.
            PlacedKind::Clip => 0,
        })
        .collect()
}

/// Source-over of straight-alpha colours, on the sRGB-encoded values as SVG wants.
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
        let both = paints.intern_over(red, green).unwrap();
        assert!(paints.is_opaque(both) && !paints.is_opaque(red));
        assert_eq!(
            paints.into_records().0[both as usize].color,
            [0.5, 0.5, 0.0, 1.0]
        );
    }
}
