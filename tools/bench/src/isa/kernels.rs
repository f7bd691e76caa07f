//! The shaders that are compiled.

use std::collections::BTreeMap;

use anyhow::{Context as _, Result};
use vtex_format::{Features, SpecKey, VtexFile};
use vtex_shaders::{
    BindingSlot, FilterMode, LayerKinds, LightKinds, LinkContext, PackOptions, batch_kernel,
    fragment, link, scene_context, spec_key, with_layers, with_lights, without_cutouts,
    without_instances,
};

use crate::subject::FILTERS;

const CURVES: u32 = Features::MIPS | Features::LISTS | Features::CURVES;
const TRANSLUCENT: u32 = CURVES | Features::TRANSLUCENT;
const GROUPS: u32 = TRANSLUCENT | Features::GROUPS | Features::BLENDS;
/// All that a texture in colour usually holds, with the settings of the default.
const EVERYTHING: u32 =
    GROUPS | Features::MSDF | Features::IMAGES | Features::GRADIENTS | Features::CLIPS;

/// Feature sets by name.
const NAMED: [(&str, u32); 11] = [
    ("cells of one paint", Features::MIPS),
    ("opaque curves", CURVES),
    ("translucent curves", TRANSLUCENT),
    ("opaque curves, gradients", CURVES | Features::GRADIENTS),
    (
        "translucent curves, gradients",
        TRANSLUCENT | Features::GRADIENTS,
    ),
    ("translucent curves, clips", TRANSLUCENT | Features::CLIPS),
    ("translucent curves, groups", GROUPS),
    (
        "translucent curves, deep groups",
        GROUPS | Features::DEEP_GROUPS,
    ),
    ("translucent curves, images", TRANSLUCENT | Features::IMAGES),
    (
        "opaque MSDFs",
        Features::MIPS | Features::LISTS | Features::MSDF,
    ),
    ("everything", EVERYTHING),
];

/// What the fragment and the path tracer are compiled for.
const FEW: [(&str, u32); 3] = [
    ("opaque curves", CURVES),
    (
        "translucent curves, gradients",
        TRANSLUCENT | Features::GRADIENTS,
    ),
    ("everything", EVERYTHING),
];

/// Names of the bits of [`Features`], in the order in which rows name them.
const NAMES: [(u32, &str); 13] = [
    (Features::TRANSLUCENT, "translucent"),
    (Features::CURVES, "curves"),
    (Features::MSDF, "MSDFs"),
    (Features::GRADIENTS, "gradients"),
    (Features::CLIPS, "clips"),
    (Features::GROUPS, "groups"),
    (Features::DEEP_GROUPS, "deep groups"),
    (Features::BLENDS, "blends"),
    (Features::IMAGES, "images"),
    (Features::MASK, "mask"),
    (Features::OUTLINE, "outline"),
    (Features::MAPPING, "mapping"),
    (Features::MIPS, "mips"),
];

/// A shader with its name in tables.
#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    pub(crate) name: String,
    pub(crate) wgsl: String,
}

impl Kernel {
    fn batch(name: &str, key: &SpecKey) -> Self {
        Self {
            name: format!("batch, {name}"),
            wgsl: batch_kernel(key),
        }
    }
}

/// Batch kernels of usual feature sets in each filter mode.
pub(crate) fn named() -> Vec<Kernel> {
    let mut kernels = Vec::new();
    for (name, features) in NAMED {
        for (mode, filter) in modes(features) {
            let key = key(features | feature_of(filter));
            kernels.push(Kernel::batch(&format!("{name}, {mode}"), &key));
        }
    }
    kernels
}

/// Batch kernels of the feature sets of `files`, each with the number of its files, in each filter
/// mode.
pub(crate) fn of_files(files: &[VtexFile]) -> Vec<Kernel> {
    let mut kernels: BTreeMap<(u32, &str), (SpecKey, usize)> = BTreeMap::new();
    for file in files {
        for (mode, filter) in modes(file.spec.features) {
            let options = PackOptions {
                filter,
                ..PackOptions::default()
            };
            let key = spec_key(file, &options);
            let found = kernels.entry((key.features, mode)).or_insert((key, 0));
            found.1 += 1;
        }
    }
    kernels
        .into_iter()
        .map(|((features, mode), (key, count))| {
            let files = if count == 1 { "file" } else { "files" };
            let name = format!("{}, {mode} ({count} {files})", words(features));
            Kernel::batch(&name, &key)
        })
        .collect()
}

/// Stages of the path tracer, in the order of a round; their modules are `stage/` and the name.
const STAGES: [&str; 8] = [
    "generate",
    "hit",
    "surface",
    "shade",
    "shadow",
    "arguments",
    "advance",
    "film",
];

/// Those of them that differ by the kinds of light.
const WITH_LIGHTS: [&str; 2] = ["surface", "shade"];

/// Those of them that differ in scenes with instances.
const WITH_INSTANCES: [&str; 4] = ["hit", "surface", "shade", "shadow"];

/// What every scene with lights has.
const AREAS: LightKinds = LightKinds {
    areas: true,
    punctual: false,
    environment: false,
};

/// The fragment in a fragment stage, as users embed it, and the kernels of the path tracer: all in one,
/// then in stages.
pub(crate) fn fragment_and_tracer() -> Result<Vec<Kernel>> {
    let mut kernels = Vec::new();
    for (name, features) in FEW {
        // Without paper mode: the batch kernels show what it costs.
        for (mode, filter) in modes(features & !Features::MSDF) {
            let features = features | feature_of(filter);
            let evaluator = fragment(&key(features), BindingSlot::default());
            kernels.push(Kernel {
                name: format!("fragment stage, {name}, {mode}"),
                wgsl: [include_str!("../wgsl/embedded.wgsl"), &evaluator].concat(),
            });
            // Where the runtime binds a scene's textures.
            let slot = BindingSlot {
                group: 1,
                binding: 0,
            };
            let context = without_cutouts(without_instances(scene_context(features, slot)));
            let context = with_layers(with_lights(context, AREAS), LayerKinds::default());
            kernels.push(Kernel {
                name: format!("path tracer, {name}, {mode}"),
                wgsl: link("root/render", &context).context("the path tracer does not link")?,
            });
        }
    }
    kernels.push(Kernel {
        name: "ray query".to_owned(),
        wgsl: link(
            "root/intersect",
            &without_cutouts(without_instances(LinkContext::default())),
        )
        .context("the ray query does not link")?,
    });
    // The fragments first, then the tracer.
    kernels.sort_by_key(|kernel| kernel.name.split(',').next().map(str::to_owned));
    let staged = || LinkContext::default().fill("trace/stack", "state/stack");
    let base = || with_layers(staged(), LayerKinds::default());
    let with = with_lights(without_cutouts(base()), AREAS);
    let cutouts = with_lights(without_instances(base()), AREAS);
    let without = without_cutouts(cutouts.clone());
    // Without a word of it a text has all kinds.
    let all_lights = without_cutouts(without_instances(base()));
    let layers = with_lights(without_cutouts(without_instances(staged())), AREAS);
    for (stage, context, of) in STAGES
        .map(|stage| (stage, &without, ""))
        .into_iter()
        .chain(WITH_LIGHTS.map(|stage| (stage, &all_lights, ", all lights")))
        .chain([("shade", &layers, ", coats and glass")])
        .chain(["hit", "shadow"].map(|stage| (stage, &cutouts, ", cutouts")))
        .chain(WITH_INSTANCES.map(|stage| (stage, &with, ", instances")))
    {
        let text = link(&format!("stage/{stage}"), context);
        kernels.push(Kernel {
            name: format!("stage {stage}{of}"),
            wgsl: text.with_context(|| format!("the stage {stage} does not link"))?,
        });
    }
    for (name, features) in NAMED {
        for (mode, filter) in modes(features & !Features::MSDF) {
            let context = scene_context(features | feature_of(filter), BindingSlot::default())
                .fill("root/answer", "stage/answer");
            kernels.push(Kernel {
                name: format!("stage lookups, {name}, {mode}"),
                wgsl: link("root/batch", &context).context("the lookups do not link")?,
            });
        }
    }
    Ok(kernels)
}

/// Filter modes with shaders of their own: paper mode differs from point mode only in MSDFs.
fn modes(features: u32) -> impl Iterator<Item = (&'static str, FilterMode)> {
    let has_paper = features & Features::MSDF != 0;
    FILTERS
        .into_iter()
        .filter(move |(_, filter)| has_paper || *filter != FilterMode::Paper)
}

fn key(features: u32) -> SpecKey {
    SpecKey { features }
}

fn feature_of(filter: FilterMode) -> u32 {
    match filter {
        FilterMode::Footprint => Features::FOOTPRINT,
        FilterMode::Paper => Features::PAPER,
        _ => 0,
    }
}

fn words(features: u32) -> String {
    let names = NAMES.iter().filter(|(bit, _)| features & bit != 0);
    let names: Vec<&str> = names.map(|(_, name)| *name).collect();
    match names.is_empty() {
        true => "none".to_owned(),
        false => names.join(" "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kernel_has_a_name_of_its_own() {
        let mut names: Vec<String> = named()
            .into_iter()
            .chain(fragment_and_tracer().unwrap())
            .map(|kernel| kernel.name)
            .collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
    }

    #[test]
    fn features_of_files_are_named() {
        let all = Features::ALL & !(Features::LISTS | Features::FOOTPRINT | Features::PAPER);
        let named = NAMES.iter().fold(0, |named, (bit, _)| named | bit);
        assert_eq!(named, all, "a feature without a name");
        assert_eq!(words(CURVES | Features::GROUPS), "curves groups mips");
    }
}
