//! Twin of `vtex/sample.wgsl`.

use super::minify::minify;
use super::{Lookup, Sampler, Value, address, footprint, matrix};
use vtex_format::Features;

pub(super) fn sample(sampler: &Sampler<'_>, uv: [f32; 2], axes: [f32; 4]) -> [f32; 4] {
    let s = &sampler.settings;
    let (moved, axes) = if s.has(Features::TEXTURE_MATRIX) {
        (matrix::point(sampler, uv), matrix::axes(sampler, axes))
    } else {
        (uv, axes)
    };
    if address::outside(sampler, moved) {
        return [0.0; 4];
    }
    let lookup = Lookup {
        uv: address::address(sampler, moved),
        width_cells: footprint::width_cells(s.scale, axes),
        q: [0.0; 2],
    };
    // A mask's groups blend and weigh in colour; alpha is spread last.
    if s.has(Features::MASK) && !s.composited {
        return minify::<f32>(sampler, &lookup).result();
    }
    let color = minify::<[f32; 4]>(sampler, &lookup).result();
    if s.has(Features::MASK) {
        [color[3]; 4]
    } else {
        color
    }
}
