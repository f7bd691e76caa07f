//! Twin of `vtex/matrix_affine.wgsl`.

use super::Sampler;

fn linear(m: &[f32; 6], v: [f32; 2]) -> [f32; 2] {
    [m[0] * v[0] + m[2] * v[1], m[1] * v[0] + m[3] * v[1]]
}

pub(super) fn point(sampler: &Sampler<'_>, uv: [f32; 2]) -> [f32; 2] {
    let m = &sampler.settings.texture_matrix;
    let [u, v] = linear(m, uv);
    [u + m[4], v + m[5]]
}

pub(super) fn axes(sampler: &Sampler<'_>, axes: [f32; 4]) -> [f32; 4] {
    let m = &sampler.settings.texture_matrix;
    let first = linear(m, [axes[0], axes[1]]);
    let second = linear(m, [axes[2], axes[3]]);
    [first[0], first[1], second[0], second[1]]
}
