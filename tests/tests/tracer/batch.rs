//! Lookups through [`BatchSampler`] and whose shader answers them.

use vtex_format::{Features, SHADER_ABI, SpecKey, VtexFile};
use vtex_runtime::{BatchQuery, BatchSampler, GpuVtex, LoadOptions, RuntimeError, Trust};

use super::{BLUE, CLEAR, GREEN, RED, gpu, quarters};

fn query(u: f32, v: f32) -> BatchQuery {
    BatchQuery {
        uv: [u, v],
        ..BatchQuery::default()
    }
}

#[test]
fn batch_sampler_answers_in_order_over_chunks() {
    let Some(gpu) = gpu() else { return };
    let file = quarters();
    let options = LoadOptions::default();
    let sampler =
        BatchSampler::new(&gpu.device, &gpu.queue, &file, &options, Trust::Regenerate).unwrap();
    assert_eq!(sampler.notices(), &[] as &[String]);
    assert_eq!(sampler.sample(&[]).unwrap(), Vec::<[f32; 4]>::new());
    let corners = [
        query(0.2, 0.2),
        query(0.8, 0.2),
        query(0.2, 0.8),
        query(0.8, 0.8),
    ];
    let queries: Vec<BatchQuery> = corners.iter().copied().cycle().take(200_001).collect();
    let colors = sampler.sample(&queries).unwrap();
    assert_eq!(colors.len(), queries.len());
    let expected = [RED, GREEN, BLUE, CLEAR];
    for (i, color) in colors.iter().enumerate() {
        assert_eq!(*color, expected[i % 4], "query {i}");
    }
}

#[test]
fn a_stored_shader_that_is_not_the_keys_is_told_and_not_used() {
    let Some(gpu) = gpu() else { return };
    let options = LoadOptions::default();
    let sampler = |file: &VtexFile, trust| {
        BatchSampler::new(&gpu.device, &gpu.queue, file, &options, trust).unwrap()
    };
    let mut other_text = quarters();
    other_text.shader.wgsl_fragment.push_str("// edited\n");
    let mut other_abi = quarters();
    other_abi.shader.abi = SHADER_ABI + 1;
    let mut noise = quarters();
    noise.shader.batch_spirv = vec![0x0723_0203, 1, 2, 3, 4, 5, 6, 7];
    for (name, file, trust, notices) in [
        ("text", &other_text, Trust::Regenerate, 1),
        ("abi", &other_abi, Trust::Regenerate, 1),
        ("abi, trusted", &other_abi, Trust::File, 1),
        ("noise", &noise, Trust::Regenerate, 0),
        ("noise, trusted", &noise, Trust::File, 1),
    ] {
        let sampler = sampler(file, trust);
        let told = sampler.notices();
        assert_eq!(told.len(), notices, "{name}: {told:?}");
        let colors = sampler.sample(&[query(0.8, 0.2)]).unwrap();
        assert_eq!(colors, [GREEN], "{name}");
    }
}

#[test]
fn a_trusted_file_runs_its_own_kernel() {
    let Some(gpu) = gpu() else { return };
    let svg = br##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 20">
        <circle cx="10" cy="10" r="8" fill="#f00"/><path d="M20 0h20v20z" fill="#00f"/></svg>"##;
    let file = vtex_baker::bake(svg, &Default::default(), &Default::default()).unwrap();
    let queries: Vec<BatchQuery> = (0..2000)
        .map(|i| {
            query(
                (i % 50) as f32 / 50.0 + 0.003,
                (i / 50) as f32 / 40.0 + 0.007,
            )
        })
        .collect();
    let sample = |file: &VtexFile, trust| {
        let options = LoadOptions::default();
        let sampler = BatchSampler::new(&gpu.device, &gpu.queue, file, &options, trust).unwrap();
        (sampler.sample(&queries).unwrap(), sampler.notices().len())
    };
    let (ours, notices) = sample(&file, Trust::Regenerate);
    assert_eq!(notices, 0, "a fresh bake stores what its key makes");
    assert!(ours.contains(&RED) && ours.contains(&BLUE) && ours.contains(&CLEAR));
    let (theirs, notices) = sample(&file, Trust::File);
    assert_eq!(notices, 0, "its kernel is accepted");
    assert!(ours == theirs, "both kernels give the same colours");

    // A kernel that answers something else shows that it is the file's which runs: one that sees no
    // outlines takes all that a cell lists for covered.
    let mut foreign = file.clone();
    foreign.shader = vtex_shaders::shader_blob(&SpecKey {
        features: Features::LISTS,
    })
    .unwrap();
    assert!(sample(&foreign, Trust::Regenerate) == (ours.clone(), 1));
    let (blunt, notices) = sample(&foreign, Trust::File);
    assert_eq!(notices, 1, "a text that is not the key's is told");
    let covered = |colors: &[[f32; 4]]| colors.iter().filter(|color| [RED].contains(color)).count();
    assert!(
        covered(&blunt) > covered(&ours),
        "the file's kernel runs: there is more of the disc"
    );
}

#[test]
fn a_texture_past_the_binding_limit_is_refused() {
    let Some(gpu) = gpu() else { return };
    let mut file = quarters();
    file.tiles = vec![0; 129 << 20];
    let error = GpuVtex::upload(&gpu.device, &gpu.queue, &file, &LoadOptions::default());
    assert!(matches!(error, Err(RuntimeError::Limit(_))), "{error:?}");
}
