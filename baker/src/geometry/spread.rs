//! Points spread evenly over a square, without randomness.

/// Point `k` of the additive recurrence R2 of Roberts (2018), in \[0, 1)^2. Any range of
/// consecutive points covers the square about evenly.
pub(crate) fn spread_point(k: u32) -> [f64; 2] {
    let at = |share: f64| (f64::from(k) * share).fract();
    [at(0.754_877_666_246_692_8), at(0.569_840_290_998_053_3)]
}
