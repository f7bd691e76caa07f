//! The panorama as texels, and the cells by which paths aim at it.

use std::f64::consts::PI;

use super::alias;
use crate::scene::Environment;

/// Most columns and rows of a panorama: the largest texture of core WebGPU. Larger ones are halved.
const MAX_SIDE: u32 = 8192;
/// Most columns and rows of cells. Beyond, a cell has several texels: 8 MiB are enough for a table.
const MAX_CELLS: [u32; 2] = [1024, 512];
/// The largest number of the texture format, nine bits of mantissa and a common exponent.
const MAX_TEXEL: f32 = 65_408.0;

/// A panorama ready for the device.
#[derive(Debug)]
pub(super) struct Panorama {
    pub(super) size: [u32; 2],
    /// RGB9E5, row by row.
    pub(super) texels: Vec<u32>,
    /// What texels are multiplied by.
    pub(super) scale: f32,
    /// Cells, columns and rows, and their records.
    pub(super) grid: [u32; 2],
    pub(super) cells: Vec<[u32; 4]>,
    /// Mean of the luminance over all directions.
    pub(super) mean: f64,
}

impl Panorama {
    pub(super) fn new(environment: &Environment) -> Self {
        let mut size = environment.size;
        let mut texels = environment.texels.clone();
        while size.iter().any(|&side| side > MAX_SIDE) {
            (size, texels) = halved(size, &texels);
        }
        let most = texels.iter().flatten().fold(0.0_f32, |a, &b| a.max(b));
        let scale = (most / MAX_TEXEL).max(1.0);
        let texels: Vec<u32> = texels
            .iter()
            .map(|texel| rgb9e5(texel.map(|c| c / scale)))
            .collect();
        let luminance: Vec<f64> = texels
            .iter()
            .map(|&texel| super::luminance(decoded(texel)) * f64::from(scale))
            .collect();
        let grid = [size[0].min(MAX_CELLS[0]), size[1].min(MAX_CELLS[1])];
        let (cells, mean) = cells(size, &filtered(size, &luminance), grid);
        Self {
            size,
            texels,
            scale,
            grid,
            cells,
            mean,
        }
    }
}

/// Both sides halved, rounded up.
fn halved([width, height]: [u32; 2], texels: &[[f32; 3]]) -> ([u32; 2], Vec<[f32; 3]>) {
    let size = [width.div_ceil(2), height.div_ceil(2)];
    let at = |x: u32, y: u32| {
        let (x, y) = (x.min(width - 1) as usize, y.min(height - 1) as usize);
        texels[y * width as usize + x]
    };
    let mut made = Vec::with_capacity(size[0] as usize * size[1] as usize);
    for y in 0..size[1] {
        for x in 0..size[0] {
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| at(2 * x + i, 2 * y + j));
            made.push([0, 1, 2].map(|c| four.iter().map(|texel| 0.25 * texel[c]).sum()));
        }
    }
    (size, made)
}

/// What each texel shows on average where the sampler mixes it with its neighbours: an eighth of each.
fn filtered([width, height]: [u32; 2], values: &[f64]) -> Vec<f64> {
    let (width, height) = (width as usize, height as usize);
    let mix = |before: f64, value: f64, after: f64| 0.75 * value + 0.125 * (before + after);
    let mut across = Vec::with_capacity(values.len());
    for row in values.chunks_exact(width) {
        // The panorama closes round the horizon.
        across.extend(
            (0..width).map(|x| mix(row[(x + width - 1) % width], row[x], row[(x + 1) % width])),
        );
    }
    let at = |x: usize, y: usize| across[y * width + x];
    (0..width * height)
        .map(|index| (index % width, index / width))
        .map(|(x, y)| {
            mix(
                at(x, y.saturating_sub(1)),
                at(x, y),
                at(x, (y + 1).min(height - 1)),
            )
        })
        .collect()
}

/// Records of the cells, and the mean of `values` over all directions.
fn cells(
    [width, height]: [u32; 2],
    values: &[f64],
    [columns, rows]: [u32; 2],
) -> (Vec<[u32; 4]>, f64) {
    // Solid angle of a cell or texel in row `y` of `height` rows.
    let angle = |y: u32, height: u32, width: u32| {
        let edge = |y: u32| (PI * f64::from(y) / f64::from(height)).cos();
        (edge(y) - edge(y + 1)) * 2.0 * PI / f64::from(width)
    };
    let mut weights = vec![0.0; columns as usize * rows as usize];
    // No product of two sides is more than 2^23.
    let place = |at: u32, count: u32, cells: u32| (at * cells / count) as usize;
    let mut rest = values.iter();
    for y in 0..height {
        let texel = angle(y, height, width);
        let row = place(y, height, rows) * columns as usize;
        for (x, value) in (0..width).zip(&mut rest) {
            weights[row + place(x, width, columns)] += value * texel;
        }
    }
    let sum: f64 = weights.iter().sum();
    let records = alias::table(&weights)
        .into_iter()
        .zip(&weights)
        .zip(0_u32..)
        .map(|((choice, weight), index)| {
            let chance = match sum > 0.0 {
                true => weight / sum,
                false => 1.0 / weights.len() as f64,
            };
            let density = chance / angle(index / columns, rows, columns);
            [
                choice.threshold.to_bits(),
                choice.alias,
                super::single(density).to_bits(),
                0,
            ]
        })
        .collect();
    (records, sum / (4.0 * PI))
}

/// Nine bits a channel and an exponent of five, as the texture format has them.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "at most nine bits, of what is not negative"
)]
fn rgb9e5(color: [f32; 3]) -> u32 {
    let most = color.iter().fold(0.0_f32, |a, &b| a.max(b));
    if most < 1.0e-9 {
        return 0;
    }
    // The exponent for which the largest channel is below 512, the rounding included.
    let mut exponent = (most.log2().floor() as i32).max(-16) + 1;
    if (most * 2.0_f32.powi(9 - exponent)).round() >= 512.0 {
        exponent += 1;
    }
    let scale = 2.0_f32.powi(9 - exponent);
    let [r, g, b] = color.map(|c| ((c * scale).round() as u32).min(511));
    r | g << 9 | b << 18 | ((exponent + 15).clamp(0, 31) as u32) << 27
}

fn decoded(texel: u32) -> [f32; 3] {
    let exponent = (texel >> 27) as f32 - 15.0 - 9.0;
    [0, 9, 18].map(|shift| (texel >> shift & 511) as f32 * exponent.exp2())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_keep_their_colour_to_nine_bits() {
        for peak in [1.0e-4_f32, 0.02, 0.999, 1.0, 1.5, 63.99, 65_408.0] {
            for color in [[peak; 3], [peak, 0.3 * peak, 0.0], [0.0, 0.01 * peak, peak]] {
                let back = decoded(rgb9e5(color));
                for (a, b) in color.into_iter().zip(back) {
                    assert!((a - b).abs() <= peak / 511.0, "{color:?} became {back:?}");
                }
            }
        }
        assert_eq!(decoded(rgb9e5([0.0; 3])), [0.0; 3]);
    }

    #[test]
    fn cells_cover_all_directions_once() {
        let texel = |i: u16| [f32::from(i % 13), 0.5, f32::from(i % 7)];
        for size in [[1, 1], [8, 4], [33, 17], [1500, 3]] {
            let count = u16::try_from(size[0] * size[1]).unwrap();
            let environment = Environment::new(size, (0..count).map(texel).collect());
            let made = Panorama::new(&environment);
            let [columns, rows] = made.grid;
            let mut sum = 0.0;
            for (index, cell) in (0..).zip(&made.cells) {
                let edge = |row: u32| (PI * f64::from(row) / f64::from(rows)).cos();
                let row = index / columns;
                let angle = (edge(row) - edge(row + 1)) * 2.0 * PI / f64::from(columns);
                sum += f64::from(f32::from_bits(cell[2])) * angle;
            }
            assert!((sum - 1.0).abs() < 1.0e-5, "{size:?}: {sum}");
        }
    }

    #[test]
    fn what_is_too_large_is_halved() {
        let environment = Environment::new([20_000, 2], vec![[1.0, 2.0, 4.0]; 40_000]);
        let made = Panorama::new(&environment);
        assert_eq!(made.size, [5000, 1]);
        assert_eq!(decoded(made.texels[17]), [1.0, 2.0, 4.0]);
        let bright = Environment::new([2, 1], vec![[1.0e6; 3], [10.0; 3]]);
        let made = Panorama::new(&bright);
        let [shown, ..] = decoded(made.texels[0]).map(|c| c * made.scale);
        assert!((shown - 1.0e6).abs() < 2000.0, "{shown}");
    }
}
