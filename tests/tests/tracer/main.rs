//! The runtime on a real adapter: batch lookups, light transport, orientation.
//!
//! `VTEX_GPU=off` skips these tests and says so; without it a missing adapter is a failure.

#![expect(
    clippy::unwrap_used,
    reason = "helpers of tests fail as tests do, by panicking"
)]

mod awaited;
mod batch;
mod layers;
mod light;
mod staged;

use vtex_format::{CellWord, Grid, Meta, PaintRecord, VtexFile};
use vtex_runtime::{
    Background, Camera, Film, Instance, LightSampling, LoadOptions, Material, Mesh, RectLight,
    RuntimeError, Scene, Sky, Surface, TraceOptions, Tracer, scene,
};
use vtex_tests::gpu::shared as gpu;

/// A file of cells of a single paint, `size` columns and rows; `colors` row by row from the top,
/// straight alpha, sRGB-encoded.
fn cells_file(size: [u32; 2], colors: &[[f32; 4]]) -> VtexFile {
    let solid = |paint| CellWord::Paint { paint }.encode().unwrap();
    let canvas_size = size.map(|side| side as f32 * 10.0);
    let mut file = VtexFile {
        paints: colors.iter().map(|&c| PaintRecord::solid(c)).collect(),
        cells: (0..).zip(colors).map(|(paint, _)| solid(paint)).collect(),
        ..VtexFile::blank(Meta::new(canvas_size, Grid::new(size, 8)))
    };
    let slot = vtex_shaders::BindingSlot::default();
    file.shader.wgsl_fragment = vtex_shaders::fragment(&file.spec, slot);
    file
}

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
const GREEN: [f32; 4] = [0.0, 1.0, 0.0, 1.0];
const BLUE: [f32; 4] = [0.0, 0.0, 1.0, 1.0];
const CLEAR: [f32; 4] = [0.0, 0.0, 0.0, 0.0];

/// Red top left, green top right, blue bottom left, nothing bottom right.
fn quarters() -> VtexFile {
    cells_file([2, 2], &[RED, GREEN, BLUE, CLEAR])
}

fn render(scene: &Scene, size: [u32; 2], samples: u32, options: &TraceOptions) -> Option<Film> {
    let gpu = gpu()?;
    let mut tracer = Tracer::new(&gpu.device, &gpu.queue, scene, size, options).unwrap();
    tracer.accumulate(samples).unwrap();
    Some(tracer.read().unwrap())
}

fn mean(film: &Film) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for pixel in &film.pixels {
        for (total, &value) in sum.iter_mut().zip(pixel) {
            *total += f64::from(value);
        }
    }
    sum.map(|total| total / film.pixels.len() as f64)
}

/// One mesh under a white sky.
fn furnace(mesh: Mesh, material: Material) -> Scene {
    Scene {
        meshes: vec![mesh],
        instances: vec![Instance {
            mesh: 0,
            material: 0,
            world_from_object: Instance::IDENTITY,
        }],
        materials: vec![material],
        textures: Vec::new(),
        environment: None,
        punctual: Vec::new(),
        sky: Sky::uniform(1.0),
        lights: Vec::new(),
        camera: Camera {
            position: [0.4, 0.5, 4.0],
            target: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov_y_rad: 0.4,
        },
    }
}

fn glossy(metallic: f32, roughness: f32, base_color: [f32; 3]) -> Material {
    Material {
        base_color,
        surface: Surface::Glossy {
            metallic,
            roughness,
        },
        ..Material::default()
    }
}

#[test]
fn a_white_diffuse_object_vanishes_in_a_white_furnace() {
    let scene = furnace(Mesh::cuboid([1.0; 3]), Material::default());
    let Some(film) = render(&scene, [48, 48], 16, &TraceOptions::default()) else {
        return;
    };
    for pixel in &film.pixels {
        for &value in &pixel[..3] {
            assert!((value - 1.0).abs() < 1e-5, "{pixel:?}");
        }
    }
}

#[test]
fn a_plane_reflects_its_albedo() {
    let grey = Material {
        base_color: [0.5, 0.25, 0.125],
        ..Material::default()
    };
    let scene = furnace(Mesh::plane(40.0, 40.0), grey);
    let Some(film) = render(&scene, [16, 16], 4, &TraceOptions::default()) else {
        return;
    };
    for (got, want) in mean(&film).iter().zip([0.5, 0.25, 0.125]) {
        assert!((got - want).abs() < 1e-6, "{got} for {want}");
    }
}

#[test]
fn white_glossy_planes_reflect_all_light() {
    // What single scattering between microfacets loses comes back, and Lambert gets what is left.
    for (metallic, roughness) in [(1.0, 0.0), (1.0, 0.5), (1.0, 1.0), (0.0, 0.1), (0.0, 0.8)] {
        let scene = furnace(
            Mesh::plane(40.0, 40.0),
            glossy(metallic, roughness, [1.0; 3]),
        );
        let Some(film) = render(&scene, [16, 16], 256, &TraceOptions::default()) else {
            return;
        };
        let [value, ..] = mean(&film);
        assert!(
            (value - 1.0).abs() < 0.005,
            "{metallic}, {roughness}: {value}"
        );
    }
}

/// Places a plane, which faces z, so that it faces up.
fn lying_at(origin: [f32; 3]) -> [[f32; 3]; 4] {
    [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], origin]
}

/// A wall and a glossy floor with a light that shines down on them.
fn lit_scene() -> Scene {
    let wall = Material {
        base_color: [0.7, 0.6, 0.5],
        ..Material::default()
    };
    let mut scene = furnace(Mesh::plane(4.0, 4.0), wall);
    scene.sky = Sky::uniform(0.0);
    scene.camera.position = [0.0, 1.5, 4.0];
    scene.materials.push(glossy(0.0, 0.4, [0.6; 3]));
    scene.instances.push(Instance {
        mesh: 0,
        material: 1,
        world_from_object: lying_at([0.0, -1.0, 1.0]),
    });
    scene.lights.push(RectLight {
        corner: [-1.0, 1.5, 0.5],
        edge_u: [2.0, 0.0, 0.0],
        edge_v: [0.0, 0.0, 2.0],
        radiance: [2.0, 2.0, 2.0],
    });
    scene
}

#[test]
fn aiming_at_lights_and_scattering_alone_agree() {
    let scene = lit_scene();
    let options = |light_sampling| TraceOptions {
        light_sampling,
        indirect_clamp: f32::INFINITY,
        ..TraceOptions::default()
    };
    let size = [32, 32];
    let Some(aimed) = render(&scene, size, 256, &options(LightSampling::Mis)) else {
        return;
    };
    let scattered = render(&scene, size, 2048, &options(LightSampling::ScatterOnly)).unwrap();
    let (aimed, scattered) = (mean(&aimed), mean(&scattered));
    for (a, b) in aimed.iter().zip(scattered) {
        assert!(*a > 0.05, "dark: {aimed:?}");
        assert!((a - b).abs() < 0.01 * b, "{aimed:?} against {scattered:?}");
    }
}

#[test]
fn a_light_shines_from_its_front_only() {
    let mut scene = lit_scene();
    let light = &mut scene.lights[0];
    std::mem::swap(&mut light.edge_u, &mut light.edge_v);
    // Above everything and turned away, it lights nothing.
    light.corner[1] = 3.0;
    let Some(film) = render(&scene, [16, 16], 8, &TraceOptions::default()) else {
        return;
    };
    assert_eq!(mean(&film), [0.0; 3]);
}

#[test]
fn half_transparent_surfaces_let_half_the_light_through() {
    let file = cells_file([1, 1], &[[0.0, 0.0, 0.0, 0.5]]);
    let mut scene = furnace(
        Mesh::plane(40.0, 40.0),
        Material {
            texture: Some(0),
            ..Material::default()
        },
    );
    scene.textures = vec![(file, LoadOptions::default())];
    let Some(film) = render(&scene, [32, 32], 64, &TraceOptions::default()) else {
        return;
    };
    let [value, ..] = mean(&film);
    assert!((value - 0.5).abs() < 0.01, "camera rays: {value}");

    // The same veil between the light and the wall halves direct light.
    let options = TraceOptions {
        max_bounces: 1,
        ..TraceOptions::default()
    };
    let bare = lit_scene();
    let mut veiled = bare.clone();
    veiled.textures = scene.textures;
    veiled.meshes.push(Mesh::plane(40.0, 40.0));
    veiled.materials.push(scene.materials[0]);
    veiled.instances.push(Instance {
        mesh: 1,
        material: 2,
        world_from_object: lying_at([0.0, 1.4, 0.0]),
    });
    // The camera stays below the veil.
    veiled.camera.position[1] = 1.0;
    let bare = Scene {
        camera: veiled.camera,
        ..bare
    };
    let size = [24, 24];
    let [bare, ..] = mean(&render(&bare, size, 256, &options).unwrap());
    let [veiled, ..] = mean(&render(&veiled, size, 256, &options).unwrap());
    // The light itself is out of sight, so everything on the film is halved.
    assert!((veiled / bare - 0.5).abs() < 0.02, "{veiled} of {bare}");
}

#[test]
fn same_seed_same_picture_however_it_is_cut() {
    let Some(gpu) = gpu() else { return };
    let scene = vtex_scenes::showroom(vec![quarters()]);
    let options = TraceOptions::default();
    let picture = |cuts: &[u32], options: &TraceOptions| {
        let mut tracer = Tracer::new(&gpu.device, &gpu.queue, &scene, [40, 30], options).unwrap();
        for &samples in cuts {
            tracer.accumulate(samples).unwrap();
        }
        tracer.read().unwrap()
    };
    let whole = picture(&[9], &options);
    assert!(whole == picture(&[9], &options), "same run");
    assert!(whole == picture(&[2, 3, 4], &options), "other cuts");
    let other = TraceOptions { seed: 1, ..options };
    assert!(whole.pixels != picture(&[9], &other).pixels, "other seed");
}

#[test]
fn stats_count_rays_and_reset_starts_over() {
    let Some(gpu) = gpu() else { return };
    let scene = furnace(Mesh::plane(40.0, 40.0), Material::default());
    let options = TraceOptions::default();
    let mut tracer = Tracer::new(&gpu.device, &gpu.queue, &scene, [20, 10], &options).unwrap();
    tracer.accumulate(3).unwrap();
    let stats = tracer.stats().unwrap();
    // One camera ray and one into the sky for each path; a plane cannot see itself.
    assert_eq!((stats.rays, stats.triangles), (2 * 3 * 200, 2));
    assert!(stats.device_ns.is_none_or(|ns| ns > 0), "{stats:?}");
    tracer.set_camera(&scene.camera).unwrap();
    assert_eq!((tracer.samples(), tracer.stats().unwrap().rays), (0, 0));
}

#[test]
fn the_texture_stands_upright_on_the_plane() {
    let scene = scene::plane(quarters(), LoadOptions::default());
    let options = TraceOptions::default();
    let Some(film) = render(&scene, [64, 64], 4, &options) else {
        return;
    };
    let at = |x: usize, y: usize| film.pixels[y * 64 + x];
    for (name, pixel, want) in [
        ("top left", at(10, 10), [1.0, 0.0, 0.0]),
        ("top right", at(53, 10), [0.0, 1.0, 0.0]),
        ("bottom left", at(10, 53), [0.0, 0.0, 1.0]),
        ("bottom right shows the sky", at(53, 53), [1.0, 1.0, 1.0]),
        ("left edge", at(0, 20), [1.0, 0.0, 0.0]),
    ] {
        for (got, want) in pixel.iter().zip(want) {
            assert!((got - want).abs() < 1e-5, "{name}: {pixel:?}");
        }
    }
    let transparent = TraceOptions {
        background: Background::Transparent,
        ..options
    };
    let film = render(&scene, [64, 64], 4, &transparent).unwrap();
    assert_eq!(film.pixels[53 * 64 + 53], [0.0; 4]);
    assert_eq!(film.pixels[10 * 64 + 10][3].to_bits(), 1.0_f32.to_bits());
}

#[test]
fn a_zoomed_plane_shows_the_part_asked_for() {
    let file = cells_file([4, 1], &[RED, GREEN, BLUE, RED]);
    let mut scene = scene::plane(file.clone(), LoadOptions::default());
    scene.camera = scene::plane_camera(&file, [0.25, 0.0, 0.5, 1.0], 1.0);
    let Some(film) = render(&scene, [16, 16], 1, &TraceOptions::default()) else {
        return;
    };
    for pixel in &film.pixels {
        assert!(pixel[1] > 0.99 && pixel[0] < 0.01, "{pixel:?}");
    }
}

#[test]
fn all_meshes_show_the_texture_upright_from_outside() {
    let meshes = [
        ("plane", Mesh::plane(2.0, 2.0)),
        ("cuboid", Mesh::cuboid([2.0; 3])),
        ("cylinder", Mesh::cylinder(1.0, 2.0, 64, 1.0)),
        ("sphere", Mesh::sphere(1.0, 64, 1.0)),
    ];
    for (name, mesh) in meshes {
        let mut scene = furnace(
            mesh,
            Material {
                texture: Some(0),
                ..Material::default()
            },
        );
        scene.textures = vec![(quarters(), LoadOptions::default())];
        scene.camera.position = [0.0, 0.0, 6.0];
        let options = TraceOptions {
            max_bounces: 1,
            ..TraceOptions::default()
        };
        let Some(film) = render(&scene, [64, 64], 16, &options) else {
            return;
        };
        let at = |x: usize, y: usize| film.pixels[y * 64 + x];
        let (red, green, blue) = (at(24, 24), at(40, 24), at(24, 40));
        assert!(red[0] > 0.9 && red[1] < 0.1, "{name} top left: {red:?}");
        assert!(
            green[1] > 0.9 && green[0] < 0.1,
            "{name} top right: {green:?}"
        );
        assert!(
            blue[2] > 0.9 && blue[0] < 0.1,
            "{name} bottom left: {blue:?}"
        );
    }
}

#[test]
fn a_scene_that_contradicts_itself_is_refused() {
    let Some(gpu) = gpu() else { return };
    let good = furnace(Mesh::plane(1.0, 1.0), Material::default());
    let check = |what: &str, size, break_it: &dyn Fn(&mut Scene)| {
        let mut scene = good.clone();
        break_it(&mut scene);
        let options = TraceOptions::default();
        let made = Tracer::new(&gpu.device, &gpu.queue, &scene, size, &options);
        let refused = matches!(made, Err(RuntimeError::Parameter(_)));
        assert!(refused, "{what}: {made:?}");
    };
    check("mesh", [8, 8], &|s| s.instances[0].mesh = 7);
    check("vertex", [8, 8], &|s| s.meshes[0].triangles[0][1] = 99);
    check("nan", [8, 8], &|s| s.meshes[0].positions[0][0] = f32::NAN);
    check("texture", [8, 8], &|s| s.materials[0].texture = Some(0));
    check("color", [8, 8], &|s| s.materials[0].base_color[0] = 1.5);
    check("camera", [8, 8], &|s| s.camera.target = s.camera.position);
    check("film", [0, 8], &|_| {});
}

#[test]
fn an_empty_scene_is_sky() {
    let mut scene = furnace(Mesh::default(), Material::default());
    scene.instances.clear();
    // A binding may not be empty, though there is nothing to bind.
    scene.meshes.clear();
    scene.materials.clear();
    let Some(film) = render(&scene, [8, 8], 2, &TraceOptions::default()) else {
        return;
    };
    assert_eq!(film.pixels, vec![[1.0; 4]; 64]);
}
