//! Layers of surfaces: coats, glass, colours without light.

use vtex_runtime::{
    Coat, Dielectric, Glass, Instance, Material, Mesh, Scene, Sky, Surface, TraceOptions,
};

use super::light::all_lights;
use super::{furnace, glossy, mean, render};

fn clear(index: f32, absorption: Option<[f32; 3]>) -> Material {
    Material {
        glass: Some(Glass {
            share: 1.0,
            index,
            absorption,
        }),
        ..glossy(0.0, 0.0, [1.0; 3])
    }
}

fn coated(roughness: f32, base: Material) -> Material {
    Material {
        coat: Some(Coat {
            strength: 1.0,
            roughness,
        }),
        ..base
    }
}

/// All layers in the room of all lights.
pub(super) fn all_layers() -> Scene {
    let mut scene = all_lights();
    let mut ball = Mesh::sphere(0.3, 32, 1.0);
    let shade = |[x, y, _]: &[f32; 3]| [0.5 + x, 0.5 + y, 0.8];
    ball.colors = ball.positions.iter().map(shade).collect();
    scene.meshes.push(ball);
    let ball = scene.meshes.len() - 1;
    let tinted = Material {
        base_color: [0.9, 0.95, 0.7],
        ..clear(1.3, None)
    };
    let unlit = Material {
        base_color: [0.2, 0.4, 0.9],
        surface: Surface::Unlit,
        ..Material::default()
    };
    let materials = [
        clear(1.5, Some([0.1, 1.0, 2.0])),
        tinted,
        coated(0.1, glossy(0.5, 0.6, [0.8, 0.2, 0.1])),
        unlit,
    ];
    for (place, material) in (0_u8..).zip(materials) {
        scene.materials.push(material);
        scene.instances.push(Instance {
            mesh: ball,
            material: scene.materials.len() - 1,
            world_from_object: [
                [1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [0.0, 0.0, 1.0],
                [0.7 * f32::from(place) - 1.1, -0.5, 0.8],
            ],
        });
    }
    scene
}

#[test]
fn clear_glass_vanishes_in_a_white_furnace() {
    let options = TraceOptions {
        max_bounces: 64,
        ..TraceOptions::default()
    };
    for (name, material) in [
        ("body", clear(1.5, Some([0.0; 3]))),
        ("thin", clear(1.5, None)),
        ("diamond", clear(2.4, Some([0.0; 3]))),
    ] {
        let scene = furnace(Mesh::sphere(0.7, 96, 1.0), material);
        let Some(film) = render(&scene, [24, 24], 64, &options) else {
            return;
        };
        let [value, ..] = mean(&film);
        // Little is lost where normals of vertices and of triangles disagree, and by masking.
        assert!((0.985..1.001).contains(&value), "{name}: {value}");
    }
}

#[test]
fn bodies_absorb_by_the_way_that_light_takes() {
    // Straight through a slab of thickness 1 of the index of air.
    let mut scene = furnace(
        Mesh::cuboid([40.0, 40.0, 1.0]),
        clear(1.0, Some([0.5, 1.0, 0.0])),
    );
    scene.camera.position = [0.0, 0.0, 4.0];
    scene.camera.fov_y_rad = 0.01;
    let Some(film) = render(&scene, [8, 8], 16, &TraceOptions::default()) else {
        return;
    };
    for (value, wanted) in mean(&film).into_iter().zip([-0.5_f64, -1.0, 0.0]) {
        assert!((value - wanted.exp()).abs() < 0.002, "{value}, {wanted}");
    }
}

#[test]
fn coats_take_no_light_and_add_none() {
    for roughness in [0.0, 0.4, 1.0] {
        for base in [
            Material::default(),
            glossy(1.0, 0.5, [1.0; 3]),
            glossy(0.0, 0.3, [1.0; 3]),
        ] {
            let scene = furnace(Mesh::plane(40.0, 40.0), coated(roughness, base));
            let Some(film) = render(&scene, [16, 16], 256, &TraceOptions::default()) else {
                return;
            };
            let [value, ..] = mean(&film);
            assert!(
                (value - 1.0).abs() < 0.005,
                "{roughness}, {base:?}: {value}"
            );
        }
    }
    // What does not reflect is black, and its coat reflects what a dielectric does.
    let black = Material {
        base_color: [0.0; 3],
        ..Material::default()
    };
    let mut scene = furnace(Mesh::plane(40.0, 40.0), coated(0.0, black));
    scene.camera.position = [0.0, 0.0, 4.0];
    scene.camera.fov_y_rad = 0.01;
    let [value, ..] = mean(&render(&scene, [16, 16], 4096, &TraceOptions::default()).unwrap());
    assert!((value - 0.04).abs() < 0.003, "{value}");
}

#[test]
fn a_colour_without_light_is_what_it_is() {
    let unlit = Material {
        base_color: [0.2, 0.4, 0.9],
        surface: Surface::Unlit,
        ..Material::default()
    };
    let mut scene = furnace(Mesh::plane(40.0, 40.0), unlit);
    scene.sky = Sky::uniform(0.0);
    let Some(film) = render(&scene, [8, 8], 1, &TraceOptions::default()) else {
        return;
    };
    for (value, wanted) in mean(&film).into_iter().zip([0.2, 0.4, 0.9]) {
        assert!((value - wanted).abs() < 1.0e-6, "{value}");
    }
}

#[test]
fn colours_of_vertices_multiply_the_materials() {
    let grey = Material {
        base_color: [0.5; 3],
        ..Material::default()
    };
    let mut scene = furnace(Mesh::plane(40.0, 40.0), grey);
    scene.camera.position = [0.0, 0.0, 4.0];
    scene.camera.fov_y_rad = 0.01;
    // The middle of an edge between both.
    scene.meshes[0].colors = vec![[0.2, 0.8, 0.0], [1.0; 3], [0.6, 0.0, 0.1], [1.0; 3]];
    // Instances of a mesh that is stored once show the same.
    let mut instanced = scene.clone();
    let ball = Mesh::sphere(0.5, 130, 1.0);
    instanced.meshes[0] = Mesh {
        colors: vec![[0.4, 0.4, 0.05]; ball.positions.len()],
        ..ball
    };
    instanced.instances.push(Instance {
        world_from_object: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [9.0; 3]],
        ..instanced.instances[0]
    });
    for scene in [scene, instanced] {
        let Some(film) = render(&scene, [8, 8], 4, &TraceOptions::default()) else {
            return;
        };
        for (value, wanted) in mean(&film).into_iter().zip([0.2, 0.2, 0.025]) {
            assert!((value - wanted).abs() < 0.003, "{value}, {wanted}");
        }
    }
}

#[test]
fn dielectrics_reflect_what_they_are_told_to() {
    let shiny = |straight_on, grazing| Material {
        dielectric: Dielectric {
            straight_on: [straight_on; 3],
            grazing,
        },
        ..glossy(0.0, 0.0, [0.0; 3])
    };
    for (straight_on, grazing) in [(0.17, 1.0), (1.0, 1.0), (0.0, 0.0)] {
        let mut scene = furnace(Mesh::plane(40.0, 40.0), shiny(straight_on, grazing));
        scene.camera.position = [0.0, 0.0, 4.0];
        scene.camera.fov_y_rad = 0.01;
        let Some(film) = render(&scene, [8, 8], 64, &TraceOptions::default()) else {
            return;
        };
        let [value, ..] = mean(&film);
        assert!(
            (value - f64::from(straight_on)).abs() < 0.004,
            "{straight_on}: {value}"
        );
    }
}
