//! Twin of `vtex/msdf.wgsl`: signed distance from a tile.

use super::Sampler;
use super::math::{clamp, mix, to_f32, to_u32};

/// Red, green and blue of a texel, in \[0, 1\]; the fourth lane is idle.
fn texel(word: u32) -> [f32; 4] {
    word.to_le_bytes()
        .map(|byte| f32::from(byte) * (1.0 / 255.0))
}

fn median(v: [f32; 3]) -> f32 {
    v[0].min(v[1]).max(v[0].max(v[1]).min(v[2]))
}

/// In texels, inside positive. `q` is the position inside the cell.
pub(super) fn distance(sampler: &Sampler<'_>, tile: u32, q: [f32; 2]) -> f32 {
    let n = sampler.settings.texels_per_cell;
    let last = to_f32(n.max(1) - 1);
    let x = q.map(|q| q * to_f32(n));
    let corner = x.map(|x| clamp(x.floor(), 0.0, last));
    let f = [x[0] - corner[0], x[1] - corner[1]];
    let pitch = n.wrapping_add(1);
    let first = tile
        .wrapping_mul(pitch.wrapping_mul(pitch))
        .wrapping_add(sampler.settings.tiles)
        .wrapping_add(to_u32(corner[1]).wrapping_mul(pitch))
        .wrapping_add(to_u32(corner[0]));
    let above: [u32; 2] = sampler.words(first);
    let below: [u32; 2] = sampler.words(first.wrapping_add(pitch));
    let top = mix(texel(above[0]), texel(above[1]), f[0]);
    let bottom = mix(texel(below[0]), texel(below[1]), f[0]);
    let [r, g, b, _] = mix(top, bottom, f[1]);
    (median([r, g, b]) - 0.5) * sampler.settings.distance_range
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_every_order() {
        for v in [
            [1.0, 2.0, 3.0],
            [2.0, 1.0, 3.0],
            [3.0, 1.0, 2.0],
            [3.0, 2.0, 1.0],
        ] {
            assert!((median(v) - 2.0).abs() < f32::EPSILON, "{v:?}");
        }
    }
}
