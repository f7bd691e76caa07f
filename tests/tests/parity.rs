//! The WGSL evaluator on an adapter against its Rust twin, on random lookups.

use std::borrow::Cow;

use vtex_baker::{BakeConfig, Resources, bake};
use vtex_format::{DistanceOutline, Features, SpecKey, VtexFile};
use vtex_shaders::{
    BatchQuery, FilterMode, FootprintSamples, PackOptions, batch_kernel, pack, pack_set,
    shader_blob, spec_key,
};
use vtex_tests::clips_and_groups::{Drawing, Wants};
use vtex_tests::fixture::random_texture;
use vtex_tests::gpu::Gpu;
use vtex_tests::parity::{Parities, Parity, Subject, random_queries};
use vtex_tests::variants::scene_kernel;

/// Lookups of a random texture in each filter mode.
const RANDOM_QUERIES: u32 = 100_000;
/// The same of random trees of clips and groups.
const GROUPED_QUERIES: u32 = 30_000;
/// Lookups of a baked drawing, or of random curves, in point mode, and in each of the others.
const BAKED_POINT_QUERIES: u32 = 1_000_000;
const BAKED_OTHER_QUERIES: u32 = 200_000;

const LISTS: u32 = Features::LISTS;
const CURVES: u32 = Features::LISTS | Features::CURVES;
const COLOR: u32 = Features::LISTS | Features::MSDF;

/// What `grouped_files` has.
const CLIPS_AND_GROUPS: u32 =
    Features::CLIPS | Features::GROUPS | Features::BLENDS | Features::DEEP_GROUPS;

/// Feature sets that between them reach every other module of the evaluator.
const CASES: [(&str, u32); 20] = [
    ("solid", 0),
    ("full", LISTS | Features::TRANSLUCENT),
    ("opaque", COLOR),
    (
        "opaque-outline",
        COLOR | Features::OUTLINE | Features::MAPPING,
    ),
    ("translucent", COLOR | Features::TRANSLUCENT),
    (
        "translucent-outline",
        COLOR | Features::TRANSLUCENT | Features::OUTLINE,
    ),
    ("curves", CURVES),
    ("curves-translucent", CURVES | Features::TRANSLUCENT),
    ("curves-msdf", CURVES | Features::MSDF),
    (
        "curves-msdf-mask",
        CURVES | Features::MSDF | Features::MASK | Features::OUTLINE,
    ),
    ("mips", COLOR | Features::MIPS),
    ("mips-mapping", COLOR | Features::MIPS | Features::MAPPING),
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
        Features::ALL
            & !(CLIPS_AND_GROUPS | Features::MASK | Features::FOOTPRINT | Features::PAPER),
    ),
];

/// How a file is looked up.
struct Lookups {
    /// In point, footprint and paper mode.
    counts: [u32; 3],
    /// How far outside the canvas.
    margin: f32,
}

fn check_file(gpu: &Gpu, name: &str, file: &VtexFile, lookups: &Lookups) -> Parities {
    let [point, footprint, paper] = lookups.counts;
    let modes = [
        (FilterMode::Point, FootprintSamples::default(), point),
        (
            FilterMode::Footprint,
            FootprintSamples::ThirtyTwo,
            footprint,
        ),
        (
            FilterMode::Footprint,
            FootprintSamples::Sixteen,
            footprint / 4,
        ),
        (
            FilterMode::Footprint,
            FootprintSamples::Eight,
            footprint / 4,
        ),
        (FilterMode::Paper, FootprintSamples::default(), paper),
    ];
    let mut parities = Parities::default();
    for (filter, samples, count) in modes {
        let options = PackOptions {
            filter,
            samples,
            ..PackOptions::default()
        };
        let key = spec_key(file, &options);
        let text = batch_kernel(&key);
        let kernel = gpu.kernel(wgpu::ShaderSource::Wgsl(Cow::Owned(text)));
        let packed = pack(file, &options);
        let queries = random_queries(u64::from(count), count, lookups.margin);
        let answers = kernel.run(&packed.words, &packed.texels, &queries).colors;
        let subject = Subject {
            words: &packed.words,
            texels: &packed.texels,
            features: key.features,
        };
        parities.add(
            key.features,
            checked(name, filter, &subject, &queries, &answers),
        );
    }
    parities
}

fn checked(
    name: &str,
    filter: FilterMode,
    subject: &Subject<'_>,
    queries: &[BatchQuery],
    answers: &[[f32; 4]],
) -> Parity {
    let expected = subject.twin(queries);
    assert!(
        expected.iter().any(|color| *color != expected[0]),
        "{name} shows something"
    );
    let parity = subject.compare(queries, &expected, answers);
    assert_eq!(parity.check(), Ok(()), "{name}, {filter:?}");
    parity
}

#[test]
fn twin_and_gpu_agree() {
    let Some(gpu) = Gpu::open() else { return };
    let mut parities = Parities::default();
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
        };
        parities = parities.and(check_file(&gpu, name, &file, &lookups));
    }
    parities.report("random textures");
}

/// The five kinds of \[SFG22\] Table 1. Text without fonts: their absence changes shapes, not sides.
#[test]
fn twin_and_gpu_agree_on_baked_drawings() {
    let Some(gpu) = Gpu::open() else { return };
    let mut parities = Parities::default();
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
        };
        parities = parities.and(check_file(&gpu, name, &file, &lookups));
    }
    parities.report("baked drawings");
}

/// Random trees of clips, groups, masks and blend modes, as they are, as a mask and outlined.
fn grouped_files() -> Vec<(String, VtexFile)> {
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
    let mut parities = Parities::default();
    for (name, file) in grouped_files() {
        let lookups = Lookups {
            counts: [GROUPED_QUERIES; 3],
            margin: 0.1,
        };
        parities = parities.and(check_file(&gpu, &name, &file, &lookups));
    }
    parities.report("clips and groups");
}

#[test]
fn the_spirv_in_a_file_is_the_same_kernel() {
    let Some(gpu) = Gpu::open() else { return };
    let file = random_texture(77, Features::ALL & !Features::MASK);
    let key = SpecKey::for_file(&file);
    let packed = pack(&file, &PackOptions::default());
    let queries = random_queries(3, RANDOM_QUERIES, 0.5);
    let spirv = shader_blob(&key).unwrap().batch_spirv;
    let from_file = gpu
        .kernel(wgpu::ShaderSource::SpirV(Cow::Owned(spirv)))
        .run(&packed.words, &packed.texels, &queries);
    let text = wgpu::ShaderSource::Wgsl(Cow::Owned(batch_kernel(&key)));
    let from_text = gpu
        .kernel(text)
        .run(&packed.words, &packed.texels, &queries);
    let pairs = from_file.colors.iter().zip(&from_text.colors);
    let apart = pairs.filter(|(file, text)| file != text).count();
    assert_eq!(apart, 0, "of {RANDOM_QUERIES} lookups");
}

/// Several textures in one buffer, looked up by their first word.
#[test]
fn scenes_look_up_each_texture_as_if_it_were_alone() {
    let Some(gpu) = Gpu::open() else { return };
    let plain = CASES.iter();
    let plain = plain.map(|(name, features)| (name.to_string(), random_texture(5, *features)));
    let files: Vec<(String, VtexFile)> = plain.chain(grouped_files()).collect();
    let mut parities = Parities::default();
    for filter in [FilterMode::Point, FilterMode::Footprint, FilterMode::Paper] {
        parities = parities.and(check_scene(&gpu, filter, &files));
    }
    parities.report("textures of a scene");
}

/// The smallest files, as many as one binding of core WebGPU takes together.
fn that_fit<'a>(
    files: &'a [(String, VtexFile)],
    options: &PackOptions,
) -> Vec<&'a (String, VtexFile)> {
    let mut sized: Vec<_> = files
        .iter()
        .map(|file| (pack(&file.1, options).words.len(), file))
        .collect();
    sized.sort_by_key(|&(words, _)| words);
    let mut words = 0;
    sized.retain(|(own, _)| {
        words += own;
        words <= (128 << 20) / 4
    });
    assert!(sized.len() + 6 >= files.len(), "{} textures", sized.len());
    sized.into_iter().map(|(_, file)| file).collect()
}

fn check_scene(gpu: &Gpu, filter: FilterMode, files: &[(String, VtexFile)]) -> Parities {
    let options = PackOptions {
        filter,
        ..PackOptions::default()
    };
    let files = that_fit(files, &options);
    let union = files.iter().fold(0, |union, (_, file)| {
        union | spec_key(file, &options).features
    });
    let set = pack_set(files.iter().map(|(_, file)| (file, &options)));
    let mut queries = random_queries(9, RANDOM_QUERIES, 1.5);
    for (query, base) in queries.iter_mut().zip(set.first_words.iter().cycle()) {
        query.padding[0] = f32::from_bits(*base);
    }
    let kernel = gpu.kernel(wgpu::ShaderSource::Wgsl(Cow::Owned(scene_kernel(union))));
    let answers = kernel.run(&set.words, &set.texels, &queries).colors;
    let mut parities = Parities::default();
    for (i, (name, file)) in files.iter().enumerate() {
        let mine = |list: &[BatchQuery]| -> Vec<BatchQuery> {
            list.iter().skip(i).step_by(files.len()).copied().collect()
        };
        let seen: Vec<_> = answers
            .iter()
            .skip(i)
            .step_by(files.len())
            .copied()
            .collect();
        let subject = Subject {
            words: set.of(i),
            texels: &set.texels,
            features: spec_key(file, &options).features,
        };
        parities.add(
            subject.features,
            checked(name, filter, &subject, &mine(&queries), &seen),
        );
    }
    parities
}
