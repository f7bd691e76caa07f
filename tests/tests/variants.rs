//! Every text of the evaluator that can exist, on an adapter, against the Rust twin: textures with
//! all that it has code for, in every filter mode that it has code for.

use std::borrow::Cow;
use std::io::Write as _;

use rayon::prelude::*;
use vtex_format::{Features, SpecKey, VtexFile};
use vtex_shaders::{
    BatchQuery, FilterMode, FootprintSamples, PackOptions, Packed, kernel_key, pack, pack_set,
    spec_key,
};
use vtex_tests::fixture::random_texture;
use vtex_tests::gpu::Gpu;
use vtex_tests::parity::{Parities, Subject, random_queries};
use vtex_tests::variants::{covering, scene_kernel, variants};

/// Lookups of each texture.
const LOOKUPS: u32 = 2000;
/// The loader's choices, of which no file says anything.
const FILTERS: u32 = Features::FOOTPRINT | Features::PAPER;

/// Texts take them in turn.
const SAMPLES: [FootprintSamples; 3] = [
    FootprintSamples::ThirtyTwo,
    FootprintSamples::Sixteen,
    FootprintSamples::Eight,
];

/// A texture for one filter mode.
struct Texture {
    file: VtexFile,
    options: PackOptions,
    packed: Packed,
    /// Of its key.
    features: u32,
}

impl Texture {
    fn new(file: &VtexFile, filter: FilterMode, samples: FootprintSamples) -> Self {
        let options = PackOptions {
            filter,
            samples,
            // Enough to have fine cells, and soon packed.
            halvings: Some(1),
            ..PackOptions::default()
        };
        Self {
            file: file.clone(),
            options,
            packed: pack(file, &options),
            features: spec_key(file, &options).features,
        }
    }

    fn subject(&self) -> Subject<'_> {
        Subject {
            words: &self.packed.words,
            texels: &self.packed.texels,
            features: self.features,
        }
    }
}

/// The filter modes of which a text has code: point mode in any.
fn modes(features: u32) -> Vec<FilterMode> {
    let has = |feature| features & feature != 0;
    let footprint = has(Features::FOOTPRINT).then_some(FilterMode::Footprint);
    let paper = has(Features::PAPER).then_some(FilterMode::Paper);
    let modes = [Some(FilterMode::Point), footprint, paper];
    modes.into_iter().flatten().collect()
}

/// A random texture that needs all of a text but its filter modes, and shows something: a matrix may
/// turn all of it away, and the mask of an opaque texture is 1 in many places.
fn texture(index: usize, features: u32) -> VtexFile {
    // Every text has the code of mips and masks. A mask has no colours to compare: one in eight.
    let mut wanted = features & !(FILTERS | Features::MIPS | Features::MASK);
    if index.is_multiple_of(2) {
        wanted |= Features::MIPS;
    }
    if index % 8 == 7 {
        wanted |= Features::MASK;
    }
    let queries = random_queries(index as u64, 100, 0.5);
    let is_good = |file: &VtexFile| {
        let texture = Texture::new(file, FilterMode::Point, FootprintSamples::default());
        let key = kernel_key(&spec_key(file, &PackOptions::default()));
        let colors = texture.subject().twin(&queries);
        let shows = colors.iter().any(|color| *color != colors[0]);
        shows && key.features == features & !FILTERS
    };
    let seeds = (0..50).map(|again| 1000 * again + index as u64);
    let mut files = seeds.map(|seed| random_texture(seed, wanted));
    files
        .find(is_good)
        .unwrap_or_else(|| panic!("no texture needs {features:#x} and shows something"))
}

/// A texture with less than a text has code for: what another text has, too.
fn poorer(index: usize, mut features: u32, filter: FilterMode) -> Texture {
    features &= !(FILTERS | Features::MASK);
    // Tests need curve records, and only groups blend and are deep.
    if features & Features::CURVES == 0 {
        features &= !Features::CLIPS;
    }
    if features & Features::GROUPS == 0 {
        features &= !(Features::BLENDS | Features::DEEP_GROUPS);
    }
    let file = random_texture(!index as u64, features);
    Texture::new(&file, filter, SAMPLES[(index + 1) % SAMPLES.len()])
}

/// All textures in one buffer, one after the other, as those of a scene are.
fn check(gpu: &Gpu, index: usize, features: u32, textures: &[Texture]) -> Parities {
    let set = pack_set(textures.iter().map(|one| (&one.file, &one.options)));
    let mut queries: Vec<BatchQuery> = Vec::new();
    for (texture, &base) in textures.iter().zip(&set.first_words) {
        let key = SpecKey {
            features: texture.features,
        };
        let code = kernel_key(&key).features;
        assert_eq!(code & !features, 0, "{features:#x} has code for all of it");
        let mut own = random_queries(index as u64, LOOKUPS, 0.5);
        for query in &mut own {
            query.padding[0] = f32::from_bits(base);
        }
        queries.extend(own);
    }
    let text = wgpu::ShaderSource::Wgsl(Cow::Owned(scene_kernel(features)));
    let answers = gpu
        .kernel(text)
        .run(&set.words, &set.texels, &queries)
        .colors;
    let mut parities = Parities::default();
    let each = queries.chunks(LOOKUPS as usize);
    for (texture, (queries, answers)) in textures
        .iter()
        .zip(each.zip(answers.chunks(LOOKUPS as usize)))
    {
        let subject = texture.subject();
        let parity = subject.compare(queries, &subject.twin(queries), answers);
        let key = texture.features;
        assert_eq!(
            parity.check(),
            Ok(()),
            "variant {index}, {features:#x}, key {key:#x}"
        );
        parities.add(key, parity);
    }
    parities
}

/// All texts run at full length only: lavapipe compiles one in two seconds. Any two modules that meet
/// in one of them meet in one that runs.
#[test]
fn texts_agree_with_the_twin() {
    if Gpu::open().is_none() {
        return;
    }
    let variants = variants();
    let chosen = if vtex_testing::slow() {
        (0..variants.len()).collect()
    } else {
        covering(&variants)
    };
    let run = |gpu: &Gpu, index: usize| {
        let features = variants[index].features;
        let file = texture(index, features);
        let modes = modes(features);
        let samples = SAMPLES[index % SAMPLES.len()];
        let packed = modes.iter().map(|&mode| Texture::new(&file, mode, samples));
        let mut textures: Vec<Texture> = packed.collect();
        let other = variants[variants.len() - 1 - index].features;
        textures.push(poorer(index, features & other, modes[modes.len() - 1]));
        check(gpu, index, features, &textures)
    };
    // A device for each thread: a driver may have one queue a device.
    let share = chosen.len().div_ceil(rayon::current_num_threads());
    let parities = chosen.par_chunks(share).map(|mine| {
        let gpu = Gpu::open().expect("the same as the first");
        let all = mine.iter().map(|&index| run(&gpu, index));
        all.fold(Parities::default(), Parities::and)
    });
    let parities = parities.reduce(Parities::default, Parities::and);
    // A report that nobody can read is no failure.
    let _ = writeln!(
        std::io::stderr(),
        "{} texts can exist, {} ran",
        variants.len(),
        chosen.len()
    );
    parities.report("every text");
}
