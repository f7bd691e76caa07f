//! Triangles of a scene in the order of an obvhs CWBVH.

use glam::Vec3A;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use obvhs::triangle::Triangle;

/// Share of the nodes the optimiser moves in each of its rounds: obvhs' own medium preset.
const REINSERTION_BATCH_RATIO: f32 = 0.05;
/// Depth below which the builder searches only neighbours: obvhs' own medium preset.
const SEARCH_DEPTH_THRESHOLD: usize = 3;
/// Triangles a leaf may hold; the node layout allows no more.
const MAX_TRIANGLES_PER_LEAF: u32 = 3;

/// Builds the hierarchy. obvhs' own `build_cwbvh_from_tris` reads a clock, which panics in a
/// browser, so its steps are called one by one.
pub(crate) fn build(triangles: &[Triangle]) -> CwBvh {
    let count = u32::try_from(triangles.len()).unwrap_or(u32::MAX);
    let mut bvh2 = PlocBuilder::with_capacity(triangles.len()).build(
        PlocSearchDistance::Medium,
        triangles,
        (0..count).collect(),
        SortPrecision::U64,
        SEARCH_DEPTH_THRESHOLD,
    );
    ReinsertionOptimizer::default().run(&mut bvh2, REINSERTION_BATCH_RATIO, None);
    // Children are placed so that the shader meets near ones first; it does not read exact boxes.
    bvh2_to_cwbvh(&bvh2, MAX_TRIANGLES_PER_LEAF, true, false)
}

/// Deepest path of inner nodes, which bounds the traversal's stack.
pub(crate) fn depth(bvh: &CwBvh) -> usize {
    let mut deepest = 0;
    // A list instead of recursion: the depth is what is asked, so nothing bounds it yet.
    let mut open: Vec<(u32, usize)> = if bvh.nodes.is_empty() {
        Vec::new()
    } else {
        vec![(0, 1)]
    };
    while let Some((index, depth)) = open.pop() {
        deepest = deepest.max(depth);
        let node = &bvh.nodes[index as usize];
        for child in (0..8).filter(|&child| !node.is_leaf(child)) {
            open.push((node.child_node_index(child), depth + 1));
        }
    }
    deepest
}

/// obvhs' triangle of three corners.
pub(crate) fn triangle(corners: [Vec3A; 3]) -> Triangle {
    let [v0, v1, v2] = corners;
    Triangle { v0, v1, v2 }
}

#[cfg(test)]
#[cfg(feature = "blocking")]
mod tests {
    use obvhs::ray::{Ray, RayHit};

    use glam::{Affine3A, Vec3};

    use super::*;
    use crate::{
        Camera, Gpu, Instance, Material, Mesh, RayQuery, RectLight, Scene, Sky, TraceOptions,
        Tracer,
    };

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

    /// All triangles in the order in which the tracer counts them.
    fn world_triangles(scene: &Scene) -> Vec<Triangle> {
        let mut triangles = Vec::new();
        for instance in &scene.instances {
            let mesh = &scene.meshes[instance.mesh];
            let place = |i: u32| {
                let position = mesh.positions[i as usize].into();
                Affine3A::from_cols_array_2d(&instance.world_from_object)
                    .transform_point3a(position)
            };
            triangles.extend(mesh.triangles.iter().map(|t| triangle(t.map(place))));
        }
        for light in &scene.lights {
            let [corner, edge_u, edge_v] =
                [light.corner, light.edge_u, light.edge_v].map(Vec3::from);
            let at = |u: f32, v: f32| Vec3A::from(corner + edge_u * u + edge_v * v);
            triangles.push(triangle([at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)]));
            triangles.push(triangle([at(0.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)]));
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
        let bvh = build(&triangles);
        let (mut hits, mut differences) = (0, 0);
        for (query, found) in rays.iter().zip(found) {
            let direction = Vec3A::from(query.direction);
            let ray = Ray::new(query.origin.into(), direction, 0.0, query.t_max);
            let mut nearest = RayHit::none();
            let hit = bvh.ray_traverse(ray, &mut nearest, |ray, id| {
                triangles[bvh.primitive_indices[id] as usize].intersect(ray)
            });
            let expected = hit.then(|| {
                let triangle = bvh.primitive_indices[nearest.primitive_id as usize];
                (nearest.t.to_bits(), triangle)
            });
            hits += usize::from(hit);
            let found = found.map(|hit| (hit.t.to_bits(), hit.triangle));
            differences += usize::from(found != expected);
        }
        assert!(hits > rays.len() / 2, "only {hits} rays hit");
        // Graphics cards may fuse multiply and add; software drivers compute as written.
        let allowed = if gpu.is_software() {
            0
        } else {
            rays.len() / 100
        };
        assert!(
            differences <= allowed,
            "{differences} of {hits} hits differ"
        );
    }
}
