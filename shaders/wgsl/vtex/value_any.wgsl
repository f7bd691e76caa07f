//!use core/layout
//!use vtex/settings
// What a lookup carries where some of a scene's textures are masks: their alpha is spread last.

alias VtexValue = vec4f;

fn vtex_value_alpha(value: VtexValue) -> f32 {
    return value.a;
}

fn vtex_value_result(vt: VtexTexture, value: VtexValue) -> vec4f {
    return select(value, vec4f(value.a), vtex_settings_has(vt, VTEX_FEATURE_MASK));
}
