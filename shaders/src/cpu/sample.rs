//! Twin of `vtex/sample.wgsl`.

use super::minify::minify;
use super::{Lookup, Sampler, mapping};
use vtex_format::Features;

pub(super) fn sample(sampler: &Sampler<'_>, uv: [f32; 2], axes: [f32; 4]) -> [f32; 4] {
    let s = &sampler.settings;
    let region = mapping::axes(sampler, axes);
    let share = mapping::share(sampler, mapping::point(sampler, uv), region);
    // Also where it is no number.
    if share.is_nan() || share <= 0.0 {
        return [0.0; 4];
    }
    let color = minify(sampler, &lookup(sampler, uv, axes)).map(|channel| share * channel);
    if s.has(Features::MASK) {
        [color[3]; 4]
    } else {
        color
    }
}

/// What of the cells and mips a lookup asks for.
pub(super) fn lookup(sampler: &Sampler<'_>, uv: [f32; 2], axes: [f32; 4]) -> Lookup {
    let moved = mapping::point(sampler, uv);
    let axes = mapping::kept(sampler, moved, mapping::axes(sampler, axes));
    Lookup::new(sampler, mapping::address(sampler, moved), axes)
}
