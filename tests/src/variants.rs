//! The texts of the evaluator that can exist: what the one table of modules chooses for any key.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;
use vtex_format::{Features, SpecKey};
use vtex_shaders::{BindingSlot, batch_kernel, hash, kernel_key, link, scene_context};

/// Starts the lines in which texts with the same modules differ: constants, by which the text leaves
/// a branch out or takes more memory.
const KEY: &str = "const VTEX_KEY_";
/// Starts the line above a module's text.
const MODULE: &str = "// vtex/";

/// One text, up to the constants of its key.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Bits of [`Features`]: one of the sets that lead to it.
    pub features: u32,
    /// The names of its modules.
    pub modules: BTreeSet<String>,
}

impl Variant {
    /// Its key.
    pub const fn key(&self) -> SpecKey {
        SpecKey {
            features: self.features,
        }
    }
}

/// Every text that can exist, once: those of single textures, of which a loader filters each in one
/// mode, and those of scenes, whose textures may be filtered in several.
pub fn variants() -> Vec<Variant> {
    let all = (0..=Features::ALL).into_par_iter();
    let own = |&features: &u32| kernel_key(&SpecKey { features }).features == features;
    let hashed = all.filter(own).map(|features| {
        let text = text(features);
        (hash(&text), features)
    });
    let mut sets: BTreeMap<[u8; 32], Vec<u32>> = BTreeMap::new();
    for (hash, features) in hashed.collect::<Vec<_>>() {
        sets.entry(hash).or_default().push(features);
    }
    let mut sets: Vec<Vec<u32>> = sets.into_values().collect();
    // By features, so that a change of one module leaves the others' order as it is.
    sets.sort_unstable();
    // Features that change constants alone differ from one variant to the next.
    let pick = |(index, sets): (usize, Vec<u32>)| {
        let features = sets[index % sets.len()];
        let text = text(features);
        let modules = text.lines().filter_map(|line| line.strip_prefix(MODULE));
        Variant {
            features,
            modules: modules.map(str::to_owned).collect(),
        }
    };
    sets.into_iter().enumerate().map(pick).collect()
}

/// Without its key's constants.
fn text(features: u32) -> String {
    let text = batch_kernel(&SpecKey { features });
    let lines = text.lines().filter(|line| !line.starts_with(KEY));
    lines.flat_map(|line| [line, "\n"]).collect()
}

/// Places of some variants, in which any two modules meet that meet in one of all.
pub fn covering(variants: &[Variant]) -> Vec<usize> {
    let pairs: Vec<BTreeSet<[&str; 2]>> = variants.iter().map(pairs).collect();
    let mut missing: BTreeSet<[&str; 2]> = pairs.iter().flatten().copied().collect();
    let mut chosen = Vec::new();
    while !missing.is_empty() {
        let new = |place: &usize| pairs[*place].intersection(&missing).count();
        let Some(place) = (0..variants.len()).max_by_key(new) else {
            break;
        };
        missing.retain(|pair| !pairs[place].contains(pair));
        chosen.push(place);
    }
    chosen
}

fn pairs(variant: &Variant) -> BTreeSet<[&str; 2]> {
    let names = || variant.modules.iter().map(String::as_str);
    let pairs = names().flat_map(|a| names().map(move |b| [a, b]));
    pairs.filter(|[a, b]| a < b).collect()
}

/// The batch kernel with the texture's first word in the query's padding.
///
/// # Panics
/// Never: its modules exist.
pub fn scene_kernel(features: u32) -> String {
    let root = "//!use core/query\n//!use vtex/sample\n\
        @group(0) @binding(3) var<storage, read> queries: array<VtexBatchQuery>;\n\
        @group(0) @binding(4) var<storage, read_write> results: array<vec4f>;\n\
        @compute @workgroup_size(64)\n\
        fn vtex_batch(@builtin(global_invocation_id) id: vec3u) {\n    \
            if id.x < arrayLength(&queries) {\n        \
                let query = queries[id.x];\n        \
                let vt = bitcast<u32>(query.padding.x);\n        \
                results[id.x] = vtex_sample_at(vt, query.uv, query.footprint);\n    \
            }\n\
        }\n";
    let context = scene_context(features, BindingSlot::default());
    link("test/scene", &context.define("test/scene", root.to_owned())).expect("modules link")
}
