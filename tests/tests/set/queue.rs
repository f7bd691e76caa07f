//! Queues whose length only the device knows.

use vtex_runtime::{
    BatchQuery, FilterMode, Gpu, LookupQueue, QueueBuffers, QueueSampler, RuntimeError,
    TextureHandle, TextureQuery, TextureSet, TextureSetOptions, wgpu,
};
use vtex_shaders::batch_dispatch;
use vtex_shaders::set::queue_arguments_kernel;
use vtex_tests::fixture::random_texture;
use vtex_tests::parity::random_queries;

use super::{OUTLINES, SEVERAL, assert_as_alone, file, gpu, of, options, read, set, storage};

/// What no lookup gives.
pub(super) const UNTOUCHED: [f32; 4] = [9.0, 8.0, 7.0, 6.0];

/// Runs a queue of these queries, `count` of which are to be answered, with room for `room` answers.
pub(super) fn answers(
    gpu: &Gpu,
    set: &TextureSet,
    queries: &[TextureQuery],
    count: u32,
    room: usize,
) -> Vec<[f32; 4]> {
    let sampler = QueueSampler::new(&gpu.device, set).unwrap();
    let [queries, count] = [storage(gpu, queries), storage(gpu, &[count])];
    let colors = storage(gpu, &vec![UNTOUCHED; room]);
    let queue = bind(&sampler, [&queries, &count, &colors]).unwrap();
    record(gpu, &sampler, set, &queue);
    read(gpu, &colors)
}

pub(super) fn bind(
    sampler: &QueueSampler,
    [queries, count, colors]: [&wgpu::Buffer; 3],
) -> Result<LookupQueue, RuntimeError> {
    sampler.queue(&QueueBuffers {
        queries: queries.as_entire_buffer_binding(),
        count: count.as_entire_buffer_binding(),
        colors: colors.as_entire_buffer_binding(),
    })
}

pub(super) fn record(gpu: &Gpu, sampler: &QueueSampler, set: &TextureSet, queue: &LookupQueue) {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    sampler.record(&mut encoder, set, queue).unwrap();
    gpu.queue.submit([encoder.finish()]);
}

#[test]
fn a_queue_is_answered_as_a_batch_and_the_twin_do() {
    let Some(gpu) = gpu() else { return };
    let mut set = set(gpu, &TextureSetOptions::default());
    let options = options(FilterMode::Footprint);
    let files: Vec<_> = (0..6).map(file).collect();
    let handles = set
        .add_all(files.iter().map(|file| (file, &options)))
        .unwrap();
    // The textures' lookups are mixed, as rays' are.
    let queries = random_queries(11, 3000, 0.3);
    let mixed: Vec<TextureQuery> = (0..)
        .zip(&queries)
        .flat_map(|(i, query)| of(handles[i % 6], std::slice::from_ref(query)))
        .collect();
    let count = u32::try_from(mixed.len()).unwrap();
    let ours = answers(gpu, &set, &mixed, count, mixed.len());
    for (index, file) in files.iter().enumerate() {
        let pick = |i: &usize| i % 6 == index;
        let own: Vec<usize> = (0..queries.len()).filter(pick).collect();
        let queries: Vec<BatchQuery> = own.iter().map(|&i| queries[i]).collect();
        let ours: Vec<[f32; 4]> = own.iter().map(|&i| ours[i]).collect();
        assert_as_alone(gpu, (file, &options), index, &queries, &ours);
    }
}

#[test]
fn only_the_count_that_fits_is_answered() {
    let Some(gpu) = gpu() else { return };
    check_counts(gpu, &TextureSetOptions::default());
    check_counts(gpu, &SEVERAL);
}

fn check_counts(gpu: &Gpu, set_options: &TextureSetOptions) {
    let mut set = set(gpu, set_options);
    let handle = set.add(&file(0), &options(FilterMode::Point)).unwrap();
    let queries = of(handle, &random_queries(2, 200, 0.0));
    let all = answers(gpu, &set, &queries, 200, 200);
    assert!(!all.contains(&UNTOUCHED), "all are answered");
    for (count, room, answered) in [
        (0, 200, 0),
        (1, 200, 1),
        (64, 200, 64),
        (65, 200, 65),
        (u32::MAX, 200, 200),
        (201, 200, 200),
        (200, 130, 130),
        (u32::MAX, 300, 200),
    ] {
        let colors = answers(gpu, &set, &queries, count, room);
        assert_eq!(colors.len(), room, "{count}");
        assert!(colors[..answered] == all[..answered], "{count} of {room}");
        let rest = &colors[answered..];
        assert!(
            rest.iter().all(|color| [UNTOUCHED].contains(color)),
            "{count} of {room}"
        );
    }
}

#[test]
fn any_bits_are_a_handle() {
    let Some(gpu) = gpu() else { return };
    check_bits(gpu, &TextureSetOptions::default());
    check_bits(gpu, &SEVERAL);
}

fn check_bits(gpu: &Gpu, set_options: &TextureSetOptions) {
    let mut set = set(gpu, set_options);
    let empty = answers(gpu, &set, &[TextureQuery::default()], 1, 1);
    assert_eq!(empty, [[0.0; 4]], "of a set without textures");
    let handle = set.add(&file(0), &options(FilterMode::Point)).unwrap();
    let bits = (0..32)
        .map(|bit| 1 << bit)
        .chain((0..32).map(|bit| handle.to_bits() ^ 1 << bit))
        .chain([
            0,
            u32::MAX,
            u32::MAX - 1,
            handle.slot(),
            63,
            64,
            0xffff,
            0x1f_ffff,
        ]);
    let bits: Vec<u32> = bits.filter(|&bits| bits != handle.to_bits()).collect();
    let queries: Vec<TextureQuery> = bits
        .iter()
        .flat_map(|&bits| of(TextureHandle::from_bits(bits), &random_queries(4, 9, 0.0)))
        .collect();
    let count = u32::try_from(queries.len()).unwrap();
    let colors = answers(gpu, &set, &queries, count, queries.len());
    let shown = colors.iter().position(|color| *color != [0.0; 4]);
    assert_eq!(shown.map(|index| queries[index]), None, "{set_options:?}");
}

#[test]
fn a_queue_outlives_what_the_set_binds() {
    let Some(gpu) = gpu() else { return };
    let mut set = set(gpu, &TextureSetOptions::default());
    let options = options(FilterMode::Point);
    let first = set.add(&random_texture(1, OUTLINES), &options).unwrap();
    let sampler = QueueSampler::new(&gpu.device, &set).unwrap();
    let queries = of(first, &random_queries(8, 500, 0.2));
    let [queries, count] = [storage(gpu, &queries), storage(gpu, &[500_u32])];
    let colors = storage(gpu, &[UNTOUCHED; 500]);
    let queue = bind(&sampler, [&queries, &count, &colors]).unwrap();
    record(gpu, &sampler, &set, &queue);
    let before: Vec<[f32; 4]> = read(gpu, &colors);
    let generation = set.generation();
    let more: Vec<_> = (2..30).map(|seed| random_texture(seed, OUTLINES)).collect();
    set.add_all(more.iter().map(|file| (file, &options)))
        .unwrap();
    assert!(set.generation() > generation);
    record(gpu, &sampler, &set, &queue);
    assert!(read::<[f32; 4]>(gpu, &colors) == before);
    // A texture with gradients needs another kernel.
    set.add(&file(0), &options).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let refused = sampler.record(&mut encoder, &set, &queue);
    assert!(
        matches!(refused, Err(RuntimeError::Parameter(_))),
        "{refused:?}"
    );
}

#[test]
fn a_sampler_for_one_pool_is_not_for_several() {
    let Some(gpu) = gpu() else { return };
    let options = options(FilterMode::Point);
    let files: Vec<_> = (0..20).map(|seed| random_texture(seed, OUTLINES)).collect();
    let [one, mut several] = [TextureSetOptions::default(), SEVERAL].map(|set_options| {
        let mut set = set(gpu, &set_options);
        set.add(&files[0], &options).unwrap();
        set
    });
    let samplers = [&one, &several].map(|set| QueueSampler::new(&gpu.device, set).unwrap());
    let buffer = storage(gpu, &[0_u32; 64]);
    let queues = samplers.each_ref().map(|sampler| {
        bind(
            sampler,
            [
                &buffer,
                &storage(gpu, &[0_u32]),
                &storage(gpu, &[UNTOUCHED]),
            ],
        )
        .unwrap()
    });
    let is_taken = |sampler: usize, set: &TextureSet, queue: usize| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let recorded = samplers[sampler].record(&mut encoder, set, &queues[queue]);
        assert!(matches!(recorded, Ok(()) | Err(RuntimeError::Parameter(_))));
        recorded.is_ok()
    };
    assert!(is_taken(0, &one, 0) && is_taken(1, &several, 1) && is_taken(1, &one, 1));
    assert!(!is_taken(0, &one, 1) && !is_taken(1, &several, 0));
    assert!(is_taken(0, &several, 0), "which has one pool yet");
    while several.pools().len() < 2 {
        let files = files.iter().map(|file| (file, &options));
        several.add_all(files).unwrap();
    }
    assert!(!is_taken(0, &several, 0));
}

#[test]
fn a_buffer_that_cannot_be_bound_is_an_error() {
    let Some(gpu) = gpu() else { return };
    let set = set(gpu, &TextureSetOptions::default());
    let sampler = QueueSampler::new(&gpu.device, &set).unwrap();
    let good = storage(gpu, &[0_u32; 64]);
    let vertices = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 256,
        usage: wgpu::BufferUsages::VERTEX,
        mapped_at_creation: false,
    });
    assert!(bind(&sampler, [&good, &good, &good]).is_ok());
    let short = storage(gpu, &[0_u32; 3]);
    let refused = bind(&sampler, [&good, &good, &short]);
    assert!(
        matches!(refused, Err(RuntimeError::Parameter(_))),
        "{refused:?}"
    );
    let refused = bind(&sampler, [&vertices, &good, &good]);
    assert!(
        matches!(refused, Err(RuntimeError::Device(_))),
        "{refused:?}"
    );
}

/// The arguments of the longest queue that core WebGPU binds, whose workgroups take two rows.
#[test]
fn arguments_are_those_of_the_host() {
    let Some(gpu) = gpu() else { return };
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(queue_arguments_kernel().into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("vtex_queue_arguments"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let longest = 128 << 20 >> 5;
    let buffer = |size| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        })
    };
    let [queries, colors] = [32 * longest, 16 * longest].map(buffer);
    let longest = u32::try_from(longest).unwrap();
    for count in [
        0,
        1,
        64,
        65,
        1 << 20,
        65_535 * 64,
        65_535 * 64 + 1,
        longest,
        u32::MAX,
    ] {
        let counted = storage(gpu, &[count]);
        let arguments = storage(gpu, &[7_u32; 3]);
        let group = |index, buffers: &[&wgpu::Buffer]| {
            let entries: Vec<_> = (0..)
                .zip(buffers)
                .map(|(binding, buffer)| wgpu::BindGroupEntry {
                    binding,
                    resource: buffer.as_entire_binding(),
                })
                .collect();
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(index),
                entries: &entries,
            })
        };
        let groups = [
            group(0, &[&queries, &counted, &colors]),
            group(1, &[&arguments]),
        ];
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &groups[0], &[]);
        pass.set_bind_group(1, &groups[1], &[]);
        pass.dispatch_workgroups(1, 1, 1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        let expected = batch_dispatch(count.min(longest));
        assert_eq!(read::<u32>(gpu, &arguments), expected, "{count}");
    }
}
