//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/hit
// No distance outline.

fn vtex_ring(
    vt: VtexTexture, lookup: VtexLookup, hit: VtexHit, samples: VtexSamples, covered: u32, command: vec4u,
) -> VtexHit {
    return hit;
}
