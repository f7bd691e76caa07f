//! Twin of `vtex/sample.wgsl`.

use super::minify::minify;
use super::{Lookup, Sampler, mapping};
use vtex_format::Features;

pub(super) fn sample(sampler: &Sampler<'_>, uv: [f32; 2], axes: [f32; 4]) -> [f32; 4] {
    let s = &sampler.settings;
    let moved = mapping::point(sampler, uv);
    let region = mapping::axes(sampler, axes);
    let share = mapping::share(sampler, moved, region);
    // Also where it is no number.
    if share.is_nan() || share <= 0.0 {
        return [0.0; 4];
    }
    let color = minify(sampler, &placed(sampler, moved, region));
    let color = color.map(|channel| share * channel);
    if s.has(Features::MASK) {
        [color[3]; 4]
    } else {
        color
    }
}

/// What of the cells and mips a lookup asks for.
pub(super) fn lookup(sampler: &Sampler<'_>, uv: [f32; 2], axes: [f32; 4]) -> Lookup {
    placed(
        sampler,
        mapping::point(sampler, uv),
        mapping::axes(sampler, axes),
    )
}

/// The same of a place and axes behind the texture matrix.
fn placed(sampler: &Sampler<'_>, moved: [f32; 2], region: [f32; 4]) -> Lookup {
    let axes = mapping::kept(sampler, moved, region);
    Lookup::new(sampler, mapping::address(sampler, moved), axes)
}
