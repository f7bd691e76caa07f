//! As many files as wanted, and lookups in them.

use anyhow::{Context as _, Result};
use rayon::prelude::*;
use vtex_format::VtexFile;
use vtex_runtime::{TextureHandle, TextureQuery};

/// Part of a canvas' side that a run of lookups crosses.
const WINDOW: f32 = 1.0 / 8.0;

/// The bytes of `count` files: those there are, then the same with other single colours.
pub(in crate::tables) fn changed(
    files: &[(String, VtexFile)],
    count: usize,
) -> Result<Vec<Vec<u8>>> {
    anyhow::ensure!(!files.is_empty(), "no files to measure with");
    let change = |index: usize| {
        let (name, file) = &files[index % files.len()];
        let mut file = file.clone();
        // By so many codes, a channel after the other.
        let step = index / files.len();
        for paint in &mut file.paints {
            if step > 0 && !paint.is_gradient() {
                let channel = &mut paint.color[step % 3];
                *channel = (*channel + step as f32 / 255.0).fract();
            }
        }
        file.to_bytes().with_context(|| name.clone())
    };
    (0..count).into_par_iter().map(change).collect()
}

/// `count` lookups of points: each `run` of them follow each other in one texture, which is chosen at random
/// as is where the run begins.
pub(super) fn queries(handles: &[TextureHandle], count: usize, run: usize) -> Vec<TextureQuery> {
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        state >> 8
    };
    let mut queries = Vec::with_capacity(count);
    let unit = |bits: u32| bits as f32 / 16_777_216.0;
    while queries.len() < count {
        let handle = handles[random() as usize % handles.len()];
        let corner = [random(), random()].map(|bits| unit(bits) * (1.0 - WINDOW));
        // A square of pixels, as a tile of a screen is.
        let side = (run as f32).sqrt().ceil().max(1.0);
        let left = count - queries.len();
        queries.extend((0..run.min(left)).map(|i| {
            let [x, y] = [i as f32 % side, (i as f32 / side).floor()];
            TextureQuery {
                uv: [corner[0] + WINDOW / 64.0 * x, corner[1] + WINDOW / 64.0 * y],
                handle,
                ..TextureQuery::default()
            }
        }));
    }
    queries
}
