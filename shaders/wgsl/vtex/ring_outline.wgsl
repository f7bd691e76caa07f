//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/composite
//!use vtex/msdf_edge
//!use vtex/outline
// The ring that the distance outline draws around an MSDF entry, [SFG22] eq. 2.

fn vtex_ring(
    vt: VtexTexture, lookup: VtexLookup, composite: VtexComposite, samples: VtexSamples,
    covered: u32, command: vec4u,
) -> VtexComposite {
    let width = vtex_word_float(vt, VTEX_HEADER_OUTLINE_WIDTH);
    let msdf = (command.w & VTEX_CMD_KIND_MASK) == VTEX_CMD_MSDF;
    let control = (command.w & VTEX_CMD_CONTROL_BIT) != 0u;
    let rest = select(0u, composite.live & ~covered, msdf && !control && width > 0.0);
    let ring = vtex_msdf_covered(vt, samples, command.x, -width, rest);
    return vtex_composite_draw(vt, lookup, composite, samples, ring, vtex_outline_tag(vt));
}
