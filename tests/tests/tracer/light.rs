//! What lights a scene: panoramas, lights without size, meshes that glow.

use vtex_runtime::{
    Environment, Film, Instance, LightSampling, Material, Mesh, PunctualKind, PunctualLight, Scene,
    Sky, TraceOptions,
};

use super::{furnace, glossy, lit_scene, lying_at, mean, render};

/// A dim panorama with a strip of sun, three texels wide.
pub(super) fn sunny() -> Environment {
    let texel = |index: u32| match (index % 64, index / 64) {
        (40..=42, 6) => [220.0, 200.0, 160.0],
        (_, 0..=15) => [0.2, 0.3, 0.5],
        _ => [0.1, 0.08, 0.05],
    };
    Environment {
        turn_rad: 0.4,
        ..Environment::new([64, 32], (0..64 * 32).map(texel).collect())
    }
}

fn point(position: [f32; 3], intensity: f32) -> PunctualLight {
    PunctualLight {
        kind: PunctualKind::Point,
        position,
        direction: [0.0, -1.0, 0.0],
        intensity: [intensity; 3],
        range: None,
    }
}

/// A glowing triangle in a corner of the room of [`lit_scene`].
fn add_glow(scene: &mut Scene) {
    scene.meshes.push(Mesh::sphere(0.15, 12, 1.0));
    scene.materials.push(Material {
        emission: [6.0, 3.0, 1.0],
        ..Material::default()
    });
    scene.instances.push(Instance {
        mesh: scene.meshes.len() - 1,
        material: scene.materials.len() - 1,
        world_from_object: [
            [1.0, 0.0, 0.0],
            [0.0, 1.4, 0.0],
            [0.0, 0.0, 1.0],
            [0.6, -0.3, 1.2],
        ],
    });
}

/// Every kind of light at once.
pub(super) fn all_lights() -> Scene {
    let mut scene = lit_scene();
    scene.environment = Some(sunny());
    add_glow(&mut scene);
    let spot = PunctualLight {
        kind: PunctualKind::Spot {
            inner_rad: 0.2,
            outer_rad: 0.5,
        },
        ..point([0.0, 1.2, 2.0], 4.0)
    };
    let sun = PunctualLight {
        kind: PunctualKind::Directional,
        direction: [-0.3, -1.0, -0.4],
        ..point([0.0; 3], 0.4)
    };
    scene.punctual = vec![point([-0.8, 0.4, 1.5], 0.7), spot, sun];
    scene
}

/// A grey wall and nothing else.
fn wall() -> Scene {
    let grey = Material {
        base_color: [0.5; 3],
        ..Material::default()
    };
    let mut scene = furnace(Mesh::plane(40.0, 40.0), grey);
    scene.sky = Sky::uniform(0.0);
    scene.camera.position = [0.0, 0.0, 4.0];
    scene.camera.fov_y_rad = 0.01;
    scene
}

fn seen(scene: &Scene, samples: u32) -> Option<[f64; 3]> {
    let film = render(scene, [8, 8], samples, &TraceOptions::default())?;
    Some(mean(&film))
}

#[test]
fn lights_without_size_are_as_bright_as_their_units_say() {
    let lit = |light: PunctualLight| {
        let mut scene = wall();
        scene.punctual.push(light);
        seen(&scene, 1).map(|[value, ..]| value)
    };
    let [towards, slanted] = [[0.0, 0.0, -1.0], [0.0, -3.0, -3.0]];
    let half = 0.5_f64.sqrt();
    // Irradiance by hand; Lambert of albedo 0.5 makes radiance of it.
    let directional = |direction| PunctualLight {
        kind: PunctualKind::Directional,
        direction,
        ..point([0.0; 3], 3.0)
    };
    let spot = |inner_rad: f32, outer_rad: f32, direction| PunctualLight {
        kind: PunctualKind::Spot {
            inner_rad,
            outer_rad,
        },
        direction,
        ..point([0.0, 0.0, 2.0], 3.0)
    };
    let ranged = PunctualLight {
        range: Some(4.0),
        ..point([0.0, 0.0, 2.0], 3.0)
    };
    // Between the angles of a spot that is turned 30 degrees away.
    let turned = [0.0, -0.5, -(0.75_f32.sqrt())];
    let (inner, outer) = (0.4_f64.cos(), 0.8_f64.cos());
    let between = ((0.75_f64.sqrt() - outer) / (inner - outer)).powi(2);
    let cases = [
        ("sun", directional(towards), 3.0),
        ("slanted sun", directional(slanted), 3.0 * half),
        ("sun behind", directional([0.0, 0.0, 1.0]), 0.0),
        ("point", point([0.0, 0.0, 2.0], 3.0), 0.75),
        ("point aside", point([0.0, 2.0, 2.0], 3.0), 3.0 / 8.0 * half),
        ("within its range", ranged, 0.75 * (1.0 - 0.5_f64.powi(4))),
        ("in the spot", spot(0.2, 0.5, towards), 0.75),
        ("between", spot(0.4, 0.8, turned), 0.75 * between),
        ("beside the spot", spot(0.1, 0.4, turned), 0.0),
    ];
    for (name, light, irradiance) in cases {
        let Some(value) = lit(light) else { return };
        let wanted = 0.5 * irradiance / std::f64::consts::PI;
        assert!((value - wanted).abs() < 1.0e-4, "{name}: {value}, {wanted}");
    }
}

#[test]
fn lights_are_chosen_by_power_and_none_is_lost() {
    // The weaker one of two is chosen rarely and counts in full when it is.
    let of = |intensities: &[f32]| {
        let mut scene = wall();
        let lights = intensities.iter().map(|&i| point([0.0, 0.0, 2.0], i));
        scene.punctual = lights.collect();
        seen(&scene, 64).map(|[value, ..]| value)
    };
    let Some(one) = of(&[3.0]) else { return };
    let many = of(&[0.9, 0.1, 1.0, 0.0, 0.5, 0.5]).unwrap();
    assert!((one - many).abs() < 1.0e-5 * one, "{one} and {many}");
}

#[test]
fn a_panorama_stands_as_its_description_says() {
    let quarters = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]];
    let texel = |index: usize| quarters[index % 64 / 16];
    let panorama = Environment::new([64, 32], (0..64 * 32).map(texel).collect());
    let mut scene = furnace(Mesh::default(), Material::default());
    scene.instances.clear();
    let look = |target: [f32; 3], turn_rad: f32, scene: &mut Scene| {
        scene.camera.position = [0.0; 3];
        scene.camera.target = target;
        scene.environment = Some(Environment {
            turn_rad,
            ..panorama.clone()
        });
        seen(scene, 1)
    };
    // The middle lies towards -z, between the second and the third quarter.
    let [left, right] = [[-0.7, 0.1, -1.0], [0.7, 0.1, -1.0]];
    let [behind_left, behind_right] = [[-0.7, 0.1, 1.0], [0.7, 0.1, 1.0]];
    let turn = std::f32::consts::FRAC_PI_2;
    for (name, target, turn_rad, quarter) in [
        ("left", left, 0.0, 1),
        ("right", right, 0.0, 2),
        ("behind, left", behind_left, 0.0, 0),
        ("behind, right", behind_right, 0.0, 3),
        ("turned right", right, turn, 1),
        ("turned left", left, -turn, 2),
    ] {
        let Some(value) = look(target, turn_rad, &mut scene) else {
            return;
        };
        for (a, b) in value.iter().zip(quarters[quarter]) {
            assert!((a - f64::from(b)).abs() < 0.01, "{name}: {value:?}");
        }
    }
}

#[test]
fn a_white_panorama_is_a_white_furnace() {
    let mut scene = furnace(Mesh::cuboid([1.0; 3]), Material::default());
    scene.environment = Some(Environment::new([16, 8], vec![[1.0; 3]; 128]));
    let Some(film) = render(&scene, [48, 48], 64, &TraceOptions::default()) else {
        return;
    };
    let [value, ..] = mean(&film);
    assert!((value - 1.0).abs() < 0.002, "{value}");
}

/// By how many standard errors pictures of the same scene differ, tile by tile, from independent runs.
pub(super) fn scores(one: &[Film], other: &[Film], tile: u32) -> Vec<f64> {
    let [width, height] = one[0].size;
    let mut scores = Vec::new();
    for top in (0..height).step_by(tile as usize) {
        for left in (0..width).step_by(tile as usize) {
            let of = |film: &Film| {
                let places =
                    (top..top + tile).flat_map(|y| (left..left + tile).map(move |x| (x, y)));
                let value = |(x, y)| film.pixels[(y * width + x) as usize][1];
                places.map(value).map(f64::from).sum::<f64>() / f64::from(tile * tile)
            };
            let [a, b] = [one, other].map(|films| {
                let values: Vec<f64> = films.iter().map(of).collect();
                let count = values.len() as f64;
                let mean = values.iter().sum::<f64>() / count;
                let square = |value: &f64| (value - mean) * (value - mean);
                let spread = values.iter().map(square).sum::<f64>() / (count - 1.0);
                (mean, spread / count)
            });
            scores.push((a.0 - b.0) / (a.1 + b.1).sqrt().max(1.0e-9));
        }
    }
    scores
}

/// Runs with seeds of their own.
fn runs(
    scene: &Scene,
    sampling: LightSampling,
    samples: u32,
    seeds: std::ops::Range<u32>,
) -> Option<Vec<Film>> {
    let film = |seed| {
        let options = TraceOptions {
            light_sampling: sampling,
            indirect_clamp: f32::INFINITY,
            seed,
            ..TraceOptions::default()
        };
        render(scene, [32, 32], samples, &options)
    };
    seeds.map(film).collect()
}

#[test]
fn aiming_and_scattering_differ_by_noise_alone() {
    let mut glow = lit_scene();
    add_glow(&mut glow);
    let mut panorama = lit_scene();
    panorama.environment = Some(sunny());
    panorama.materials[1] = glossy(1.0, 0.2, [0.9, 0.6, 0.3]);
    let mut instanced = glow.clone();
    // A mesh that is stored once and glows in two places.
    instanced.lights.clear();
    let ball = instanced.meshes.len();
    instanced.meshes.push(Mesh::sphere(0.2, 130, 1.0));
    for along in [-0.9, 0.8] {
        let mut placed = lying_at([along, 0.6, 0.9]);
        placed[1][2] *= 1.8;
        instanced.instances.push(Instance {
            mesh: ball,
            material: 2,
            world_from_object: placed,
        });
    }
    for (name, scene) in [
        ("glow", glow),
        ("panorama", panorama),
        ("instances", instanced),
    ] {
        let aimed = runs(&scene, LightSampling::Mis, 12, 0..10);
        let scattered = runs(&scene, LightSampling::ScatterOnly, 48, 100..110);
        let (Some(aimed), Some(scattered)) = (aimed, scattered) else {
            return;
        };
        let scores = scores(&aimed, &scattered, 8);
        let square = scores.iter().map(|z| z * z).sum::<f64>() / scores.len() as f64;
        let worst = scores.iter().fold(0.0_f64, |a, z| a.max(z.abs()));
        // Of 16 scores of 18 degrees of freedom the mean square is 1.1 and hardly ever above 2.5.
        assert!(square < 2.5 && worst < 5.0, "{name}: {scores:?}");
    }
}
