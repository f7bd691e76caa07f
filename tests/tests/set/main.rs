//! Many textures in one shader of somebody else: what comes and goes, and what is refused.
//!
//! `VTEX_GPU=off` skips these tests and says so; without it a missing adapter is a failure.

#![expect(
    clippy::unwrap_used,
    reason = "helpers of tests fail as tests do, by panicking"
)]

mod limits;
mod pools;
mod queue;

use std::collections::BTreeSet;
use std::sync::Arc;

use vtex_format::{Features, Image, VtexFile};
use vtex_runtime::{
    BatchQuery, BatchSampler, FilterMode, Gpu, Limits, LoadOptions, RuntimeError, TexelFormat,
    TextureHandle, TextureQuery, TextureSet, TextureSetOptions, Trust, wgpu,
};
use vtex_shaders::{pack, spec_key};
use vtex_tests::fixture::random_texture;
use vtex_tests::gpu::shared as gpu;
use vtex_tests::parity::{Subject, random_queries};
use wgpu::util::DeviceExt as _;

const OUTLINES: u32 = Features::LISTS | Features::CURVES | Features::MIPS;
const KINDS: [u32; 3] = [
    OUTLINES | Features::GRADIENTS,
    Features::LISTS | Features::MSDF | Features::IMAGES | Features::MIPS | Features::TRANSLUCENT,
    OUTLINES | Features::GROUPS | Features::MAPPING,
];

/// A set of small pools.
const SEVERAL: TextureSetOptions = TextureSetOptions {
    features: 0,
    page_side: 256,
    texels: TexelFormat::Rgba8,
    threads: 0,
    max_pools: 32,
    pool_bytes: 1 << 20,
    max_bytes: u64::MAX,
};

/// Textures of three kinds in turn.
fn file(seed: u64) -> VtexFile {
    random_texture(seed, KINDS[(seed % 3) as usize])
}

fn options(filter: FilterMode) -> LoadOptions {
    let mut options = LoadOptions::default();
    options.pack.filter = filter;
    options.pack.halvings = Some(1);
    options
}

/// The user's shader, compiled once.
struct Shader {
    pipeline: wgpu::ComputePipeline,
}

const SHADER: &str = "
struct Ask { uv: vec2f, handle: u32, user: u32, footprint: vec4f }
@group(1) @binding(0) var<storage, read> asks: array<Ask>;
@group(1) @binding(1) var<storage, read_write> colors: array<vec4f>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&asks) {
        let ask = asks[id.x];
        colors[id.x] = vtex_sample(ask.handle, ask.uv, ask.footprint);
    }
}
";

impl Shader {
    fn new(gpu: &Gpu, set: &TextureSet) -> Self {
        let device = &gpu.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl((set.wgsl_fragment(0, 0) + SHADER).into()),
        });
        let entry = |binding, read_only| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let own = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[entry(0, true), entry(1, false)],
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(set.bind_group_layout()), Some(&own)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&layout),
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        Self { pipeline }
    }

    fn run(&self, gpu: &Gpu, set: &wgpu::BindGroup, queries: &[TextureQuery]) -> Vec<[f32; 4]> {
        let (device, queue) = (&gpu.device, &gpu.queue);
        let asks = storage(gpu, queries);
        let colors = storage(gpu, &vec![[9.0_f32; 4]; queries.len()]);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.pipeline.get_bind_group_layout(1),
            entries: &[(0, &asks), (1, &colors)].map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            }),
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, set, &[]);
        pass.set_bind_group(1, &group, &[]);
        pass.dispatch_workgroups(u32::try_from(queries.len().div_ceil(64)).unwrap(), 1, 1);
        drop(pass);
        queue.submit([encoder.finish()]);
        read(gpu, &colors)
    }
}

fn storage<T: bytemuck::Pod>(gpu: &Gpu, contents: &[T]) -> wgpu::Buffer {
    gpu.device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(contents),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        })
}

fn read<T: bytemuck::Pod>(gpu: &Gpu, buffer: &wgpu::Buffer) -> Vec<T> {
    let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: buffer.size(),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
    gpu.queue.submit([encoder.finish()]);
    staging.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
    gpu.device
        .poll(wgpu::PollType::wait_indefinitely())
        .unwrap();
    let view = staging.get_mapped_range(..).unwrap();
    bytemuck::pod_collect_to_vec(&view)
}

/// The same lookups in a texture of a set.
fn of(handle: TextureHandle, queries: &[BatchQuery]) -> Vec<TextureQuery> {
    let query = |query: &BatchQuery| TextureQuery {
        uv: query.uv,
        handle,
        user: 7,
        footprint: query.footprint,
    };
    queries.iter().map(query).collect()
}

/// The answers are those of the twin, and of the texture outside a set.
fn assert_as_alone(
    gpu: &Gpu,
    (file, options): (&VtexFile, &LoadOptions),
    index: usize,
    queries: &[BatchQuery],
    ours: &[[f32; 4]],
) {
    let packed = pack(file, &options.pack);
    let subject = Subject {
        words: &packed.words,
        texels: &packed.texels,
        features: spec_key(file, &options.pack).features,
    };
    let alone =
        BatchSampler::new(&gpu.device, &gpu.queue, file, options, Trust::Regenerate).unwrap();
    for other in [subject.twin(queries), alone.sample(queries).unwrap()] {
        let parity = subject.compare(queries, &other, ours);
        parity
            .check()
            .unwrap_or_else(|problem| panic!("texture {index}: {problem}"));
    }
}

fn set(gpu: &Gpu, options: &TextureSetOptions) -> TextureSet {
    TextureSet::new(&gpu.device, &gpu.queue, options).unwrap()
}

#[test]
fn three_textures_in_one_shader_answer_as_each_alone() {
    let Some(gpu) = gpu() else { return };
    let mut set = set(gpu, &TextureSetOptions::default());
    let filters = [FilterMode::Point, FilterMode::Footprint, FilterMode::Point];
    let textures: Vec<_> = (0..)
        .zip(filters)
        .map(|(seed, filter)| (file(seed), options(filter)))
        .collect();
    let handles = set
        .add_all(textures.iter().map(|(file, options)| (file, options)))
        .unwrap();
    let shader = Shader::new(gpu, &set);
    for (index, ((file, options), &handle)) in textures.iter().zip(&handles).enumerate() {
        let queries = random_queries(index as u64, 4000, 0.3);
        let ours = shader.run(gpu, set.bind_group(), &of(handle, &queries));
        assert_as_alone(gpu, (file, options), index, &queries, &ours);
        let shown: BTreeSet<_> = ours.iter().map(|c| c.map(f32::to_bits)).collect();
        assert!(shown.len() > 10, "texture {index} shows something");
    }
}

#[test]
fn bytes_of_files_become_the_same_textures() {
    let Some(gpu) = gpu() else { return };
    let options = options(FilterMode::Point);
    let files = [file(0), file(2)];
    let bytes = files.each_ref().map(|file| file.to_bytes().unwrap());
    let mut read = set(gpu, &TextureSetOptions::default());
    let limits = Limits::default();
    let all = bytes.iter().map(|bytes| (&bytes[..], &options));
    let handles = read.load_all(all.clone(), &limits).unwrap();
    let mut added = set(gpu, &TextureSetOptions::default());
    let same = added.add_all(files.iter().map(|file| (file, &options)));
    assert_eq!(handles, same.unwrap());
    assert_eq!((read.key(), read.bytes()), (added.key(), added.bytes()));
    let [ours, theirs] = [&read, &added].map(|set| Shader::new(gpu, set));
    for &handle in &handles {
        let queries = of(handle, &random_queries(7, 1000, 0.3));
        assert_eq!(
            ours.run(gpu, read.bind_group(), &queries),
            theirs.run(gpu, added.bind_group(), &queries)
        );
    }
    let broken = all.chain([(&b"no file"[..], &options)]);
    let error = read.load_all(broken, &limits).unwrap_err();
    assert!(
        matches!(error, RuntimeError::FileOf { index: 2, .. }),
        "{error}"
    );
    assert_eq!(read.len(), 2, "all of them or none");
}

/// Shows a gradient and an edge, as drawings do, where there was noise.
fn draw(image: &mut Image) {
    let level = |level: u32| {
        let [width, height] = Image::level_size(image.size, level);
        let texel = |x: u32, y: u32| {
            let is_edge = 10 * x * height > 7 * y * width + 2 * width * height;
            let gradient = [200 * x / width, 60 + 100 * y / height, 30];
            let [r, g, b] = if is_edge { [220; 3] } else { gradient };
            [r, g, b, 255].map(|channel| u8::try_from(channel).unwrap())
        };
        let rows = (0..height).flat_map(|y| (0..width).flat_map(move |x| texel(x, y)));
        rows.collect::<Vec<u8>>()
    };
    let count = u32::try_from(image.mips.len()).unwrap();
    image.mips = Arc::new((0..count).map(level).collect());
}

/// Lookups as wide as half a texture and more read texels alone.
#[test]
fn texels_in_blocks_take_a_quarter_and_look_the_same() {
    let Some(gpu) = gpu() else { return };
    let options = options(FilterMode::Point);
    let mut files: Vec<VtexFile> = (0..9).map(|seed| file(3 * seed + 1)).collect();
    files
        .iter_mut()
        .flat_map(|file| &mut file.images)
        .for_each(draw);
    let filled = |texels: TexelFormat| {
        let mut set = set(
            gpu,
            &TextureSetOptions {
                texels,
                page_side: 64,
                ..TextureSetOptions::default()
            },
        );
        // One by one, so that pages grow and are copied.
        let handles = files.iter().map(|file| set.add(file, &options).unwrap());
        let handles: Vec<TextureHandle> = handles.collect();
        (set, handles)
    };
    let (plain, handles) = filled(TexelFormat::Rgba8);
    let (blocks, same) = filled(TexelFormat::Bc7);
    assert_eq!(handles, same);
    let has_blocks = gpu
        .device
        .features()
        .contains(wgpu::Features::TEXTURE_COMPRESSION_BC);
    let share = if has_blocks { 4 } else { 1 };
    assert_eq!(plain.bytes().texels, share * blocks.bytes().texels);
    assert_eq!(
        plain.bytes().texels_held,
        share * blocks.bytes().texels_held
    );
    let [ours, theirs] = [&plain, &blocks].map(|set| Shader::new(gpu, set));
    let (mut sum, mut count) = (0.0, 0.0);
    for &handle in &handles {
        let mut queries = random_queries(5, 500, 0.3);
        for query in &mut queries {
            query.footprint = [0.25, 0.0, 0.0, 0.25];
        }
        let queries = of(handle, &queries);
        let colors = [
            ours.run(gpu, plain.bind_group(), &queries),
            theirs.run(gpu, blocks.bind_group(), &queries),
        ];
        for (one, other) in colors[0].iter().flatten().zip(colors[1].iter().flatten()) {
            sum += f64::from(one - other).powi(2);
            count += 1.0;
        }
    }
    let db = -10.0 * f64::log10(sum / count);
    assert!(db > 38.0, "{db} dB");
    assert!(!has_blocks || db < 120.0, "blocks were read: {db} dB");
}

#[test]
fn options_out_of_their_range_are_refused() {
    let Some(gpu) = gpu() else { return };
    let good = TextureSetOptions::default();
    let bad = [
        (
            TextureSetOptions {
                max_pools: 0,
                ..good
            },
            "max_pools",
        ),
        (
            TextureSetOptions {
                max_pools: 33,
                ..good
            },
            "max_pools",
        ),
        (
            TextureSetOptions {
                page_side: 0,
                ..good
            },
            "page_side",
        ),
        (
            TextureSetOptions {
                page_side: 8193,
                ..good
            },
            "page_side",
        ),
        (
            TextureSetOptions {
                features: u32::MAX,
                ..good
            },
            "features",
        ),
    ];
    for (options, named) in bad {
        let error = TextureSet::new(&gpu.device, &gpu.queue, &options).unwrap_err();
        assert!(matches!(error, RuntimeError::Parameter(_)), "{error}");
        assert!(error.to_string().contains(named), "{error}");
    }
}

#[test]
fn what_stays_is_the_same_bit_for_bit_while_others_come_and_go() {
    let Some(gpu) = gpu() else { return };
    let mut set = set(
        gpu,
        &TextureSetOptions {
            page_side: 256,
            ..TextureSetOptions::every_feature(FilterMode::Footprint)
        },
    );
    let shader = Shader::new(gpu, &set);
    let key = *set.key();
    let options = options(FilterMode::Footprint);
    let files: Vec<VtexFile> = (0..40).map(file).collect();
    let kept: Vec<TextureHandle> = files[..3]
        .iter()
        .map(|file| set.add(file, &options).unwrap())
        .collect();
    let queries: Vec<TextureQuery> = kept
        .iter()
        .flat_map(|&handle| of(handle, &random_queries(5, 700, 0.3)))
        .collect();
    let before = shader.run(gpu, set.bind_group(), &queries);
    let (group, generation, bytes) = (set.bind_group().clone(), set.generation(), set.bytes());

    let others = set
        .add_all(files[3..].iter().map(|file| (file, &options)))
        .unwrap();
    assert!(set.generation() > generation, "the buffer has grown");
    assert!(set.bytes().words_held > bytes.words_held);
    assert!(
        set.texels().texture().depth_or_array_layers() > 1,
        "and so have the pages"
    );
    assert!(shader.run(gpu, set.bind_group(), &queries) == before);
    assert!(
        shader.run(gpu, &group, &queries) == before,
        "the group from before still shows what it had"
    );
    let own = of(others[5], &random_queries(5, 700, 0.3));
    let other = shader.run(gpu, set.bind_group(), &own);
    assert!(
        shader
            .run(gpu, &group, &own)
            .iter()
            .flatten()
            .all(|&c| c == 0.0)
    );

    // Every second of the others goes: their room is used again, by textures with other handles.
    let (generation, bytes) = (set.generation(), set.bytes());
    for &handle in others.iter().step_by(2) {
        assert!(set.remove(handle) && !set.contains(handle));
        assert!(!set.remove(handle), "once");
    }
    assert!(shader.run(gpu, set.bind_group(), &queries) == before);
    let again: Vec<_> = files[3..]
        .iter()
        .step_by(2)
        .map(|file| (file, &options))
        .collect();
    let again = set.add_all(again).unwrap();
    assert_eq!(set.len(), 40);
    let handles: BTreeSet<_> = kept.iter().chain(&others).chain(&again).collect();
    assert_eq!(handles.len(), 40 + again.len(), "no handle is given twice");
    assert_eq!(set.bytes().words, bytes.words);
    assert_eq!(set.bytes().words_held, bytes.words_held);
    assert_eq!(set.generation(), generation);
    assert!(shader.run(gpu, set.bind_group(), &queries) == before);
    assert!(shader.run(gpu, set.bind_group(), &own) == other);
    for (&gone, &new) in others.iter().step_by(2).zip(&again) {
        let lookups = [gone, new].map(|handle| of(handle, &random_queries(9, 200, 0.1)));
        let [gone, new] = lookups.map(|lookups| shader.run(gpu, set.bind_group(), &lookups));
        assert!(gone.iter().flatten().all(|&channel| channel == 0.0));
        assert!(new.iter().flatten().any(|&channel| channel > 0.0));
    }
    assert_eq!(*set.key(), key, "nothing was to be compiled");
}

#[test]
fn the_key_tells_when_a_texture_needs_more_code() {
    let Some(gpu) = gpu() else { return };
    let mut set = set(gpu, &TextureSetOptions::default());
    let options = options(FilterMode::Point);
    set.add(&random_texture(1, OUTLINES), &options).unwrap();
    let (key, text) = (*set.key(), set.wgsl_fragment(2, 3));
    set.add(&random_texture(2, OUTLINES), &options).unwrap();
    assert_eq!(*set.key(), key);
    let gradients = set.add(&file(0), &options).unwrap();
    assert_ne!(*set.key(), key);
    assert_ne!(set.wgsl_fragment(2, 3), text);
    let key = *set.key();
    set.remove(gradients);
    assert_eq!(*set.key(), key, "a smaller text is no reason to compile");
}
