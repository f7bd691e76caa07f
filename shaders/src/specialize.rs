//! From a key to the text of its shader: modules chosen, constants written, nothing else.

use vtex_format::{Features, MAX_BLEND_DEPTH, SHALLOW_BLEND_DEPTH, SpecKey};

use crate::link::{LinkContext, link};
use crate::spec::kernel_key;

/// Queries a workgroup of the batch kernel answers.
pub const BATCH_WORKGROUP: u32 = 64;

/// Workgroups a dispatch may have along an axis on every WebGPU device.
pub(crate) const MAX_WORKGROUPS: u32 = 65_535;

/// Where a texture is bound: its words, its texels and their sampler at successive bindings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BindingSlot {
    /// `@group`.
    pub group: u32,
    /// `@binding` of the words.
    pub binding: u32,
}

/// WGSL for other people's shaders: `fn vtex_sample(uv: vec2f, footprint: vec4f) -> vec4f`, and from
/// `slot` on its three bindings: `vtex_words`, a read-only storage buffer `array<vec4u>`; `vtex_texels`,
/// a `texture_2d_array<f32>` with the pages of [`TexelPages`](crate::TexelPages); and `vtex_sampler`,
/// a sampler with linear filters that clamps to the edge.
///
/// Every name in it starts with `vtex_`, `Vtex` or `VTEX_`. The bindings hold one packed texture of
/// this key. Same key and slot, same text.
pub fn fragment(key: &SpecKey, slot: BindingSlot) -> String {
    linked("root/fragment", &context(key, slot))
}

/// WGSL of the standalone batch kernel, entry point `vtex_batch`.
///
/// Group 0: bindings 0 to 2 the texture as in [`fragment`], binding 3 an array of
/// [`crate::layout::BatchQuery`], binding 4 the results, an array of `vec4f`. [`batch_dispatch`] gives
/// the workgroup counts; queries beyond either array's end are passed over.
pub fn batch_kernel(key: &SpecKey) -> String {
    linked("root/batch", &context(key, BindingSlot::default()))
}

/// Workgroup counts for `query_count` queries of the batch kernel.
pub fn batch_dispatch(query_count: u32) -> [u32; 3] {
    let groups = query_count.div_ceil(BATCH_WORKGROUP);
    // Rows as equal as they can be: fewer workgroups stand idle than there are rows.
    let rows = groups.div_ceil(MAX_WORKGROUPS);
    let columns = if rows == 0 { 0 } else { groups.div_ceil(rows) };
    [columns, rows, u32::from(rows != 0)]
}

/// WGSL with `fn vtex_sample_at(vt: u32, uv: vec2f, footprint: vec4f) -> vec4f` for several packed
/// textures one after the other in `vtex_words`, whose texels share `vtex_texels`; bindings from `slot`
/// on as in [`fragment`]. `vt` is a texture's first word.
///
/// `features` is the union of the textures' [`SpecKey::features`].
pub fn scene_evaluator(features: u32, slot: BindingSlot) -> String {
    linked("vtex/sample", &scene_context(features, slot))
}

/// The context in which a module that imports `vtex/sample` finds [`scene_evaluator`]'s modules.
pub fn scene_context(features: u32, slot: BindingSlot) -> LinkContext {
    context(&SpecKey { features }, slot)
}

/// `context` for a scene without instances: texts that import `trace/bvh` or `trace/surface` have no code
/// for them.
pub fn without_instances(context: LinkContext) -> LinkContext {
    context
        .fill("trace/world/traverse", "trace/world/traverse_one")
        .fill("trace/world/levels", "trace/world/levels_one")
}

/// `context` for a path tracer of scenes whose see-through textures tell nothing without a lookup: traversal
/// then reads no attributes and no materials.
pub fn without_cutouts(context: LinkContext) -> LinkContext {
    context.fill("trace/world/cutout", "trace/world/cutout_none")
}

/// Layers that a scene's surfaces have; see [`with_layers`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LayerKinds {
    /// Clear coats.
    pub coats: bool,
    /// Surfaces that light goes through by refraction.
    pub glass: bool,
    /// Colours of vertices.
    pub colors: bool,
}

/// `context` for a path tracer with code for these layers; without this, for all of them.
pub fn with_layers(context: LinkContext, kinds: LayerKinds) -> LinkContext {
    let text = flags([
        ("LAYERS_HAVE_COATS", kinds.coats),
        ("LAYERS_HAVE_GLASS", kinds.glass),
        ("LAYERS_HAVE_COLORS", kinds.colors),
    ]);
    context.define("trace/layer/kinds", text)
}

/// A module of constants that say what there is code for.
fn flags<const N: usize>(values: [(&str, bool); N]) -> String {
    let lines = values.map(|(name, value)| format!("const {name}: bool = {value};\n"));
    lines.concat()
}

/// Kinds of light that a scene has; see [`with_lights`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightKinds {
    /// Rectangles, and meshes that glow.
    pub areas: bool,
    /// Lights without size.
    pub punctual: bool,
    /// A panorama instead of the sky.
    pub environment: bool,
}

/// `context` for a path tracer with code for these kinds of light; without this, for all of them.
pub fn with_lights(context: LinkContext, kinds: LightKinds) -> LinkContext {
    let text = flags([
        ("LIGHTS_HAVE_AREAS", kinds.areas),
        ("LIGHTS_HAVE_PUNCTUAL", kinds.punctual),
        ("LIGHTS_HAVE_ENVIRONMENT", kinds.environment),
    ]);
    context.define("trace/light/kinds", text)
}

/// What the text of a key is linked from. The features say what there is code for; which of it a
/// texture uses, and everything else about it, the text reads from the texture's header.
fn context(key: &SpecKey, BindingSlot { group, binding }: BindingSlot) -> LinkContext {
    let features = kernel_key(key).features;
    let blend_depth = match features & Features::DEEP_GROUPS != 0 {
        true => MAX_BLEND_DEPTH,
        false => SHALLOW_BLEND_DEPTH,
    };
    let [texels, sampler] = [binding + 1, binding + 2];
    let text = format!(
        "@group({group}) @binding({binding}) var<storage, read> vtex_words: array<vec4u>;\n\
         @group({group}) @binding({texels}) var vtex_texels: texture_2d_array<f32>;\n\
         @group({group}) @binding({sampler}) var vtex_sampler: sampler;\n\n\
         const VTEX_KEY_FEATURES: u32 = {features}u;\n\
         const VTEX_KEY_BLEND_DEPTH: u32 = {blend_depth}u;\n"
    );
    slots(features).define("vtex/key", text)
}

/// The modules that a set of features needs: every variant of the evaluator is here.
fn slots(features: u32) -> LinkContext {
    let has = |feature: u32| features & feature != 0;
    let pick = |feature, with, without| if has(feature) { with } else { without };
    let lists = match (has(Features::LISTS), has(Features::GROUPS)) {
        (false, _) => "lists_none",
        (true, false) => "lists_draws",
        (true, true) => "lists_groups",
    };
    let composite = match (has(Features::TRANSLUCENT), has(Features::FOOTPRINT)) {
        (false, false) => "composite_first",
        (false, true) => "composite_first_rows",
        (true, false) => "composite_over",
        (true, true) => "composite_over_rows",
    };
    let edge = match (has(Features::CURVES), has(Features::MSDF)) {
        (false, false) => "edge_none",
        (true, false) => "edge_curves",
        (false, true) => "edge_msdf",
        (true, true) => "edge_any",
    };
    let table = [
        (
            "mapping",
            pick(Features::MAPPING, "mapping_any", "mapping_clamp"),
        ),
        (
            "samples",
            pick(Features::FOOTPRINT, "samples_rows", "samples_point"),
        ),
        (
            "region",
            pick(Features::FOOTPRINT, "region_long", "region_round"),
        ),
        (
            "picture",
            pick(Features::FOOTPRINT, "picture_rows", "picture_point"),
        ),
        ("lists", lists),
        ("draws", pick(Features::PAPER, "draws_paper", "draws_walk")),
        ("composite", composite),
        ("edge", edge),
        ("ring", pick(Features::OUTLINE, "ring_outline", "ring_none")),
        (
            "paint",
            pick(Features::GRADIENTS, "paint_gradient", "paint_solid"),
        ),
        (
            "brush",
            pick(Features::IMAGES, "brush_image", "brush_paint"),
        ),
    ];
    table
        .into_iter()
        .fold(LinkContext::default(), |context, (slot, module)| {
            context.fill(&format!("vtex/{slot}"), &format!("vtex/{module}"))
        })
}

pub(crate) fn linked(root: &str, context: &LinkContext) -> String {
    link(root, context).expect("the crate's own modules link: a test tries every key")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn every_key() -> impl Iterator<Item = SpecKey> {
        let sets = (0..=Features::ALL).map(|features| kernel_key(&SpecKey { features }));
        let keys: BTreeSet<u32> = sets.map(|key| key.features).collect();
        keys.into_iter().map(|features| SpecKey { features })
    }

    #[test]
    fn every_key_links_the_same_text_twice() {
        for key in every_key() {
            let slot = BindingSlot {
                group: 3,
                binding: 7,
            };
            let text = fragment(&key, slot);
            assert_eq!(text, fragment(&key, slot));
            assert!(text.contains("@group(3) @binding(7) var<storage, read> vtex_words"));
            assert!(text.contains("@group(3) @binding(8) var vtex_texels"));
            assert!(text.contains("@group(3) @binding(9) var vtex_sampler"));
            assert!(batch_kernel(&key).contains("fn vtex_batch("));
            assert!(scene_evaluator(key.features, slot).contains("fn vtex_sample_at("));
        }
    }

    #[test]
    fn dispatches_cover_every_query_within_the_limits() {
        assert_eq!(batch_dispatch(0), [0, 0, 0]);
        for count in [1, 64, 65, 1_000_000, 65_535 * 64, 65_535 * 64 + 1, u32::MAX] {
            let [x, y, z] = batch_dispatch(count);
            assert!(
                x <= MAX_WORKGROUPS && y <= MAX_WORKGROUPS && z == 1,
                "{count}"
            );
            let lanes = u64::from(x) * u64::from(y) * u64::from(BATCH_WORKGROUP);
            let spare = lanes - u64::from(count);
            assert!(
                spare < u64::from(BATCH_WORKGROUP * (y + 1)),
                "{count}: {spare} idle lanes"
            );
        }
    }
}
