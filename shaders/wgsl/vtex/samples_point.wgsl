//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/segment
// What a lookup samples, as seen from one cell of the file; a walk speaks of samples as bits of a
// mask. Here one sample at the lookup itself.

struct VtexSamples {
    // After texture matrix and address mode.
    uv: vec2f,
    // Inside the file's cell, in [0, 1].
    q: vec2f,
    // In units of the cell's box.
    p: vec2f,
}

// The windings of all samples about one outline; zeros at its start.
alias VtexWinding = i32;

const VTEX_SAMPLES_EVERY: u32 = 1u;
// How far a box may reach beyond its sides, in uv: as much as rounding may take. Images that abut have
// sides that are rounded each by itself.
const VTEX_SAMPLES_SLACK: f32 = 1.2e-7;

fn vtex_samples_in_cell(vt: VtexTexture, lookup: VtexLookup, q: vec2f) -> VtexSamples {
    return VtexSamples(lookup.uv, q, q * vt.curve_units.x + vt.curve_units.y);
}

// Adds what a segment does to the windings.
fn vtex_samples_wind(samples: VtexSamples, winding: VtexWinding, command: vec4u) -> VtexWinding {
    return winding + vtex_segment_winding(command, samples.p);
}

// The samples that an entry with this tag covers.
fn vtex_samples_filled(winding: VtexWinding, tag: u32) -> u32 {
    let base = bitcast<i32>(tag << VTEX_CMD_BASE_LEFT) >> VTEX_CMD_BASE_RIGHT;
    let total = winding + base;
    let filled = select(total != 0, (total & 1) != 0, (tag & VTEX_CMD_EVEN_ODD_BIT) != 0u);
    return select(0u, 1u, filled);
}

// The samples in a box, in uv: its corner of least coordinates, then the other.
fn vtex_samples_within(vt: VtexTexture, samples: VtexSamples, box: vec4f) -> u32 {
    let low = box.xy - VTEX_SAMPLES_SLACK;
    let high = box.zw + VTEX_SAMPLES_SLACK;
    let inside = all(samples.uv >= low) && all(samples.uv <= high);
    return select(0u, VTEX_SAMPLES_EVERY, inside);
}

// The mean of samples, in uv.
fn vtex_samples_uv(samples: VtexSamples, mask: u32) -> vec2f {
    return samples.uv;
}

// The place of one sample inside the file's cell.
fn vtex_samples_q(samples: VtexSamples, index: u32) -> vec2f {
    return samples.q;
}

// The place of the lookup inside the file's cell.
fn vtex_samples_centre(samples: VtexSamples) -> vec2f {
    return samples.q;
}
