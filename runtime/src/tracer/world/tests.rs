//! Hits on the device beside those of obvhs, and scenes that cannot be traced as they are.

use obvhs::ray::{Ray, RayHit};

use glam::{Affine3A, Quat};

use super::*;
use crate::{Camera, Gpu, Material, Mesh, RayQuery, Sky, TraceOptions, Tracer};

/// Round and flat things on a floor under a light, so that the hierarchy is deep and leaves
/// lie at all depths.
fn crowded_scene() -> Scene {
    let lying = Affine3A::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    let at = |x: f32, y: f32, z: f32| Affine3A::from_translation(Vec3::new(x, y, z));
    let placed = [
        (Mesh::plane(20.0, 20.0), lying),
        (Mesh::sphere(0.5, 128, 1.0), at(0.0, 0.5, 0.0)),
        (Mesh::cylinder(0.4, 0.8, 96, 1.0), at(1.2, 0.4, 0.1)),
        (Mesh::cuboid([1.0; 3]), at(-1.2, 0.5, -0.2)),
    ];
    let place = |(mesh, (_, placed)): (usize, &(Mesh, Affine3A))| Instance {
        mesh,
        material: 0,
        world_from_object: placed.to_cols_array_2d(),
    };
    Scene {
        instances: placed.iter().enumerate().map(place).collect(),
        meshes: placed.into_iter().map(|(mesh, _)| mesh).collect(),
        materials: vec![Material::default()],
        textures: Vec::new(),
        sky: Sky::uniform(1.0),
        environment: None,
        punctual: Vec::new(),
        lights: vec![RectLight {
            corner: [-1.0, 3.0, -1.0],
            edge_u: [2.0, 0.0, 0.0],
            edge_v: [0.0, 0.0, 2.0],
            radiance: [1.0; 3],
        }],
        camera: Camera {
            position: [0.25, 1.45, 4.9],
            target: [0.0, 0.42, 0.0],
            up: [0.0, 1.0, 0.0],
            fov_y_rad: 0.55,
        },
    }
}

/// Graphics cards may fuse multiply and add; software drivers compute as written.
fn assert_equal_hits(gpu: &Gpu, differences: usize, hits: usize, rays: usize) {
    let allowed = if gpu.is_software() { 0 } else { rays / 100 };
    assert!(
        differences <= allowed,
        "{differences} of {hits} hits differ"
    );
}

/// All triangles in the order in which the tracer counts them.
fn world_triangles(scene: &Scene) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for instance in &scene.instances {
        let mesh = &scene.meshes[instance.mesh];
        let place = |i: u32| {
            let position = mesh.positions[i as usize].into();
            Affine3A::from_cols_array_2d(&instance.world_from_object).transform_point3a(position)
        };
        triangles.extend(mesh.triangles.iter().map(|t| bvh::triangle(t.map(place))));
    }
    for light in &scene.lights {
        let [corner, edge_u, edge_v] = [light.corner, light.edge_u, light.edge_v].map(Vec3::from);
        let at = |u: f32, v: f32| Vec3A::from(corner + edge_u * u + edge_v * v);
        triangles.push(bvh::triangle([at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)]));
        triangles.push(bvh::triangle([at(0.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)]));
    }
    triangles
}

/// Rays through pixel centres.
fn primary_rays(camera: &Camera, size: [u32; 2]) -> Vec<RayQuery> {
    let [right, up, forward] = camera.axes().unwrap();
    let tangent = (0.5 * camera.fov_y_rad).tan();
    let [width, height] = size.map(|side| side as f32);
    let ray = |i: u32| {
        let x = ((i % size[0]) as f32 + 0.5) / width * 2.0 - 1.0;
        let y = ((i / size[0]) as f32 + 0.5) / height * 2.0 - 1.0;
        let direction = forward + tangent * (x * width / height * right - y * up);
        RayQuery {
            origin: camera.position,
            direction: direction.normalize().to_array(),
            t_max: f32::MAX,
        }
    };
    (0..size[0] * size[1]).map(ray).collect()
}

#[test]
fn traversal_on_the_device_is_that_of_obvhs_to_the_bit() {
    if !vtex_testing::gpu("traversal on the device") {
        return;
    }
    let gpu = Gpu::headless().expect("an adapter; VTEX_GPU=off skips this test");
    let scene = crowded_scene();
    let options = TraceOptions::default();
    let tracer = Tracer::new(&gpu.device, &gpu.queue, &scene, [8, 8], &options).unwrap();
    let rays = primary_rays(&scene.camera, [480, 320]);
    let found = tracer.intersect(&rays).unwrap();
    // So few that their buffer is padded.
    let few = rays.len() / 2..rays.len() / 2 + 3;
    let alone = tracer.intersect(&rays[few.clone()]).unwrap();
    assert_eq!(alone, found[few], "few rays");

    let triangles = world_triangles(&scene);
    let tree = bvh::build(&triangles);
    let (mut hits, mut differences) = (0, 0);
    for (query, found) in rays.iter().zip(found) {
        let direction = Vec3A::from(query.direction);
        let ray = Ray::new(query.origin.into(), direction, 0.0, query.t_max);
        let mut nearest = RayHit::none();
        let hit = tree.ray_traverse(ray, &mut nearest, |ray, id| {
            triangles[tree.primitive_indices[id] as usize].intersect(ray)
        });
        let expected = hit.then(|| {
            let triangle = tree.primitive_indices[nearest.primitive_id as usize];
            (nearest.t.to_bits(), triangle)
        });
        hits += usize::from(hit);
        let found = found.map(|hit| (hit.t.to_bits(), hit.triangle));
        differences += usize::from(found != expected);
    }
    assert!(hits > rays.len() / 2, "only {hits} rays hit");
    assert_equal_hits(&gpu, differences, hits, rays.len());
}

/// Spheres of one mesh, turned, stretched, mirrored and in other units, over a floor.
fn instanced_scene() -> Scene {
    let mut scene = crowded_scene();
    let sphere = scene.meshes.len();
    scene.meshes.push(Mesh::sphere(300.0, 40, 1.0));
    for i in 0_u8..48 {
        let turn = f32::from(i);
        let size = 0.001 + 0.0002 * (turn * 1.7).sin();
        let scale = Vec3::new(size, 0.6 * size, if i % 3 == 0 { -size } else { size });
        let place = Vec3::new(
            2.0 * (turn * 2.4).sin(),
            0.03 * turn,
            2.0 * (turn * 1.3).cos(),
        );
        let rotation = Quat::from_euler(glam::EulerRot::XYZ, turn, 0.3 * turn, 2.0 * turn);
        let placed = Affine3A::from_scale_rotation_translation(scale, rotation, place);
        scene.instances.push(Instance {
            mesh: sphere,
            material: 0,
            world_from_object: placed.to_cols_array_2d(),
        });
    }
    scene
}

/// A ray in the space of a mesh, by the operations of `trace/world/instance.wgsl`.
fn local_ray(world_from_object: &[[f32; 3]; 4], query: &RayQuery) -> Ray {
    let inverse = Affine3A::from_cols_array_2d(world_from_object).inverse();
    let along = |row: usize, v: [f32; 3]| {
        let r = inverse.matrix3.row(row);
        r.x * v[0] + r.y * v[1] + r.z * v[2]
    };
    let direction = Vec3A::from([0, 1, 2].map(|row| along(row, query.direction)));
    let origin = [0, 1, 2].map(|row| along(row, query.origin) + inverse.translation[row]);
    let mut ray = Ray::new(origin.into(), direction, 0.0, query.t_max);
    let least = (direction.abs().max_element() * 2.0_f32.powi(-23)).max(2.0_f32.powi(-120));
    ray.inv_direction = Vec3A::from(direction.to_array().map(|d| {
        let kept = if d.abs() > least {
            d
        } else {
            least.copysign(d)
        };
        1.0 / kept
    }));
    ray
}

/// Each triangle that is nearest along a ray, as `t` and number, by trying all of those that
/// `candidates` names.
fn nearest(scene: &Scene, query: &RayQuery, trees: &[CwBvh], all: bool) -> Vec<(u32, u32)> {
    let mut hits: Vec<(f32, u32)> = Vec::new();
    let mut first = 0;
    for instance in &scene.instances {
        let mesh = &scene.meshes[instance.mesh];
        let ray = local_ray(&instance.world_from_object, query);
        let corner = |i: u32| Vec3A::from(mesh.positions[i as usize]);
        let meets = |ray: &Ray, index: u32| {
            bvh::triangle(mesh.triangles[index as usize].map(corner)).intersect(ray)
        };
        let tree = &trees[instance.mesh];
        if all {
            let count = index_u32(mesh.triangles.len());
            hits.extend((0..count).map(|index| (meets(&ray, index), first + index)));
        } else {
            let mut nearest = RayHit::none();
            tree.ray_traverse(ray, &mut nearest, |ray, id| {
                meets(ray, tree.primitive_indices[id])
            });
            if nearest.t < f32::MAX {
                let index = tree.primitive_indices[nearest.primitive_id as usize];
                hits.push((nearest.t, first + index));
            }
        }
        first += index_u32(mesh.triangles.len());
    }
    let least = hits.iter().fold(f32::MAX, |least, (t, _)| least.min(*t));
    let ties = hits
        .into_iter()
        .filter(|(t, _)| *t == least && least < f32::MAX);
    ties.map(|(t, index)| (t.to_bits(), index)).collect()
}

#[test]
fn hits_of_instances_are_those_of_obvhs_and_of_trying_all() {
    if !vtex_testing::gpu("instances on the device") {
        return;
    }
    let gpu = Gpu::headless().expect("an adapter; VTEX_GPU=off skips this test");
    let mut scene = instanced_scene();
    // What is placed is compared by another test; here each ray meets instances alone.
    scene.lights.clear();
    scene
        .instances
        .retain(|instance| instance.mesh + 1 == scene.meshes.len());
    let options = TraceOptions::default();
    let tracer = Tracer::new(&gpu.device, &gpu.queue, &scene, [8, 8], &options).unwrap();
    assert_eq!(
        tracer.stats().unwrap().dropped_triangles,
        48 * 40,
        "slivers at a pole"
    );
    let rays = primary_rays(&scene.camera, [240, 160]);
    let found = tracer.intersect(&rays).unwrap();
    let trees: Vec<CwBvh> = scene
        .meshes
        .iter()
        .map(|mesh| {
            let corner = |i: u32| Vec3A::from(mesh.positions[i as usize]);
            let triangles = mesh.triangles.iter().map(|t| bvh::triangle(t.map(corner)));
            bvh::build(&triangles.collect::<Vec<_>>())
        })
        .collect();
    let (mut hits, mut differences) = (0, 0);
    for (number, (query, found)) in rays.iter().zip(found).enumerate() {
        let found = found.map(|hit| (hit.t.to_bits(), hit.triangle));
        let mut checks = vec![nearest(&scene, query, &trees, false)];
        if number % 101 == 0 {
            checks.push(nearest(&scene, query, &trees, true));
        }
        hits += usize::from(found.is_some());
        let agrees = |ties: &Vec<(u32, u32)>| match found {
            // Where two triangles are met at the same t either will do.
            Some(found) => ties.contains(&found),
            None => ties.is_empty(),
        };
        differences += usize::from(!checks.iter().all(agrees));
    }
    assert!(hits > rays.len() / 10, "only {hits} rays hit");
    assert_equal_hits(&gpu, differences, hits, rays.len());
}

#[test]
fn a_million_instanced_triangles_take_little_more_than_their_mesh() {
    let mut scene = crowded_scene();
    scene.meshes = vec![Mesh::sphere(1.0, 100, 1.0)];
    let count = scene.meshes[0].triangles.len();
    assert_eq!(count, 10_000);
    scene.instances = (0_u8..100)
        .map(|i| Instance {
            mesh: 0,
            material: 0,
            world_from_object: Affine3A::from_translation(Vec3::X * 3.0 * f32::from(i))
                .to_cols_array_2d(),
        })
        .collect();
    let world = World::new(&scene).unwrap();
    assert_eq!(world.triangle_count, 1_000_002);
    let bytes = size_of_val(&*world.nodes)
        + size_of_val(&*world.triangles)
        + size_of_val(&*world.attributes);
    assert!(bytes < 2 << 20, "{bytes} bytes");
    // Numbers of the scene count each instance in full.
    let numbers =
        (0..100).map(|i| world.source_triangle(world.first_level, world.first_record + 7 * i));
    let mut instances: Vec<u32> = numbers.map(|number| number / index_u32(count)).collect();
    instances.sort_unstable();
    assert!(instances.into_iter().eq(0..100));
}

/// Triangles by their corners.
fn soup(corners: &[[[f32; 3]; 3]]) -> Mesh {
    let mut mesh = Mesh::default();
    for (corners, first) in corners.iter().zip((0..).step_by(3)) {
        mesh.positions.extend(corners);
        mesh.normals.extend([[0.0, 0.0, 1.0]; 3]);
        mesh.uvs.extend([[0.0; 2]; 3]);
        mesh.triangles.push([first, first + 1, first + 2]);
    }
    mesh
}

#[test]
fn triangles_that_no_ray_can_meet_are_dropped_and_counted() {
    let sound = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let scaled = |by: f32| sound.map(|corner| corner.map(|c| c * by));
    let hostile = [
        scaled(0.0),
        scaled(3.0e38),
        scaled(-3.0e38),
        scaled(1.0e13),
        scaled(1.0e-20),
        scaled(f32::MIN_POSITIVE),
        scaled(f32::from_bits(1)),
        [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
        [
            [3.0e38, -3.0e38, 0.0],
            [-3.0e38, 3.0e38, 1.0],
            [0.0, 0.0, 3.0e38],
        ],
    ];
    let mut corners = vec![sound; 20];
    corners.extend(hostile);
    let mut scene = crowded_scene();
    scene.lights.clear();
    scene.meshes = vec![soup(&corners)];
    let matrices = [
        Affine3A::IDENTITY,
        Affine3A::from_scale(Vec3::splat(3.0)),
        // Nothing is left of these.
        Affine3A::from_scale(Vec3::ZERO),
        Affine3A::from_scale(Vec3::splat(1.0e30)),
        Affine3A::from_translation(Vec3::splat(3.0e38)),
        // Flat, and still there.
        Affine3A::from_scale(Vec3::new(1.0, 1.0, 0.0)),
    ];
    let instance = |matrix: &Affine3A| Instance {
        mesh: 0,
        material: 0,
        world_from_object: matrix.to_cols_array_2d(),
    };
    scene.instances = matrices.iter().map(instance).collect();
    for most_placed in [usize::MAX, 0] {
        let world = World::with_most_placed(&scene, most_placed).unwrap();
        assert_eq!(world.triangle_count, 6 * 29);
        // Of the smallest, one is made large enough.
        assert_eq!(world.dropped, 3 * 9 + 3 * 29 - 1, "{most_placed}");
    }
}

#[test]
fn crowds_of_equal_triangles_and_of_all_sizes_are_built() {
    let sound = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let equal = vec![sound; 200_000];
    let growing: Vec<_> = (-200_i16..210)
        .flat_map(|e| {
            let size = 2.0_f32.powf(f32::from(e) * 0.15);
            let scaled = sound.map(|corner| corner.map(|c| c * size));
            [scaled, scaled.map(|corner| corner.map(|c| c + size))]
        })
        .collect();
    let row: Vec<_> = (0_u16..5000)
        .map(|i| sound.map(|[x, y, z]| [x + 4.0 * f32::from(i), 1.0e-6 * y, z]))
        .collect();
    for corners in [equal, growing, row] {
        let mut scene = crowded_scene();
        let count = corners.len();
        scene.meshes = vec![soup(&corners)];
        scene.instances.truncate(1);
        let world = World::new(&scene).unwrap();
        assert_eq!(world.triangles.len(), count + 2);
    }
}

#[test]
fn an_instance_shows_what_the_same_mesh_placed_shows() {
    if !vtex_testing::gpu("pictures of instances") {
        return;
    }
    let gpu = Gpu::headless().expect("an adapter; VTEX_GPU=off skips this test");
    let instanced = instanced_scene();
    let mut placed = instanced.clone();
    // A mesh of its own for each is placed.
    for instance in &mut placed.instances {
        let mesh = placed.meshes[instance.mesh].clone();
        instance.mesh = placed.meshes.len();
        placed.meshes.push(mesh);
    }
    let options = TraceOptions {
        max_bounces: 2,
        ..TraceOptions::default()
    };
    let [one, other] = [&instanced, &placed].map(|scene| {
        let mut tracer = Tracer::new(&gpu.device, &gpu.queue, scene, [96, 64], &options).unwrap();
        tracer.accumulate(4).unwrap();
        (tracer.read().unwrap(), tracer.stats().unwrap())
    });
    assert!(
        one.1.geometry_bytes * 4 < other.1.geometry_bytes,
        "{one:?}",
        one = one.1
    );
    let mean = |film: &crate::Film| film.pixels.iter().flatten().sum::<f32>();
    let (one, other) = (one.0, other.0);
    let off = (mean(&one) / mean(&other) - 1.0).abs();
    assert!(off < 2.0e-3, "means differ by {off}");
    let pairs = one.pixels.iter().zip(&other.pixels);
    let far = pairs
        .filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 0.1))
        .count();
    assert!(far < one.pixels.len() / 50, "{far} pixels differ");
}
