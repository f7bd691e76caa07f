//! From a key to the text of its shader: modules chosen, constants written, nothing else.

use std::fmt::Write as _;

use vtex_format::{AddressMode, Features, MAX_ENTRIES_PER_CELL, MAX_FRAMES, SpecKey};

use crate::link::{LinkContext, link};
use crate::spec::{is_composited, normalized};

/// Queries a workgroup of the batch kernel answers.
pub const BATCH_WORKGROUP: u32 = 64;

/// Workgroups a dispatch may have along an axis on every WebGPU device.
const MAX_WORKGROUPS: u32 = 65_535;

/// Where the words of the texture are bound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BindingSlot {
    /// `@group`.
    pub group: u32,
    /// `@binding`.
    pub binding: u32,
}

/// WGSL for other people's shaders: declares `vtex_words`, a read-only storage buffer
/// `array<vec4u>` at `slot`, and `fn vtex_sample(uv: vec2f, footprint: vec4f) -> vec4f`.
///
/// Every name in it starts with `vtex_`, `Vtex` or `VTEX_`. The buffer holds one packed texture
/// of this key. Same key and slot, same text.
pub fn fragment(key: &SpecKey, slot: BindingSlot) -> String {
    linked("root/fragment", &single_context(key, slot))
}

/// WGSL of the standalone batch kernel, entry point `vtex_batch`.
///
/// Group 0: binding 0 the words, binding 1 an array of [`crate::layout::BatchQuery`], binding 2
/// the results, an array of `vec4f`. [`batch_dispatch`] gives the workgroup counts; queries
/// beyond either array's end are passed over.
pub fn batch_kernel(key: &SpecKey) -> String {
    linked("root/batch", &single_context(key, BindingSlot::default()))
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
/// textures one after the other in `vtex_words` at `slot`; `vt` is a texture's first word.
///
/// `features` is the union of the textures' [`SpecKey::features`].
pub fn scene_evaluator(features: u32, slot: BindingSlot) -> String {
    linked("vtex/sample", &scene_context(features, slot))
}

/// The context in which a module that imports `vtex/sample` finds [`scene_evaluator`]'s modules.
pub fn scene_context(features: u32, slot: BindingSlot) -> LinkContext {
    let key = normalized(&SpecKey {
        abi: 0,
        features,
        // Not in the text of a scene, which reads them from the header of each texture.
        address_u: AddressMode::Border,
        address_v: AddressMode::Border,
        texels_per_cell: 1,
        // The bounds of any file: one text serves textures that are not known yet.
        max_entries: MAX_ENTRIES_PER_CELL,
        frames: MAX_FRAMES,
        reserved: 0,
    });
    let has = |feature: u32| key.features & feature != 0;
    // Some textures may be masks and others not: all are looked up in colour.
    let value = if has(Features::MASK) {
        "value_any"
    } else {
        "value_color"
    };
    let constants = format!(
        "const VTEX_KEY_MAX_ENTRIES: u32 = {}u;\nconst VTEX_KEY_FRAMES: u32 = {}u;\n",
        key.max_entries, key.frames
    );
    let features = key.features & !Features::MASK;
    let ramps = has(Features::RAMPS) || has(Features::OUTLINE);
    let context = slots(features);
    let context = if has(Features::CLIPS) && ramps {
        context.fill("vtex/flat", "vtex/flat_any")
    } else {
        context
    };
    context
        .define("vtex/key", binding(slot) + &constants)
        .fill("vtex/value", &format!("vtex/{value}"))
        .fill("vtex/settings", "vtex/settings_header")
        .fill("vtex/address", "vtex/address_any")
}

fn single_context(key: &SpecKey, slot: BindingSlot) -> LinkContext {
    let key = normalized(key);
    // The default, which needs no choice between modes.
    let clamps = [key.address_u, key.address_v] == [AddressMode::Clamp; 2];
    let mut text = binding(slot);
    for (name, value) in [
        ("FEATURES", key.features),
        ("ADDRESS_U", key.address_u as u32),
        ("ADDRESS_V", key.address_v as u32),
        ("TEXELS_PER_CELL", key.texels_per_cell),
        ("MAX_ENTRIES", key.max_entries),
        ("FRAMES", key.frames),
    ] {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "const VTEX_KEY_{name}: u32 = {value}u;");
    }
    slots(key.features)
        .define("vtex/key", text)
        .fill("vtex/settings", "vtex/settings_key")
        .fill(
            "vtex/address",
            if clamps {
                "vtex/address_clamp"
            } else {
                "vtex/address_any"
            },
        )
}

fn binding(BindingSlot { group, binding }: BindingSlot) -> String {
    format!("@group({group}) @binding({binding}) var<storage, read> vtex_words: array<vec4u>;\n\n")
}

/// The modules that a set of features needs.
fn slots(features: u32) -> LinkContext {
    // A mask's groups blend and weigh in colour; alpha is spread last.
    let spread = features & Features::MASK != 0 && is_composited(features);
    let features = if spread {
        features & !Features::MASK
    } else {
        features
    };
    let has = |feature: u32| features & feature != 0;
    let pick = |feature: u32, with: &'static str, without: &'static str| {
        if has(feature) { with } else { without }
    };
    let fixed = [
        (
            "vtex/matrix",
            pick(
                Features::TEXTURE_MATRIX,
                "vtex/matrix_affine",
                "vtex/matrix_identity",
            ),
        ),
        (
            "vtex/value",
            match (spread, has(Features::MASK)) {
                (true, _) => "vtex/value_any",
                (false, true) => "vtex/value_mask",
                (false, false) => "vtex/value_color",
            },
        ),
        (
            "vtex/paint",
            pick(Features::MASK, "vtex/paint_alpha", "vtex/paint_color"),
        ),
        (
            "vtex/texel",
            pick(Features::MASK, "vtex/texel_alpha", "vtex/texel_color"),
        ),
        (
            "vtex/minify",
            pick(Features::MIPS, "vtex/minify_mips", "vtex/minify_none"),
        ),
        (
            "vtex/source",
            pick(Features::IMAGES, "vtex/source_image", "vtex/source_paint"),
        ),
        (
            "vtex/entry",
            pick(Features::OUTLINE, "vtex/entry_outline", "vtex/entry_shape"),
        ),
        (
            "vtex/over",
            pick(Features::OUTLINE, "vtex/over_outline", "vtex/over_shape"),
        ),
    ];
    fixed
        .into_iter()
        .chain(cell_slots(features))
        .chain(paint_slots(features))
        .chain(scope_slots(features))
        .fold(LinkContext::default(), |context, (slot, module)| {
            context.fill(slot, module)
        })
}

/// The modules that know kinds of paints.
fn paint_slots(features: u32) -> [(&'static str, &'static str); 4] {
    let has = |feature: u32| features & feature != 0;
    let fill = match (has(Features::GRADIENTS), has(Features::MASK)) {
        (false, _) => "vtex/fill_solid",
        (true, false) => "vtex/fill_gradient",
        (true, true) => "vtex/fill_gradient_alpha",
    };
    let encoded = match (has(Features::GRADIENTS), has(Features::IMAGES)) {
        (true, _) => "vtex/encoded_gradient",
        (false, true) => "vtex/encoded_image",
        (false, false) => "vtex/encoded_solid",
    };
    let hit = match (has(Features::TRANSLUCENT), has(Features::MASK)) {
        (false, _) => "vtex/hit_first",
        (true, true) => "vtex/hit_alpha",
        (true, false) if has(Features::GRADIENTS) => "vtex/hit_over_gradient",
        (true, false) => "vtex/hit_over",
    };
    let tint = match (has(Features::GRADIENTS), has(Features::IMAGES)) {
        (false, _) => "vtex/tint_source",
        (true, false) => "vtex/tint_paint",
        (true, true) => "vtex/tint_image",
    };
    [
        ("vtex/fill", fill),
        ("vtex/tint", tint),
        ("vtex/encoded", encoded),
        ("vtex/hit", hit),
    ]
}

/// The modules that answer from cells.
fn cell_slots(features: u32) -> [(&'static str, &'static str); 6] {
    let has = |feature: u32| features & feature != 0;
    // A mask composites alpha alone, which any order of entries gives.
    let composites = has(Features::TRANSLUCENT) && !has(Features::MASK);
    let edges = has(Features::MSDF) || has(Features::CURVES);
    let coverage = match (edges, has(Features::OUTLINE)) {
        (false, _) => "vtex/coverage_full",
        (true, false) => "vtex/coverage_edge",
        (true, true) => "vtex/coverage_outline",
    };
    let edge = match (has(Features::MSDF), has(Features::CURVES)) {
        (true, true) => "vtex/edge_any",
        (false, true) => "vtex/edge_curves",
        // Without edges nothing imports it.
        (_, false) => "vtex/edge_msdf",
    };
    // [SFG22] eq. 2 draws by distance in every filter mode.
    let ramps = has(Features::RAMPS) || has(Features::OUTLINE);
    let composite = match composites {
        true => "vtex/composite_ramp",
        false => "vtex/composite_front",
    };
    let one_kind = has(Features::MSDF) != has(Features::CURVES);
    let one_walk = !composites && !has(Features::OUTLINE) && one_kind;
    let cells = match (has(Features::LISTS), ramps, one_walk) {
        (true, true, true) => "vtex/cells_ramp",
        (true, true, false) => "vtex/cells_list",
        (true, false, _) => "vtex/cells_point",
        (false, _, _) => "vtex/cells_solid",
    };
    let reach = match has(Features::CURVES) {
        true => "vtex/reach_curves",
        false => "vtex/reach_msdf",
    };
    let inside = match (has(Features::MSDF), has(Features::CURVES)) {
        (true, true) => "vtex/inside_any",
        (false, true) => "vtex/inside_curves",
        (true, false) => "vtex/inside_msdf",
        (false, false) => "vtex/inside_full",
    };
    [
        ("vtex/cells", cells),
        ("vtex/reach", reach),
        ("vtex/inside", inside),
        ("vtex/coverage", coverage),
        ("vtex/edge", edge),
        ("vtex/composite", composite),
    ]
}

/// The modules for lists that clip and group.
fn scope_slots(features: u32) -> [(&'static str, &'static str); 7] {
    let has = |feature: u32| features & feature != 0;
    let ramps = has(Features::RAMPS) || has(Features::OUTLINE);
    let picture = match is_composited(features) {
        true => "vtex/picture_scopes",
        false => "vtex/picture_flat",
    };
    let flat = match has(Features::CLIPS) && !ramps {
        true => "vtex/flat_clips",
        false => "vtex/flat_cells",
    };
    let flow = match (has(Features::CLIPS), ramps) {
        (false, _) => "vtex/flow_none",
        (true, false) => "vtex/flow_point",
        (true, true) => "vtex/flow_ramp",
    };
    let group = match has(Features::GROUPS) {
        true => "vtex/group_frames",
        false => "vtex/group_none",
    };
    let blend = match has(Features::BLENDS) {
        true => "vtex/blend_modes",
        false => "vtex/blend_normal",
    };
    let [scopes, tone] = match ramps {
        true => ["vtex/scopes_ramp", "vtex/tone_linear"],
        false => ["vtex/scopes_point", "vtex/tone_encoded"],
    };
    [
        ("vtex/picture", picture),
        ("vtex/flat", flat),
        ("vtex/flow", flow),
        ("vtex/group", group),
        ("vtex/blend", blend),
        ("vtex/scopes", scopes),
        ("vtex/tone", tone),
    ]
}

fn linked(root: &str, context: &LinkContext) -> String {
    link(root, context).expect("the crate's own modules link: a test tries every key")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn every_key() -> impl Iterator<Item = SpecKey> {
        (0..=Features::ALL).step_by(5).map(|features| SpecKey {
            abi: vtex_format::SHADER_ABI,
            features,
            address_u: AddressMode::ALL[(features & 3) as usize],
            address_v: AddressMode::ALL[(features >> 2 & 3) as usize],
            texels_per_cell: 1 + features % 16,
            max_entries: features,
            frames: 0,
            reserved: 0,
        })
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
