//! The path tracer in stages shows what the one in a single kernel shows.

use vtex_format::{Features, VtexFile};
use vtex_runtime::{
    Background, Film, FilterMode, Instance, Integrator, LightSampling, LoadOptions, Material, Mesh,
    Scene, Sky, TraceOptions, Tracer, Trust, scene,
};

use super::layers::all_layers;
use super::light::all_lights;
use super::{RED, cells_file, furnace, glossy, gpu, lit_scene, lying_at, mean, quarters};

/// What must hold of two pictures with the same random numbers.
const EQUAL_SHARE: f64 = 0.999;
const EQUAL_WITHIN: f32 = 1.0 / 255.0;
const MEANS_WITHIN: f64 = 0.001;

fn bake(svg: &str) -> VtexFile {
    vtex_baker::bake(svg.as_bytes(), &Default::default(), &Default::default()).unwrap()
}

/// Drawings with different kernel keys: curves, gradients, translucent groups that blend, clips.
fn drawings() -> Vec<VtexFile> {
    let svg = |body: &str| {
        bake(&format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 40">{body}</svg>"##
        ))
    };
    vec![
        svg(
            r##"<path d="M2 2h36L20 38z" fill="#c33"/><circle cx="20" cy="14" r="9" fill="#fff"/>"##,
        ),
        svg(
            r##"<linearGradient id="g"><stop stop-color="#06c"/><stop offset="1" stop-color="#fc0"/>
            </linearGradient><circle cx="20" cy="20" r="18" fill="url(#g)"/>"##,
        ),
        svg(
            r##"<g style="isolation:isolate" opacity=".7"><rect width="30" height="30" fill="#0a5"/>
            <circle cx="26" cy="26" r="13" fill="#d2a" style="mix-blend-mode:multiply"/></g>"##,
        ),
        svg(
            r##"<clipPath id="c"><circle cx="20" cy="20" r="15"/></clipPath>
            <g clip-path="url(#c)"><path d="M0 0h40v20H0z" fill="#25d"/>
            <path d="M0 22L40 30V40H0z" fill="#fa0" fill-opacity=".5"/></g>"##,
        ),
    ]
}

fn footprints(mut scene: Scene) -> Scene {
    for (_, options) in &mut scene.textures {
        options.pack.filter = FilterMode::Footprint;
    }
    scene
}

/// Three see-through drawings one behind the other between a light and a wall.
fn veils() -> Scene {
    let mut scene = lit_scene();
    scene.meshes.push(Mesh::plane(2.5, 2.5));
    for (place, file) in (0..).zip(drawings().into_iter().skip(1)) {
        scene.textures.push((file, LoadOptions::default()));
        scene.materials.push(Material {
            texture: Some(place),
            ..Material::default()
        });
        scene.instances.push(Instance {
            mesh: 1,
            material: 2 + place,
            world_from_object: lying_at([0.0, 0.2 + 0.3 * place as f32, 1.0]),
        });
    }
    scene
}

/// More see-through surfaces in a row than a path may pass.
fn stack_of_veils() -> Scene {
    let file = cells_file([1, 1], &[[0.2, 0.1, 0.0, 0.02]]);
    let mut scene = furnace(Mesh::plane(4.0, 4.0), Material::default());
    scene.textures.push((file, LoadOptions::default()));
    scene.materials[0].texture = Some(0);
    let first = scene.instances[0];
    scene.instances = (0..80)
        .map(|place| Instance {
            world_from_object: [
                first.world_from_object[0],
                first.world_from_object[1],
                first.world_from_object[2],
                [0.0, 0.0, -0.01 * place as f32],
            ],
            ..first
        })
        .collect();
    scene.lights = lit_scene().lights;
    scene
}

/// A mesh that is stored once, see-through in one place and solid in another, turned, stretched and
/// mirrored.
fn instances() -> Scene {
    let mut scene = lit_scene();
    let ball = Mesh::sphere(0.45, 96, 2.0);
    assert!(4 * ball.triangles.len() > 16_384, "more than is placed");
    scene.meshes.push(ball);
    for (place, file) in drawings().into_iter().enumerate() {
        scene.textures.push((file, LoadOptions::default()));
        scene.materials.push(Material {
            texture: Some(place),
            backing: (place % 2 == 0).then_some([0.8, 0.8, 0.7]),
            ..Material::default()
        });
        let along = place as f32 - 1.5;
        let mirrored = if place == 3 { -1.0 } else { 1.0 };
        scene.instances.push(Instance {
            mesh: 1,
            material: 2 + place,
            world_from_object: [
                [0.8 * mirrored, 0.3, 0.0],
                [-0.3, 1.0 + 0.1 * along, 0.2],
                [0.0, -0.2, 0.7],
                [0.6 * along, 0.5, 0.2 * along],
            ],
        });
    }
    scene
}

fn room_of_a_furnace() -> Scene {
    let mut scene = furnace(
        Mesh::sphere(0.7, 24, 1.0),
        glossy(1.0, 0.3, [0.9, 0.7, 0.3]),
    );
    scene.sky = Sky {
        zenith: [0.2, 0.4, 1.0],
        horizon: [1.0, 0.9, 0.7],
        ground: [0.1, 0.2, 0.1],
    };
    scene
}

/// Name, scene, options, film.
fn cases() -> Vec<(&'static str, Scene, TraceOptions, [u32; 2])> {
    let options = TraceOptions::default();
    let mut empty = furnace(Mesh::default(), Material::default());
    (empty.instances, empty.meshes, empty.materials) = Default::default();
    vec![
        ("nothing but sky", empty, options, [9, 7]),
        ("metal, no texture", room_of_a_furnace(), options, [64, 48]),
        ("a light, no texture", lit_scene(), options, [64, 48]),
        (
            "lights found by chance",
            lit_scene(),
            TraceOptions {
                light_sampling: LightSampling::ScatterOnly,
                ..options
            },
            [48, 48],
        ),
        (
            "glow alone",
            lit_scene(),
            TraceOptions {
                max_bounces: 0,
                ..options
            },
            [48, 32],
        ),
        (
            "one texture, see-through",
            scene::plane(quarters(), LoadOptions::default()),
            TraceOptions {
                background: Background::Transparent,
                ..options
            },
            [64, 64],
        ),
        (
            "four keys in a room",
            vtex_scenes::showroom(drawings()),
            options,
            [96, 64],
        ),
        (
            "four keys in a room, footprints",
            footprints(vtex_scenes::showroom(drawings())),
            TraceOptions { seed: 7, ..options },
            [96, 64],
        ),
        ("see-through surfaces", veils(), options, [64, 48]),
        ("coats and glass", all_layers(), options, [64, 48]),
        (
            "a panorama, points and glow",
            all_lights(),
            options,
            [64, 48],
        ),
        (
            "a panorama found by chance",
            all_lights(),
            TraceOptions {
                light_sampling: LightSampling::ScatterOnly,
                ..options
            },
            [48, 32],
        ),
        ("instances", instances(), options, [96, 64]),
        ("too many of them", stack_of_veils(), options, [32, 32]),
    ]
}

fn traced(
    scene: &Scene,
    size: [u32; 2],
    options: TraceOptions,
    cuts: &[u32],
) -> Option<(Film, u64)> {
    let gpu = gpu()?;
    let mut tracer = Tracer::new(&gpu.device, &gpu.queue, scene, size, &options).unwrap();
    for &samples in cuts {
        tracer.accumulate(samples).unwrap();
    }
    assert_eq!(tracer.notices(), &[] as &[String], "every kernel is used");
    Some((tracer.read().unwrap(), tracer.stats().unwrap().rays))
}

fn with(integrator: Integrator, options: TraceOptions) -> TraceOptions {
    TraceOptions {
        integrator,
        ..options
    }
}

fn assert_same(name: &str, single: &Film, staged: &Film) {
    let near = |(a, b): (&[f32; 4], &[f32; 4])| {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() <= EQUAL_WITHIN)
    };
    let pairs = || single.pixels.iter().zip(&staged.pixels);
    let equal = pairs().filter(|&pair| near(pair)).count();
    let share = equal as f64 / single.pixels.len() as f64;
    assert!(
        share >= EQUAL_SHARE,
        "{name}: {share} of the pixels are alike"
    );
    for (a, b) in mean(single).into_iter().zip(mean(staged)) {
        assert!(
            (a - b).abs() <= MEANS_WITHIN * a.abs(),
            "{name}: {a} and {b}"
        );
    }
}

#[test]
fn stages_and_one_kernel_show_the_same() {
    for (name, scene, options, size) in cases() {
        // One by one: lavapipe ends all loops of an invocation after 65,535 rounds together, which one
        // kernel needs for a few samples of the stack of see-through surfaces.
        let cuts = [1; 8];
        let of = |integrator| traced(&scene, size, with(integrator, options), &cuts);
        let (Some((single, rays)), Some((staged, staged_rays))) =
            (of(Integrator::Single), of(Integrator::Staged))
        else {
            return;
        };
        assert_same(name, &single, &staged);
        let apart = rays.abs_diff(staged_rays) as f64 / rays as f64;
        assert!(apart <= 0.001, "{name}: {rays} rays and {staged_rays}");
    }
}

#[test]
fn stages_do_not_depend_on_how_samples_are_cut() {
    let scene = veils();
    let options = with(Integrator::Staged, TraceOptions::default());
    // Larger than a submission, and not a multiple of anything.
    let size = [331, 203];
    let Some((whole, _)) = traced(&scene, size, options, &[3]) else {
        return;
    };
    let (cut, _) = traced(&scene, size, options, &[1, 2]).unwrap();
    assert!(whole == cut);
}

#[test]
fn more_keys_than_queues_share_the_last() {
    let sets = [
        Features::LISTS,
        Features::LISTS | Features::CURVES,
        Features::GRADIENTS,
        Features::LISTS | Features::MSDF,
        Features::LISTS | Features::GROUPS,
    ];
    // Features that a file does not need change its key and not what it shows.
    let file = |index: usize| {
        let mut file = cells_file([1, 1], &[[0.1 + 0.03 * index as f32, 0.5, 0.2, 1.0]]);
        file.spec.features |= sets[index % 5] | if index < 5 { 0 } else { sets[index / 5] };
        file
    };
    let mut scene = vtex_scenes::showroom((0..25).map(file).collect());
    // All in a row, so that each is seen.
    scene.textures = (0..25).map(|i| (file(i), LoadOptions::default())).collect();
    scene.meshes = vec![Mesh::plane(0.1, 1.0)];
    scene.materials = (0..25)
        .map(|texture| Material {
            texture: Some(texture),
            ..Material::default()
        })
        .collect();
    scene.instances = (0..25)
        .map(|material| Instance {
            mesh: 0,
            material,
            world_from_object: [
                Instance::IDENTITY[0],
                Instance::IDENTITY[1],
                Instance::IDENTITY[2],
                [0.1 * material as f32 - 1.2, 0.5, 0.0],
            ],
        })
        .collect();
    let options = TraceOptions::default();
    let of = |integrator| traced(&scene, [100, 40], with(integrator, options), &[4]);
    let (Some((single, _)), Some((staged, _))) = (of(Integrator::Single), of(Integrator::Staged))
    else {
        return;
    };
    assert_same("many keys", &single, &staged);
}

#[test]
fn files_kernels_look_up_their_textures() {
    let Some(gpu) = gpu() else { return };
    let scene = veils();
    let staged = with(Integrator::Staged, TraceOptions::default());
    let trusting = TraceOptions {
        trust: Trust::File,
        ..staged
    };
    let size = [72, 48];
    let (ours, _) = traced(&scene, size, staged, &[8]).unwrap();
    let (theirs, _) = traced(&scene, size, trusting, &[8]).unwrap();
    assert_same("files' kernels", &ours, &theirs);

    // A kernel that answers something else shows that it is the file's which runs.
    let mut foreign = scene.clone();
    for (file, _) in &mut foreign.textures {
        file.shader = vtex_shaders::shader_blob(&vtex_format::SpecKey {
            features: Features::LISTS,
        })
        .unwrap();
    }
    let mut tracer = Tracer::new(&gpu.device, &gpu.queue, &foreign, size, &trusting).unwrap();
    tracer.accumulate(8).unwrap();
    assert_eq!(tracer.notices().len(), 3, "{:?}", tracer.notices());
    let blunt = tracer.read().unwrap();
    assert!(blunt.pixels != ours.pixels, "the files' kernels run");
    // One that is refused is replaced.
    for (file, _) in &mut foreign.textures {
        file.shader.batch_spirv = vec![0x0723_0203, 1, 2, 3, 4, 5, 6, 7];
    }
    let mut tracer = Tracer::new(&gpu.device, &gpu.queue, &foreign, size, &trusting).unwrap();
    tracer.accumulate(8).unwrap();
    assert_eq!(tracer.notices().len(), 6, "{:?}", tracer.notices());
    assert!(tracer.read().unwrap() == ours);
}

#[test]
fn more_textures_than_may_have_kernels_of_their_own_are_told() {
    let Some(gpu) = gpu() else { return };
    let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><path d="M0 0h9L4 9z"/></svg>"##;
    let mut scene = scene::plane(cells_file([1, 1], &[RED]), LoadOptions::default());
    scene.textures = vec![(bake(svg), LoadOptions::default()); 12];
    let options = TraceOptions {
        trust: Trust::File,
        ..with(Integrator::Staged, TraceOptions::default())
    };
    let tracer = Tracer::new(&gpu.device, &gpu.queue, &scene, [8, 8], &options).unwrap();
    let notices = tracer.notices();
    assert_eq!(notices.len(), 1, "{notices:?}");
    assert!(notices[0].contains("4 files"), "{notices:?}");
}

#[test]
fn every_stage_takes_time() {
    let Some(gpu) = gpu() else { return };
    let scene = veils();
    let staged = with(Integrator::Staged, TraceOptions::default());
    let mut tracer = Tracer::new(&gpu.device, &gpu.queue, &scene, [48, 32], &staged).unwrap();
    let times = tracer.accumulate_timed(2).unwrap();
    tracer.accumulate(1).unwrap();
    let (film, _) = traced(&scene, [48, 32], staged, &[3]).unwrap();
    assert!(tracer.read().unwrap() == film);
    assert_eq!(tracer.integrator(), Integrator::Staged);
    if gpu
        .device
        .features()
        .contains(wgpu::Features::TIMESTAMP_QUERY)
    {
        let names: Vec<&str> = times.iter().map(|time| time.stage).collect();
        let stages = [
            "generate",
            "hit",
            "surface",
            "lookups",
            "veil",
            "shade",
            "shadow",
            "arguments",
            "advance",
            "film",
        ];
        assert_eq!(names, stages);
        for time in &times[..7] {
            assert!(time.device_ns > 0, "{times:?}");
        }
    } else {
        assert_eq!(times, []);
    }
}
