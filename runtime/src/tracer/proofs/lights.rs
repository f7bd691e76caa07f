//! What paths aim at.

use super::Probe;
use super::chi_square::{self, Slack, check};
use crate::{Camera, Environment, Instance, Material, Mesh, RectLight, Scene, Sky};

const IMPORTS: &[&str] = &[
    "trace/bvh",
    "trace/surface",
    "trace/light/far",
    "trace/light/sample",
];

/// Lights have edges, and cells do where they do not fall on those of bins.
const EDGES: Slack = Slack {
    apart: 5.0e-3,
    edges: 0.01,
};
const EXACT: Slack = Slack {
    edges: 0.0,
    ..EDGES
};

/// Aims from the place that `proof_input` says. The density of a direction is what a path computes that meets
/// a light there by chance.
const SUBJECT: &str = "
fn subject_place() -> vec3f {
    return vec3f(proof_input[0], proof_input[1], proof_input[2]);
}

fn subject_sample(stream: ptr<function, u32>) -> vec4f {
    let light = light_sample(subject_place(), stream);
    return vec4f(light.direction, light.pdf);
}

fn subject_pdf(direction: vec3f) -> f32 {
    let ray = ray_new(subject_place(), direction, RAY_INFINITY);
    let hit = bvh_closest(ray);
    if hit.triangle == TRACE_NONE {
        return light_far_pdf(direction);
    }
    let point = surface_at(ray, hit, Cone(0.0, 0.0));
    let material = trace_materials[point.material];
    if material.is_panel == 1u && !point.front {
        return 0.0;
    }
    return light_area_pdf(material.light_density, -dot(point.geometric_normal, direction), hit.t);
}
";

/// A square that faces up, of so many triangles that its copies are instances of one mesh.
fn grid() -> Mesh {
    const SIDE: u16 = 72;
    let mut mesh = Mesh::default();
    for place in 0..(SIDE + 1) * (SIDE + 1) {
        let along = |index: u16| 2.0 * f32::from(index) / f32::from(SIDE) - 1.0;
        let [x, z] = [place % (SIDE + 1), place / (SIDE + 1)];
        mesh.positions.push([along(x), 0.0, along(z)]);
        mesh.normals.push([0.0, 1.0, 0.0]);
        mesh.uvs.push([0.0; 2]);
        if x < SIDE && z < SIDE {
            let [a, b] = [place, place + SIDE + 1].map(u32::from);
            mesh.triangles.push([a, b, a + 1]);
            mesh.triangles.push([a + 1, b, b + 1]);
        }
    }
    mesh
}

/// Meshes that glow and rectangles, none of which hides another as seen from around the origin.
fn areas() -> Scene {
    let glow = |emission| Material {
        emission,
        ..Material::default()
    };
    let at = |mesh, material, place: [f32; 3], size: [f32; 3]| Instance {
        mesh,
        material,
        world_from_object: [
            [size[0], 0.1, 0.0],
            [0.0, size[1], 0.2],
            [0.0, 0.0, size[2]],
            place,
        ],
    };
    Scene {
        // The large one is stored once.
        meshes: vec![Mesh::plane(1.0, 1.0), grid()],
        instances: vec![
            at(0, 0, [0.0, 0.0, -3.0], [2.0, 1.5, 1.0]),
            at(0, 1, [0.0, 0.3, 3.0], [1.0, 1.0, 1.0]),
            at(1, 2, [0.0, -2.0, 0.0], [1.0, 1.0, 1.0]),
            at(1, 2, [0.0, 3.0, 0.5], [0.7, 1.0, 1.2]),
        ],
        materials: vec![glow([4.0; 3]), glow([2.0, 3.0, 0.5]), glow([0.5; 3])],
        textures: Vec::new(),
        sky: Sky::uniform(0.0),
        environment: None,
        lights: vec![
            RectLight {
                corner: [2.5, -0.5, -0.5],
                edge_u: [0.0, 0.0, 1.0],
                edge_v: [0.0, 1.0, 0.2],
                radiance: [3.0; 3],
            },
            // Turned away.
            RectLight {
                corner: [-2.5, -0.5, -0.5],
                edge_u: [0.0, 0.0, 1.0],
                edge_v: [0.0, 1.0, 0.0],
                radiance: [1.0; 3],
            },
        ],
        punctual: Vec::new(),
        camera: Camera::facing_rect([0.0; 2], [1.0; 2], 1.0),
    }
}

fn panorama(size: [u32; 2], turn_rad: f32) -> Environment {
    let texel = |index: u32| match (index % size[0], index / size[0]) {
        (x, y) if x == size[0] / 3 && y == size[1] / 4 => [60.0; 3],
        (x, y) => [0.2 + 0.01 * (x % 17) as f32, 0.3, 0.02 * (y % 11) as f32],
    };
    Environment {
        turn_rad,
        ..Environment::new(size, (0..size[0] * size[1]).map(texel).collect())
    }
}

fn prove(what: &str, scene: &Scene, places: &[[f32; 3]], slack: Slack) {
    let text = [SUBJECT, chi_square::KERNELS].concat();
    let Some(probe) = Probe::new(what, scene, IMPORTS, &text) else {
        return;
    };
    assert_eq!(probe.tracer.notices(), &[] as &[String]);
    for place in places {
        check(&probe, &format!("{what} from {place:?}"), place, slack);
    }
}

#[test]
fn areas_are_aimed_at_by_the_density_that_paths_compute() {
    // Rounding at edges makes some rays miss what was aimed at.
    let places = [[0.0; 3], [0.3, 0.2, -0.4], [-0.5, -0.3, 0.2]];
    prove("areas", &areas(), &places, EDGES);
}

#[test]
fn panoramas_are_aimed_at_by_the_density_that_paths_compute() {
    let mut scene = areas();
    scene.instances.clear();
    scene.lights.clear();
    for (size, turn_rad) in [
        ([32, 16], 0.0),
        ([64, 32], 0.7),
        ([50, 23], -2.0),
        ([2048, 600], 0.3),
    ] {
        scene.environment = Some(panorama(size, turn_rad));
        prove(&format!("panorama of {size:?}"), &scene, &[[0.0; 3]], EXACT);
    }
}

#[test]
fn all_at_once_are_aimed_at_by_the_density_that_paths_compute() {
    let mut scene = areas();
    scene.environment = Some(panorama([64, 32], 1.0));
    // Directions that meet a light in front of the panorama are aimed at for the panorama too; so it shines
    // from below alone, where nothing is.
    scene.instances.retain(|instance| instance.material != 2);
    let [width, height] = [64, 32];
    let texel = |index: u32| match index / width {
        26.. => [1.0; 3],
        _ => [0.0; 3],
    };
    let texels = (0..width * height).map(texel).collect();
    scene.environment = Some(Environment::new([width, height], texels));
    prove("all lights", &scene, &[[0.0; 3], [0.1, 0.2, 0.1]], EDGES);
}
