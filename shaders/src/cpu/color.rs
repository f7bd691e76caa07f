//! Twin of `core/color.wgsl`: the sRGB transfer functions of IEC 61966-2-1.

use std::sync::LazyLock;

/// Linear light of the 256 codes of an 8-bit channel.
pub(crate) static DECODED: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| decode_channel(code as f32 / 255.0)));

/// Linear light of one sRGB-encoded channel; below zero counts as zero.
pub fn decode_channel(encoded: f32) -> f32 {
    let c = encoded.max(0.0);
    if c <= 0.040_45 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// sRGB encoding of one linear-light channel; below zero counts as zero.
pub fn encode_channel(linear_light: f32) -> f32 {
    let c = linear_light.max(0.0);
    if c <= 0.003_130_8 {
        c * 12.92
    } else {
        1.055 * c.powf(1.0 / 2.4) - 0.055
    }
}

/// Linear light of a straight, sRGB-encoded colour.
pub fn decode(encoded: [f32; 3]) -> [f32; 3] {
    encoded.map(decode_channel)
}

/// sRGB encoding of a straight, linear-light colour.
pub fn encode(linear_light: [f32; 3]) -> [f32; 3] {
    linear_light.map(encode_channel)
}

/// Linear light of a premultiplied, sRGB-encoded colour, premultiplied.
pub fn decode_premultiplied(encoded: [f32; 4]) -> [f32; 4] {
    apply_straight(decode, encoded)
}

/// sRGB encoding of a premultiplied, linear-light colour, premultiplied.
pub fn encode_premultiplied(linear_light: [f32; 4]) -> [f32; 4] {
    apply_straight(encode, linear_light)
}

fn apply_straight(transfer: fn([f32; 3]) -> [f32; 3], [r, g, b, a]: [f32; 4]) -> [f32; 4] {
    if a <= 0.0 {
        return [0.0; 4];
    }
    let [r, g, b] = transfer([r / a, g / a, b / a]);
    [r * a, g * a, b * a, a]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        // IEC 61966-2-1: encoded mid grey, the linear piece and the ends.
        for (encoded, linear_light) in [(0.5, 0.214_041_14), (0.02, 0.001_547_99), (1.0, 1.0)] {
            assert!(
                (decode([encoded; 3])[0] - linear_light).abs() < 1e-6,
                "{encoded}"
            );
            assert!(
                (encode([linear_light; 3])[1] - encoded).abs() < 1e-6,
                "{encoded}"
            );
        }
        assert_eq!(decode([-1.0, 0.0, -0.0]), [0.0; 3]);
    }

    #[test]
    fn premultiplied_colours_go_through_straight_ones() {
        let linear_light = decode_premultiplied([0.25, 0.1, 0.0, 0.5]);
        assert!(
            (linear_light[0] - 0.5 * 0.214_041_14).abs() < 1e-6,
            "{linear_light:?}"
        );
        let back = encode_premultiplied(linear_light);
        assert!((back[1] - 0.1).abs() < 1e-6, "{back:?}");
        assert_eq!(decode_premultiplied([0.3, 0.3, 0.3, 0.0]), [0.0; 4]);
    }
}
