// Sums of samples.

// Of each pixel: premultiplied linear radiance, opacity.
@group(2) @binding(0) var<storage, read_write> film_sum: array<vec4f>;
// Rays traced for each pixel.
@group(2) @binding(1) var<storage, read_write> film_rays: array<u32>;

// A sample that is not a number would stay in its pixel for ever: it counts as black.
fn film_finite(color: vec4f) -> vec4f {
    let exponents = bitcast<vec4u>(color) & vec4u(0x7f800000u);
    return select(color, vec4f(0.0), any(exponents == vec4u(0x7f800000u)));
}
