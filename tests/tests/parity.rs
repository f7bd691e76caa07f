//! The WGSL evaluator on an adapter against its Rust twin, on random lookups.

use std::borrow::Cow;

use rayon::prelude::*;
use vtex_baker::{BakeConfig, Resources, bake};
use vtex_format::{DistanceOutline, Features, SpecKey, VtexFile};
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{
    BatchQuery, BindingSlot, FilterMode, PackOptions, batch_kernel, link, pack, scene_context,
    shader_blob, spec_key,
};
use vtex_tests::colors::differing;
use vtex_tests::fixture::random_texture;
use vtex_tests::gpu::Gpu;
use vtex_tests::random::Random;
use vtex_tests::scopes::{Drawing, Wants};

/// Lookups of a random texture in each filter mode.
const RANDOM_QUERIES: u32 = 100_000;
/// The same of random trees of clips and groups.
const SCOPED_QUERIES: u32 = 30_000;
/// Lookups of a baked drawing, or of random curves, in point mode, and in each of the others.
const BAKED_POINT_QUERIES: u32 = 1_000_000;
const BAKED_OTHER_QUERIES: u32 = 200_000;

/// A quarter of an 8-bit step: what a lookup may differ by and count as the same.
const SAME: f32 = 0.001;
/// Share of point lookups that may differ: roundings on the two sides of an edge.
const DIFFERENT_SHARE: f64 = 1e-4;
/// Share of footprint and paper lookups of random textures that may differ: their cells do not
/// join and steps of their curve records lie on no outline, so they jump where drawings do not.
const TORN_SHARE: f64 = 2e-5;
/// What a footprint or paper lookup may differ by.
const FILTERED: f32 = 2.0 / 255.0;

const LISTS: u32 = Features::LISTS;
const CURVES: u32 = Features::LISTS | Features::CURVES;
const COLOR: u32 = Features::LISTS | Features::MSDF;

/// What `scoped_files` has.
const SCOPES: u32 = Features::CLIPS | Features::GROUPS | Features::BLENDS;

/// Feature sets that between them reach every other module of the evaluator.
const CASES: [(&str, u32); 19] = [
    ("solid", 0),
    ("full", LISTS | Features::TRANSLUCENT),
    ("opaque", COLOR),
    (
        "opaque-outline",
        COLOR | Features::OUTLINE | Features::TEXTURE_MATRIX,
    ),
    ("translucent", COLOR | Features::TRANSLUCENT),
    (
        "translucent-outline",
        COLOR | Features::TRANSLUCENT | Features::OUTLINE,
    ),
    ("curves", CURVES),
    (
        "curves-outline",
        CURVES | Features::OUTLINE | Features::TRANSLUCENT,
    ),
    ("curves-msdf", CURVES | Features::MSDF),
    (
        "curves-msdf-mask",
        CURVES | Features::MSDF | Features::MASK | Features::OUTLINE,
    ),
    ("mips", COLOR | Features::MIPS),
    ("images", COLOR | Features::IMAGES | Features::TRANSLUCENT),
    (
        "mask",
        COLOR | Features::IMAGES | Features::MASK | Features::MIPS | Features::OUTLINE,
    ),
    ("gradients-solid", Features::GRADIENTS),
    ("gradients-opaque", CURVES | Features::GRADIENTS),
    (
        "gradients-translucent",
        CURVES | Features::GRADIENTS | Features::TRANSLUCENT,
    ),
    (
        "gradients-images",
        COLOR | Features::GRADIENTS | Features::IMAGES | Features::TRANSLUCENT,
    ),
    (
        "gradients-mask",
        CURVES | Features::GRADIENTS | Features::TRANSLUCENT | Features::MASK,
    ),
    (
        "all",
        Features::ALL & !(SCOPES | Features::MASK | Features::RAMPS),
    ),
];

/// Points up to `margin` outside the canvas; footprints from none to the whole of it.
fn random_queries(seed: u64, count: u32, margin: f32) -> Vec<BatchQuery> {
    let mut r = Random::new(seed);
    let query = |_| {
        let width = if r.below(4) == 0 {
            0.0
        } else {
            r.between(-12.0, 0.0).exp2()
        };
        BatchQuery {
            uv: [(); 2].map(|()| r.between(-margin, 1.0 + margin)),
            padding: [0.0; 2],
            footprint: [(); 4].map(|()| width * r.between(-1.0, 1.0)),
        }
    };
    (0..count).map(query).collect()
}

fn twin(words: &[u32], queries: &[BatchQuery]) -> Vec<[f32; 4]> {
    let sampler = Sampler::new(words);
    queries
        .par_iter()
        .map(|query| sampler.sample(query.uv, query.footprint))
        .collect()
}

fn check(name: &str, filter: FilterMode, torn: f64, [cpu, gpu]: [&[[f32; 4]]; 2]) {
    let tolerance = if filter == FilterMode::Point {
        SAME
    } else {
        FILTERED
    };
    let count = differing(cpu, gpu, tolerance).len();
    let allowed = match filter {
        FilterMode::Point => DIFFERENT_SHARE * cpu.len() as f64,
        _ => torn * cpu.len() as f64,
    };
    assert!(
        count as f64 <= allowed,
        "{name}, {filter:?}: {count} of {} lookups differ by more than {tolerance}",
        cpu.len(),
    );
}

/// How a file is looked up.
struct Lookups {
    /// In point, footprint and paper mode.
    counts: [u32; 3],
    /// How far outside the canvas.
    margin: f32,
    /// Share of those with a ramp that may differ.
    torn: f64,
}

fn check_file(gpu: &Gpu, name: &str, file: &VtexFile, lookups: &Lookups) {
    let filters = [FilterMode::Point, FilterMode::Footprint, FilterMode::Paper];
    for (filter, count) in filters.into_iter().zip(lookups.counts) {
        let options = PackOptions {
            filter,
            ..PackOptions::default()
        };
        let text = batch_kernel(&spec_key(file, &options));
        let kernel = gpu.kernel(wgpu::ShaderSource::Wgsl(Cow::Owned(text)));
        let words = pack(file, &options);
        let queries = random_queries(u64::from(count), count, lookups.margin);
        let answers = kernel.run(&words, &queries);
        let expected = twin(&words, &queries);
        assert!(
            expected.iter().any(|color| *color != expected[0]),
            "{name} shows something"
        );
        check(name, filter, lookups.torn, [&expected, &answers.colors]);
    }
}

#[test]
fn twin_and_gpu_agree() {
    let Some(gpu) = Gpu::open() else { return };
    for (index, (name, features)) in (0..).zip(CASES) {
        let point = if features & Features::CURVES != 0 {
            BAKED_POINT_QUERIES
        } else {
            RANDOM_QUERIES
        };
        let file = random_texture(index, features);
        assert_eq!(
            SpecKey::for_file(&file).features & features,
            features,
            "{name} has what it names"
        );
        let lookups = Lookups {
            counts: [point, RANDOM_QUERIES, RANDOM_QUERIES],
            margin: 1.5,
            torn: TORN_SHARE,
        };
        check_file(&gpu, name, &file, &lookups);
    }
}

/// The five kinds of \[SFG22\] Table 1. Text without fonts: their absence changes shapes, not sides.
#[test]
fn twin_and_gpu_agree_on_baked_drawings() {
    let Some(gpu) = Gpu::open() else { return };
    for name in [
        "figures-text-26",
        "stars-5",
        "text-27",
        "arms-11",
        "peacock",
    ] {
        let path = format!("{}/data/svg/paper/{name}.svg", env!("CARGO_MANIFEST_DIR"));
        let svg = std::fs::read(path).expect("the sample drawings are part of the project");
        let file = bake(&svg, &BakeConfig::default(), &Resources::default()).expect("bakes");
        let lookups = Lookups {
            counts: [
                BAKED_POINT_QUERIES,
                BAKED_OTHER_QUERIES,
                BAKED_OTHER_QUERIES,
            ],
            margin: 0.1,
            torn: 0.0,
        };
        check_file(&gpu, name, &file, &lookups);
    }
}

/// Random trees of clips, groups, masks and blend modes, as they are, as a mask and outlined.
fn scoped_files() -> Vec<(String, VtexFile)> {
    let wants = [
        ("clips", [true, false, false]),
        ("groups", [false, true, false]),
        ("blends", [true, true, true]),
    ];
    let mut files = Vec::new();
    for (name, [clips, groups, blends]) in wants {
        let wants = Wants {
            clips,
            groups,
            blends,
        };
        let plain = Drawing::random(11, 40, wants).file();
        let mut mask = plain.clone();
        mask.meta.sampler.mask = true;
        let mut outlined = plain.clone();
        outlined.meta.sampler.outline = Some(DistanceOutline {
            width_texels: 0.3,
            paint: 1,
        });
        for (kind, mut file) in [("", plain), (" mask", mask), (" outlined", outlined)] {
            file.spec = SpecKey::for_file(&file);
            assert_eq!(file.check(), [], "{name}{kind}");
            files.push((format!("{name}{kind}"), file));
        }
    }
    files
}

#[test]
fn twin_and_gpu_agree_on_clips_and_groups() {
    let Some(gpu) = Gpu::open() else { return };
    for (name, file) in scoped_files() {
        let lookups = Lookups {
            counts: [SCOPED_QUERIES; 3],
            margin: 0.1,
            torn: TORN_SHARE,
        };
        check_file(&gpu, &name, &file, &lookups);
    }
}

#[test]
fn the_spirv_in_a_file_is_the_same_kernel() {
    let Some(gpu) = Gpu::open() else { return };
    let file = random_texture(77, Features::ALL & !Features::MASK);
    let key = SpecKey::for_file(&file);
    let words = pack(&file, &PackOptions::default());
    let queries = random_queries(3, RANDOM_QUERIES, 0.5);
    let spirv = shader_blob(&key).unwrap().batch_spirv;
    let from_file = gpu
        .kernel(wgpu::ShaderSource::SpirV(Cow::Owned(spirv)))
        .run(&words, &queries);
    let text = wgpu::ShaderSource::Wgsl(Cow::Owned(batch_kernel(&key)));
    let from_text = gpu.kernel(text).run(&words, &queries);
    let apart = differing(&from_file.colors, &from_text.colors, 0.0);
    assert!(apart.is_empty(), "{apart:?}");
}

/// Several textures in one buffer, looked up by their first word.
#[test]
fn scenes_look_up_each_texture_as_if_it_were_alone() {
    let Some(gpu) = Gpu::open() else { return };
    let plain = CASES.iter();
    let plain = plain.map(|(name, features)| (name.to_string(), random_texture(5, *features)));
    let files: Vec<(String, VtexFile)> = plain.chain(scoped_files()).collect();
    // Without outlines too: then clips alone are walked front to back.
    let sharp = |files: &[(String, VtexFile)]| -> Vec<(String, VtexFile)> {
        let sharp = files
            .iter()
            .filter(|(_, file)| file.meta.sampler.outline.is_none());
        sharp.cloned().collect()
    };
    check_scene(&gpu, FilterMode::Point, &sharp(&files));
    for filter in [FilterMode::Point, FilterMode::Footprint] {
        check_scene(&gpu, filter, &files);
    }
}

/// The smallest files, as many as one binding of core WebGPU takes together, with their words.
fn that_fit<'a>(
    files: &'a [(String, VtexFile)],
    options: &PackOptions,
) -> (Vec<&'a (String, VtexFile)>, Vec<Vec<u32>>) {
    let mut packed: Vec<_> = files
        .iter()
        .map(|file| (file, pack(&file.1, options)))
        .collect();
    packed.sort_by_key(|(_, words)| words.len());
    let mut words = 0;
    packed.retain(|(_, own)| {
        words += own.len();
        words <= (128 << 20) / 4
    });
    assert!(packed.len() + 6 >= files.len(), "{} textures", packed.len());
    packed.into_iter().unzip()
}

fn check_scene(gpu: &Gpu, filter: FilterMode, files: &[(String, VtexFile)]) {
    let options = PackOptions {
        filter,
        ..PackOptions::default()
    };
    let (files, packed) = that_fit(files, &options);
    let union = files.iter().fold(0, |union, (_, file)| {
        union | spec_key(file, &options).features
    });
    let mut bases = Vec::new();
    let mut words = Vec::new();
    for texture in &packed {
        bases.push(u32::try_from(words.len()).expect("small textures"));
        words.extend(texture);
    }
    let mut queries = random_queries(9, RANDOM_QUERIES, 1.5);
    for (query, base) in queries.iter_mut().zip(bases.iter().cycle()) {
        query.padding[0] = f32::from_bits(*base);
    }
    let kernel = gpu.kernel(wgpu::ShaderSource::Wgsl(Cow::Owned(scene_kernel(union))));
    let answers = kernel.run(&words, &queries).colors;
    for (i, texture) in packed.iter().enumerate() {
        let mine = |list: &[BatchQuery]| -> Vec<BatchQuery> {
            list.iter().skip(i).step_by(packed.len()).copied().collect()
        };
        let seen: Vec<_> = answers
            .iter()
            .skip(i)
            .step_by(packed.len())
            .copied()
            .collect();
        let expected = twin(texture, &mine(&queries));
        check(&files[i].0, filter, TORN_SHARE, [&expected, &seen]);
    }
}

/// The batch kernel with the texture's first word in the query's padding.
fn scene_kernel(features: u32) -> String {
    let root = "//!use core/query\n//!use vtex/sample\n\
        @group(0) @binding(1) var<storage, read> queries: array<VtexBatchQuery>;\n\
        @group(0) @binding(2) var<storage, read_write> results: array<vec4f>;\n\
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
