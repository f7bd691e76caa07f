//!use state/paths
// Answers of lookups.

@group(2) @binding(0) var<storage, read> stage_colors: array<vec4f>;

// The colour where a path, or its shadow ray, met a surface.
fn colors_at(path: u32, material: MaterialRecord) -> MaterialColor {
    let slot = state_word(path, STATE_LOOKUP).x;
    var texel = vec4f(0.0);
    if slot != TRACE_NONE {
        texel = stage_colors[slot];
    }
    return material_color(material, texel);
}

// Counts a see-through surface; false past the last.
fn colors_pass(path: u32) -> bool {
    var about = state_word(path, STATE_LOOKUP);
    about.z += 1u;
    state_set(path, STATE_LOOKUP, about);
    return about.z <= PATH_MAX_VEILS;
}
