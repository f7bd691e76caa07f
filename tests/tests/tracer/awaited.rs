//! The forms of the runtime's calls that are awaited: same answers as the blocking ones.

use std::pin::pin;
use std::task::{Context, Poll, Waker};

use vtex_format::VtexFile;
use vtex_runtime::{
    BatchQuery, BatchSampler, Gpu, GpuVtex, LoadOptions, RayQuery, TraceOptions, Tracer, Trust,
    scene,
};

use super::{gpu, quarters};

/// An executor of one thread, which knows nothing of wgpu: nobody but the future polls the device.
fn run<T>(future: impl Future<Output = T>) -> T {
    pollster::block_on(future)
}

#[test]
fn awaited_lookups_are_those_of_the_blocking_form() {
    let Some(gpu) = gpu() else { return };
    let (file, options) = (quarters(), LoadOptions::default());
    let queries: Vec<BatchQuery> = (0..100_000)
        .map(|i| BatchQuery {
            uv: [(i % 317) as f32 / 317.0, (i / 317) as f32 / 317.0],
            ..BatchQuery::default()
        })
        .collect();
    let blocking =
        BatchSampler::new(&gpu.device, &gpu.queue, &file, &options, Trust::Regenerate).unwrap();
    let awaited = run(async {
        let sampler =
            BatchSampler::new_async(&gpu.device, &gpu.queue, &file, &options, Trust::Regenerate);
        sampler.await?.sample_async(&queries).await
    });
    assert!(awaited.unwrap() == blocking.sample(&queries).unwrap());
}

#[test]
fn awaited_pictures_are_those_of_the_blocking_form() {
    let Some(gpu) = gpu() else { return };
    let scene = scene::plane(quarters(), LoadOptions::default());
    let (size, options) = ([40, 30], TraceOptions::default());
    let mut blocking = Tracer::new(&gpu.device, &gpu.queue, &scene, size, &options).unwrap();
    blocking.accumulate(5).unwrap();
    let rays = [
        RayQuery {
            origin: [-0.1, 0.2, 3.0],
            direction: [0.0, 0.0, -1.0],
            t_max: 10.0,
        },
        RayQuery {
            origin: [9.0, 9.0, 3.0],
            direction: [0.0, 0.0, -1.0],
            t_max: 10.0,
        },
    ];
    let (film, stats, hits) = run(async {
        let made = Tracer::new_async(&gpu.device, &gpu.queue, &scene, size, &options).await;
        let mut tracer = made.unwrap();
        tracer.accumulate_async(5).await.unwrap();
        (
            tracer.read_async().await.unwrap(),
            tracer.stats_async().await.unwrap(),
            tracer.intersect_async(&rays).await.unwrap(),
        )
    });
    assert!(film == blocking.read().unwrap());
    assert_eq!(stats.rays, blocking.stats().unwrap().rays);
    assert_eq!(hits, blocking.intersect(&rays).unwrap());
    assert!(
        hits[0].is_some_and(|hit| (hit.t - 3.0).abs() < 1e-5),
        "{hits:?}"
    );
    assert_eq!(hits[1], None);
}

#[test]
fn a_picture_whose_samples_were_given_up_half_way_starts_again() {
    let Some(gpu) = gpu() else { return };
    let scene = scene::plane(quarters(), LoadOptions::default());
    let (size, options) = ([300, 300], TraceOptions::default());
    let tracer = || Tracer::new(&gpu.device, &gpu.queue, &scene, size, &options).unwrap();
    let mut whole = tracer();
    whole.accumulate(2).unwrap();
    let mut given_up = tracer();
    given_up.accumulate(1).unwrap();
    {
        // Many submissions: the first wait for the device comes before the end.
        let future = pin!(given_up.accumulate_async(64));
        let polled = future.poll(&mut Context::from_waker(Waker::noop()));
        assert!(
            matches!(polled, Poll::Pending),
            "nothing was left to give up"
        );
    }
    given_up.accumulate(2).unwrap();
    assert_eq!(given_up.samples(), 2);
    assert!(given_up.read().unwrap() == whole.read().unwrap());
}

/// Compiles when all futures may go on in another thread, as executors of several threads want.
#[test]
fn futures_can_move_between_threads() {
    fn movable<T: Send>(_: T) {}
    fn check(gpu: &Gpu, file: &VtexFile, tracer: &mut Tracer, sampler: &BatchSampler) {
        let (device, queue, load) = (&gpu.device, &gpu.queue, LoadOptions::default());
        let scene = scene::plane(file.clone(), LoadOptions::default());
        movable(Gpu::headless_async());
        movable(GpuVtex::upload_async(device, queue, file, &load));
        movable(BatchSampler::new_async(
            device,
            queue,
            file,
            &load,
            Trust::File,
        ));
        movable(sampler.sample_async(&[]));
        movable(Tracer::new_async(
            device,
            queue,
            &scene,
            [1, 1],
            &TraceOptions::default(),
        ));
        movable(tracer.accumulate_async(1));
        movable(tracer.read_async());
        movable(tracer.stats_async());
        movable(tracer.intersect_async(&[]));
    }
    let _: fn(&Gpu, &VtexFile, &mut Tracer, &BatchSampler) = check;
}
