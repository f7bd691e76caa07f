//! The sRGB transfer function in `f64`: the tests' own, independent of the evaluator's.

/// Linear light of an encoded channel, both in \[0, 1\] (IEC 61966-2-1).
pub fn decode(encoded: f64) -> f64 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// Encoded channel of linear light, both in \[0, 1\] (IEC 61966-2-1).
pub fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        linear * 12.92
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_goes_through_its_known_points() {
        // 0.5 encoded is 0.214041 in linear light; the two pieces meet within the standard's rounding.
        let known = [
            (0.0, 0.0),
            (0.040_45, 0.003_130_8),
            (0.5, 0.214_041),
            (1.0, 1.0),
        ];
        for (encoded, linear) in known {
            assert!((decode(encoded) - linear).abs() < 1e-6, "{encoded}");
            assert!((encode(linear) - encoded).abs() < 1e-5, "{linear}");
        }
    }
}
