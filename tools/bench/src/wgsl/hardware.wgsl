// The baseline: a mip-mapped sRGB texture through the sampler.

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var trilinear: sampler;

fn bench_sample(uv: vec2f, footprint: vec4f) -> vec4f {
    let size = vec2f(textureDimensions(picture));
    let width_texels = max(length(footprint.xy * size), length(footprint.zw * size));
    return textureSampleLevel(picture, trilinear, uv, max(log2(width_texels), 0.0));
}
