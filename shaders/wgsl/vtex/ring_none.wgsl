//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/composite
// No distance outline.

fn vtex_ring(
    vt: VtexTexture, lookup: VtexLookup, composite: VtexComposite, samples: VtexSamples,
    covered: u32, command: vec4u,
) -> VtexComposite {
    return composite;
}
