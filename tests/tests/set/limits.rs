//! What does not fit says which limit it is and what to do, and changes nothing.

use vtex_runtime::{
    FilterMode, Gpu, RuntimeError, TextureHandle, TextureSet, TextureSetOptions, wgpu,
};
use vtex_tests::parity::random_queries;

use super::{Shader, file, gpu, of, options, set};

/// A device with less than core WebGPU has.
fn small(change: impl FnOnce(&mut wgpu::Limits)) -> Option<Gpu> {
    gpu()?;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default())).unwrap();
    let mut required_limits = wgpu::Limits::defaults();
    change(&mut required_limits);
    let request = adapter.request_device(&wgpu::DeviceDescriptor {
        required_limits,
        ..Default::default()
    });
    let (device, queue) = pollster::block_on(request).unwrap();
    Some(Gpu::from_parts(adapter.get_info(), device, queue))
}

/// Adds textures until one is refused; what the set had stays, and room that is freed serves again.
fn fill(gpu: &Gpu, set: &mut TextureSet, told: &[&str]) {
    let options = options(FilterMode::Point);
    let mut handles: Vec<TextureHandle> = Vec::new();
    let error = loop {
        // Those of kind 1 have images.
        match set.add(&file(1), &options) {
            Ok(handle) => handles.push(handle),
            Err(error) => break error,
        }
        assert!(handles.len() < 1000, "there is an end");
    };
    let message = error.to_string();
    assert!(matches!(error, RuntimeError::Limit(_)), "{message}");
    for word in told {
        assert!(message.contains(word), "{word}: {message}");
    }
    assert!(handles.len() > 1, "some fit");
    assert_eq!(set.len(), handles.len(), "those that fit");
    let (generation, bytes) = (set.generation(), set.bytes());
    assert!(set.add(&file(1), &options).is_err(), "again");
    let pair = [file(4), file(1)];
    assert!(
        set.add_all(pair.iter().map(|file| (file, &options)))
            .is_err(),
        "all of them or none"
    );
    assert_eq!(
        (set.generation(), set.bytes()),
        (generation, bytes),
        "nothing changes"
    );
    let shader = Shader::new(gpu, set);
    let queries = random_queries(3, 100, 0.2);
    let colors =
        |set: &TextureSet, handle| shader.run(gpu, set.bind_group(), &of(handle, &queries));
    let first = colors(set, handles[0]);
    assert!(first.iter().flatten().any(|&c| c > 0.0), "it shows");
    assert!(set.remove(handles[1]), "it was there");
    let again = set.add(&file(1), &options).unwrap();
    assert!(colors(set, handles[0]) == first, "the others stay");
    // The same file in another room: places on the page are rounded otherwise.
    let second = colors(set, again);
    let differences = first.iter().flatten().zip(second.iter().flatten());
    let largest = differences.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(largest < 1e-4, "{largest}");
}

#[test]
fn words_beyond_a_storage_binding() {
    let Some(gpu) = small(|limits| limits.max_storage_buffer_binding_size = 1 << 18) else {
        return;
    };
    let mut set = set(&gpu, &TextureSetOptions::default());
    let told = [
        "max_storage_buffer_binding_size",
        "262144",
        "max_pools",
        "remove textures",
        "second set",
    ];
    fill(&gpu, &mut set, &told);
}

#[test]
fn words_beyond_a_buffer() {
    let Some(gpu) = small(|limits| {
        limits.max_buffer_size = 1 << 18;
    }) else {
        return;
    };
    let mut set = set(&gpu, &TextureSetOptions::default());
    fill(&gpu, &mut set, &["max_buffer_size", "remove textures"]);
}

#[test]
fn texels_beyond_the_layers_of_a_texture() {
    let Some(gpu) = small(|limits| limits.max_texture_array_layers = 2) else {
        return;
    };
    let mut set = set(
        &gpu,
        &TextureSetOptions {
            page_side: 300,
            ..TextureSetOptions::default()
        },
    );
    let told = [
        "max_texture_array_layers",
        "2 pages of 256 x 256",
        "page_side",
    ];
    fill(&gpu, &mut set, &told);
}

#[test]
fn a_level_beyond_the_side_of_a_page() {
    let Some(gpu) = small(|limits| limits.max_texture_dimension_2d = 64) else {
        return;
    };
    let mut set = set(&gpu, &TextureSetOptions::default());
    let error = set.add(&file(1), &options(FilterMode::Point)).unwrap_err();
    let message = error.to_string();
    assert!(matches!(error, RuntimeError::Limit(_)), "{message}");
    for word in ["68", "64 a side", "max_texture_dimension_2d"] {
        assert!(message.contains(word), "{word}: {message}");
    }
    assert!(set.is_empty());
    // Without images it needs no page.
    let outlines = vtex_tests::fixture::random_texture(0, vtex_format::Features::LISTS);
    set.add(&outlines, &options(FilterMode::Point)).unwrap();
}
