//! Texels as blocks of BC7, in its mode 6: two colours with alpha and sixteen steps between them, which suits
//! drawings, whose blocks hold one colour or an edge between two. Fast enough to be done at each load.
//!
//! Khronos Data Format 1.3, 20; Direct3D 11.3 Functional Specification, 19.5.

use std::sync::LazyLock;

/// Bytes of a block.
const BLOCK_BYTES: usize = 16;

/// Of the second colour, in 64ths, by index.
const WEIGHTS: [i32; 16] = [0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64];
/// Bits of the mode, and the one that is set.
const MODE_BITS: u32 = 7;
const MODE: u128 = 1 << 6;

type Color = [u8; 4];
type Texels = [Color; 16];

/// The block that shows `texels`, row by row.
pub(super) fn block(texels: &Texels) -> [u8; BLOCK_BYTES] {
    let first = texels[0];
    if texels.iter().all(|texel| *texel == first) {
        return even(first);
    }
    let [low, high] = ends(texels);
    let ends = [low, high].map(Stored::nearest);
    let colors = ends.map(Stored::color);
    assemble(ends, indices(texels, colors))
}

/// Two colours that the texels lie between: along the channel that differs most, and the others as they go
/// with it.
fn ends(texels: &Texels) -> [[f32; 4]; 2] {
    let of = |channel: usize| texels.iter().map(move |texel| f32::from(texel[channel]));
    let mean = [0, 1, 2, 3].map(|channel| of(channel).sum::<f32>() / 16.0);
    let mut axis = [0.0_f32; 4];
    let spread = |channel: usize| {
        of(channel)
            .map(|c| (c - mean[channel]).powi(2))
            .sum::<f32>()
    };
    let widest = (0..4).max_by(|&a, &b| spread(a).total_cmp(&spread(b)));
    let widest = widest.unwrap_or(0);
    for texel in texels {
        let by = f32::from(texel[widest]) - mean[widest];
        for channel in 0..4 {
            axis[channel] += by * (f32::from(texel[channel]) - mean[channel]);
        }
    }
    let length = axis.iter().map(|a| a * a).sum::<f32>().sqrt().max(1.0e-6);
    let axis = axis.map(|a| a / length);
    let along = |texel: &Color| -> f32 {
        (0..4)
            .map(|channel| axis[channel] * (f32::from(texel[channel]) - mean[channel]))
            .sum()
    };
    let places = texels.iter().map(along);
    let low = places.clone().fold(f32::INFINITY, f32::min);
    let high = places.fold(f32::NEG_INFINITY, f32::max);
    [low, high].map(|t| [0, 1, 2, 3].map(|c| (mean[c] + t * axis[c]).clamp(0.0, 255.0)))
}

/// A colour as a block stores it: seven bits a channel, and a last one that all four share.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Stored {
    high: [u8; 4],
    shared: u8,
}

impl Stored {
    /// What is nearest to a colour. What is opaque stays so, since drawings abut.
    fn nearest(color: [f32; 4]) -> Self {
        let with = |shared: u8| {
            let high = color.map(|c| seven_bits(c, shared));
            Self { high, shared }
        };
        let error = |stored: &Self| -> f32 {
            let shown = stored.color();
            (0..4)
                .map(|i| (f32::from(shown[i]) - color[i]).powi(2))
                .sum()
        };
        let (even, odd) = (with(0), with(1));
        if color[3] > 254.5 || (color[3] >= 0.5 && error(&odd) < error(&even)) {
            odd
        } else {
            even
        }
    }

    fn color(self) -> Color {
        self.high.map(|high| high << 1 | self.shared)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to seven bits"
)]
fn seven_bits(channel: f32, shared: u8) -> u8 {
    (0.5 * (channel - f32::from(shared)))
        .round()
        .clamp(0.0, 127.0) as u8
}

/// The step between two colours that is nearest to each texel.
fn indices(texels: &Texels, [low, high]: [Color; 2]) -> [u8; 16] {
    let axis = [0, 1, 2, 3].map(|c| f32::from(high[c]) - f32::from(low[c]));
    let scale = 15.0 / axis.iter().map(|a| a * a).sum::<f32>().max(1.0e-6);
    texels.map(|texel| {
        let along: f32 = (0..4)
            .map(|c| axis[c] * (f32::from(texel[c]) - f32::from(low[c])))
            .sum();
        nearest_index(along * scale)
    })
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to four bits"
)]
fn nearest_index(at: f32) -> u8 {
    at.round().clamp(0.0, 15.0) as u8
}

/// The bits of a block. Those of the first index have none for its half, so the colours change places where
/// it would be in the upper one.
fn assemble(ends: [Stored; 2], indices: [u8; 16]) -> [u8; BLOCK_BYTES] {
    let turned = indices[0] >= 8;
    let ends = if turned { [ends[1], ends[0]] } else { ends };
    let indices = indices.map(|index| if turned { 15 - index } else { index });
    let mut bits = MODE;
    let mut at = MODE_BITS;
    let mut push = |value: u8, count: u32| {
        bits |= u128::from(value) << at;
        at += count;
    };
    for channel in 0..4 {
        for end in ends {
            push(end.high[channel], 7);
        }
    }
    for end in ends {
        push(end.shared, 1);
    }
    for (position, index) in indices.into_iter().enumerate() {
        push(index, if position == 0 { 3 } else { 4 });
    }
    bits.to_le_bytes()
}

/// The block of one colour, exact in nearly all cases, and off by one in a channel in the rest.
fn even(color: Color) -> [u8; BLOCK_BYTES] {
    let best = EVEN.iter().min_by_key(|way| {
        let errors = color.map(|channel| way.channels[channel as usize].error);
        // What is opaque stays so.
        (
            errors[3],
            errors.iter().map(|&error| u32::from(error)).sum::<u32>(),
        )
    });
    let Some(way) = best else {
        return [0; BLOCK_BYTES];
    };
    let end = |end: usize| Stored {
        high: color.map(|channel| way.channels[channel as usize].high[end]),
        shared: way.shared[end],
    };
    assemble([end(0), end(1)], [way.index; 16])
}

/// A way to show one colour: shared bits of both ends, an index, and what each channel needs then.
struct Way {
    shared: [u8; 2],
    index: u8,
    channels: [Channel; 256],
}

#[derive(Clone, Copy, Default)]
struct Channel {
    high: [u8; 2],
    error: u8,
}

static EVEN: LazyLock<Vec<Way>> = LazyLock::new(|| {
    let mut ways = Vec::new();
    for shared in [[0, 0], [1, 1], [0, 1]] {
        // With equal shared bits both ends may be the colour, and any index will do.
        let indices: &[u8] = if shared[0] == shared[1] {
            &[0]
        } else {
            &[5, 7, 8, 10]
        };
        for &index in indices {
            let channels = std::array::from_fn(|color| channel(color, shared, index));
            ways.push(Way {
                shared,
                index,
                channels,
            });
        }
    }
    ways
});

/// The ends that show a channel best.
fn channel(color: usize, shared: [u8; 2], index: u8) -> Channel {
    let wanted = i32::try_from(color).unwrap_or(0);
    let weight = WEIGHTS[index as usize];
    let near = |shared: u8| {
        let middle = wanted >> 1;
        (middle - 2..=middle + 2)
            .filter_map(|high| u8::try_from(high).ok())
            .filter(|high| *high < 128)
            .map(move |high| (high, i32::from(high << 1 | shared)))
    };
    let mut best = Channel {
        high: [0; 2],
        error: u8::MAX,
    };
    for (low_bits, low) in near(shared[0]) {
        for (high_bits, high) in near(shared[1]) {
            let shown = ((64 - weight) * low + weight * high + 32) >> 6;
            let error = u8::try_from(shown.abs_diff(wanted)).unwrap_or(u8::MAX);
            if error < best.error {
                best = Channel {
                    high: [low_bits, high_bits],
                    error,
                };
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use block_compression::decode::decompress_blocks_as_rgba8;
    use block_compression::{BC7Settings, CompressionVariant};

    use super::*;

    fn shown(block: [u8; BLOCK_BYTES]) -> Texels {
        let mut bytes = [0; 64];
        let variant = CompressionVariant::BC7(BC7Settings::alpha_basic());
        decompress_blocks_as_rgba8(variant, 4, 4, &block, &mut bytes);
        let (texels, _) = bytes.as_chunks();
        std::array::from_fn(|i| texels[i])
    }

    /// Numbers that need no crate.
    fn random(state: &mut u32) -> [u8; 4] {
        *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (*state ^ *state >> 15).to_le_bytes()
    }

    #[test]
    fn one_colour_is_off_by_one_at_most() {
        let mut state = 1;
        let (mut off, mut worst) = (0, 0);
        for round in 0..20_000 {
            let [r, g, b, a] = random(&mut state);
            let color = match round % 3 {
                0 => [r, g, b, a],
                1 => [r, g, b, 255],
                _ => [r / 2, g / 2, 0, 128],
            };
            let found = shown(block(&[color; 16]));
            assert_eq!(found, [found[0]; 16], "{color:?}");
            let error = (0..4).map(|i| found[0][i].abs_diff(color[i])).max();
            off += usize::from(error != Some(0));
            worst = worst.max(error.unwrap_or(0));
            assert!(
                color[3] != 255 || found[0][3] == 255,
                "{color:?} stays opaque"
            );
        }
        assert_eq!(worst, 1);
        assert!(off < 200, "{off} of 20000 are off");
        assert_eq!(
            shown(block(&[[0; 4]; 16])),
            [[0; 4]; 16],
            "nothing stays nothing"
        );
    }

    #[test]
    fn edges_between_two_colours_keep_40_db() {
        let mut state = 7;
        let (mut sum, mut count) = (0.0, 0.0);
        for _ in 0..2000 {
            let [mut one, mut other] = [random(&mut state), random(&mut state)];
            // Premultiplied, as texels are; every second block is of an opaque shape over nothing.
            one = [one[0], one[1], one[2], 255];
            other = if state & 1 == 0 {
                [0; 4]
            } else {
                [other[0], other[1], other[2], 255]
            };
            let [a, b, c, _] = random(&mut state).map(f32::from);
            let texels: Texels = std::array::from_fn(|i| {
                let (x, y) = ((i % 4) as f32 - 1.5, (i / 4) as f32 - 1.5);
                let side = ((a - 128.0) * x + (b - 128.0) * y) / 64.0 + (c - 128.0) / 96.0;
                let share = (side + 0.5).clamp(0.0, 1.0);
                std::array::from_fn(|k| {
                    let mixed = share * f32::from(one[k]) + (1.0 - share) * f32::from(other[k]);
                    seven_bits(mixed, 0) << 1 | u8::from(mixed >= 254.0)
                })
            });
            let found = shown(block(&texels));
            for (texel, found) in texels.iter().zip(found) {
                for channel in 0..4 {
                    sum += f64::from(texel[channel].abs_diff(found[channel])).powi(2);
                    count += 1.0;
                }
                assert!(texel[3] != 255 || found[3] >= 254, "{texel:?} {found:?}");
            }
        }
        let db = 10.0 * (255.0 * 255.0 * count / sum).log10();
        assert!(db > 40.0, "{db} dB");
    }
}
