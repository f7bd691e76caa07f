//! Built-ins of WGSL that Rust lacks: no twin.

pub(super) fn clamp(x: f32, low: f32, high: f32) -> f32 {
    x.max(low).min(high)
}

pub(super) fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = clamp((x - low) / (high - low), 0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

pub(super) fn mix(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    std::array::from_fn(|i| a[i] * (1.0 - t) + b[i] * t)
}

/// The integer part of a float that is not negative; what does not fit saturates.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturation is what WGSL's u32() does; callers have clamped"
)]
pub(crate) fn to_u32(x: f32) -> u32 {
    x as u32
}

/// Counts of cells and texels, far below 2^24.
#[expect(clippy::cast_precision_loss, reason = "as WGSL's f32()")]
pub(crate) fn to_f32(x: u32) -> f32 {
    x as f32
}
