//! Sets whose textures do not fit one bind group.

use std::collections::BTreeSet;

use vtex_format::VtexFile;
use vtex_runtime::{
    FilterMode, Gpu, LoadOptions, QueueSampler, RuntimeError, TextureHandle, TextureQuery,
    TextureSet, TextureSetOptions,
};
use vtex_tests::parity::random_queries;

use super::queue::{UNTOUCHED, answers, bind, record};
use super::{SEVERAL, Shader, assert_as_alone, file, gpu, of, options, read, set, storage};

/// Enough for some pools.
fn filled(gpu: &Gpu, options: &LoadOptions) -> (TextureSet, Vec<VtexFile>, Vec<TextureHandle>) {
    let mut set = set(gpu, &SEVERAL);
    let files: Vec<VtexFile> = (0..24).map(file).collect();
    let handles = set
        .add_all(files.iter().map(|file| (file, options)))
        .unwrap();
    let pools = set.pools().len();
    assert!((3..20).contains(&pools), "{pools}");
    let used: BTreeSet<u32> = handles.iter().map(|handle| handle.pool()).collect();
    assert_eq!(used.len(), pools, "none is empty");
    for pool in set.pools() {
        let size = pool.buffer.size();
        assert!(size <= SEVERAL.pool_bytes, "{size}");
    }
    (set, files, handles)
}

/// Lookups in all of these, mixed as rays' are, and in handles of no texture.
fn mixed(handles: &[TextureHandle]) -> Vec<TextureQuery> {
    let others = [0, 1, u32::MAX, 31 << 16 | 1 << 21].map(TextureHandle::from_bits);
    let handles: Vec<TextureHandle> = handles.iter().copied().chain(others).collect();
    let queries = random_queries(11, 4000, 0.3);
    let handle = |i: usize| handles[i * 7 % handles.len()];
    (0..)
        .zip(&queries)
        .flat_map(|(i, query)| of(handle(i), std::slice::from_ref(query)))
        .collect()
}

fn all_answers(gpu: &Gpu, set: &TextureSet, queries: &[TextureQuery]) -> Vec<[f32; 4]> {
    let count = u32::try_from(queries.len()).unwrap();
    answers(gpu, set, queries, count, queries.len())
}

#[test]
fn a_queue_of_all_pools_is_answered_as_each_pool_and_each_texture_alone() {
    let Some(gpu) = gpu() else { return };
    let options = options(FilterMode::Footprint);
    let (set, files, handles) = filled(gpu, &options);
    let queries = mixed(&handles);
    let ours = all_answers(gpu, &set, &queries);
    assert!(!ours.contains(&UNTOUCHED));
    // One shader, each pool in turn: its own textures show, all others are zeros.
    let shader = Shader::new(gpu, &set);
    for (index, pool) in (0..).zip(set.pools()) {
        let theirs = shader.run(gpu, pool.bind_group, &queries);
        let expected: Vec<[f32; 4]> = queries
            .iter()
            .zip(&ours)
            .map(|(query, &color)| match query.handle.pool() == index {
                true => color,
                false => [0.0; 4],
            })
            .collect();
        assert!(theirs == expected, "pool {index}");
    }
    for (index, (file, &handle)) in files.iter().zip(&handles).enumerate() {
        let queries = random_queries(index as u64, 300, 0.3);
        let ours = shader.run(gpu, set.bind_group_of(handle), &of(handle, &queries));
        assert!(ours.iter().flatten().any(|&channel| channel > 0.0));
        assert_as_alone(gpu, (file, &options), index, &queries, &ours);
    }
}

#[test]
fn textures_of_all_pools_come_and_go() {
    let Some(gpu) = gpu() else { return };
    let options = options(FilterMode::Point);
    let (mut set, files, handles) = filled(gpu, &options);
    let queries = mixed(&handles);
    let before = all_answers(gpu, &set, &queries);
    let (pools, generation, bytes) = (set.pools().len(), set.generation(), set.bytes());
    let gone: BTreeSet<TextureHandle> = handles.iter().copied().step_by(3).collect();
    for &handle in &gone {
        assert!(set.remove(handle) && !set.contains(handle) && !set.remove(handle));
    }
    assert_eq!(set.len(), handles.len() - gone.len());
    let expected: Vec<[f32; 4]> = queries
        .iter()
        .zip(&before)
        .map(|(query, &color)| match gone.contains(&query.handle) {
            true => [0.0; 4],
            false => color,
        })
        .collect();
    assert!(all_answers(gpu, &set, &queries) == expected);
    // The same textures have the same room again, and other handles.
    let again: Vec<_> = files.iter().step_by(3).collect();
    let again = set
        .add_all(again.into_iter().map(|file| (file, &options)))
        .unwrap();
    assert!(again.iter().all(|handle| !handles.contains(handle)));
    assert_eq!(set.bytes().words, bytes.words);
    assert_eq!((set.pools().len(), set.generation()), (pools, generation));
    assert!(
        all_answers(gpu, &set, &queries) == expected,
        "stale handles stay stale"
    );
    let new = all_answers(gpu, &set, &mixed(&again));
    assert!(new.iter().flatten().any(|&channel| channel > 0.0));
    let listed: BTreeSet<TextureHandle> = set.handles().collect();
    let kept = handles.iter().filter(|handle| !gone.contains(handle));
    assert_eq!(listed, kept.chain(&again).copied().collect());
}

#[test]
fn a_full_pool_opens_the_next_and_the_last_is_an_error() {
    let Some(gpu) = gpu() else { return };
    let options = options(FilterMode::Point);
    let mut set = set(
        gpu,
        &TextureSetOptions {
            max_pools: 3,
            ..SEVERAL
        },
    );
    let mut groups = vec![set.bind_group().clone()];
    let mut handles = Vec::new();
    let error = loop {
        let before = (set.pools().len(), set.generation(), set.bytes(), set.len());
        match set.add(&file(handles.len() as u64), &options) {
            Ok(handle) => handles.push(handle),
            Err(error) => {
                let after = (set.pools().len(), set.generation(), set.bytes(), set.len());
                assert_eq!(before, after, "nothing changes");
                break error;
            }
        }
        if set.pools().len() > groups.len() {
            assert!(set.generation() > before.1);
            let now: Vec<_> = set.pools().map(|pool| pool.bind_group.clone()).collect();
            assert!(
                now[..groups.len()] == groups,
                "the full ones stay as they are"
            );
        }
        groups = set.pools().map(|pool| pool.bind_group.clone()).collect();
        assert!(handles.len() < 1000, "there is an end");
    };
    let message = error.to_string();
    assert!(matches!(error, RuntimeError::Limit(_)), "{message}");
    for word in [
        "`max_pools` is 3",
        "max_storage_buffer_binding_size",
        "pool_bytes",
        "remove textures",
    ] {
        assert!(message.contains(word), "{word}: {message}");
    }
    assert_eq!(set.pools().len(), 3);
    assert_eq!(set.bind_group_of(handles[0]), &groups[0]);
    assert_eq!(set.bind_group_of(*handles.last().unwrap()), &groups[2]);
    assert_eq!(
        set.bind_group_of(TextureHandle::from_bits(u32::MAX)),
        &groups[0]
    );
    // The room of one that goes is the next one's, whichever pool it is in.
    let index = handles
        .iter()
        .position(|handle| handle.pool() == 1)
        .unwrap();
    assert!(set.remove(handles[index]));
    let handle = set.add(&file(index as u64), &options).unwrap();
    assert_eq!(handle.pool(), 1);
}

#[test]
fn a_queue_outlives_pools_that_come() {
    let Some(gpu) = gpu() else { return };
    let options = options(FilterMode::Point);
    let mut set = set(
        gpu,
        &TextureSetOptions {
            features: TextureSetOptions::every_feature(FilterMode::Point).features,
            pool_bytes: 1 << 19,
            ..SEVERAL
        },
    );
    let first = set.add(&file(0), &options).unwrap();
    let sampler = QueueSampler::new(&gpu.device, &set).unwrap();
    let queries = of(first, &random_queries(8, 500, 0.2));
    let [queries, count] = [storage(gpu, &queries), storage(gpu, &[500_u32])];
    let colors = storage(gpu, &[UNTOUCHED; 500]);
    let queue = bind(&sampler, [&queries, &count, &colors]).unwrap();
    record(gpu, &sampler, &set, &queue);
    let before: Vec<[f32; 4]> = read(gpu, &colors);
    let more: Vec<_> = (1..20).map(file).collect();
    set.add_all(more.iter().map(|file| (file, &options)))
        .unwrap();
    assert!(set.pools().len() > 2);
    record(gpu, &sampler, &set, &queue);
    assert!(read::<[f32; 4]>(gpu, &colors) == before);
}

#[test]
fn the_bytes_of_all_textures_have_a_limit_of_the_users() {
    let Some(gpu) = gpu() else { return };
    let options = options(FilterMode::Point);
    let limited = TextureSetOptions {
        max_bytes: 1 << 21,
        ..TextureSetOptions::default()
    };
    let mut set = set(gpu, &limited);
    let files: Vec<VtexFile> = (0..200).map(file).collect();
    let error = set
        .add_all(files.iter().map(|file| (file, &options)))
        .unwrap_err();
    let message = error.to_string();
    assert!(matches!(error, RuntimeError::Limit(_)), "{message}");
    assert!(
        message.contains("max_bytes") && message.contains("2097152"),
        "{message}"
    );
    assert!(set.is_empty());
    let added = files
        .iter()
        .take_while(|&file| set.add(file, &options).is_ok());
    assert!(added.count() > 3);
    let bytes = set.bytes();
    assert!(bytes.words + bytes.texels <= 1 << 21);
}
