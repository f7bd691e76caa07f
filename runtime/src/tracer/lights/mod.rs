//! What paths aim at: lights with their chances, and the panorama behind the scene.

mod alias;
mod panorama;
mod texture;

use std::f64::consts::PI;

use glam::{Affine3A, Vec3, Vec3A};
use vtex_shaders::LightKinds;

use super::bvh;
use super::world::index_u32;
use crate::scene::{Instance, PunctualKind, PunctualLight, RectLight, Scene};
use panorama::Panorama;
pub(super) use texture::PanoramaTexture;

/// Kinds of a light's record; see `shaders/wgsl/trace/light/sample.wgsl`.
const ENVIRONMENT: u32 = 0;
const PANEL: u32 = 1;
const TRIANGLE: u32 = 2;
const DIRECTIONAL: u32 = 3;
const SPOT: u32 = 4;

/// A light is this many groups of four words.
pub(super) const LIGHT_GROUPS: usize = 4;
/// Most triangles that paths aim at: 16 MiB of records. Beyond, materials with the most triangles are
/// found by scattering alone.
const MOST_TRIANGLES: usize = 1 << 18;

/// The lights of a scene.
#[derive(Debug, Default)]
pub(super) struct Lights {
    pub(super) kinds: LightKinds,
    /// Groups of four words: records of the lights, then cells of the panorama.
    pub(super) groups: Vec<[u32; 4]>,
    pub(super) count: u32,
    /// Of each material, then of each area light: density per area with which its points are chosen.
    pub(super) densities: Vec<f32>,
    pub(super) panorama: Option<Shown>,
    /// What was left out.
    pub(super) notices: Vec<String>,
}

/// The panorama as the frame describes it.
#[derive(Debug)]
pub(super) struct Shown {
    pub(super) size: [u32; 2],
    pub(super) texels: Vec<u32>,
    pub(super) scale: f32,
    pub(super) grid: [u32; 2],
    pub(super) turn_rad: f32,
    /// The chance that paths aim at it.
    pub(super) chance: f32,
}

/// A light before it is known how likely it is.
#[derive(Clone, Copy, Debug)]
struct Light {
    kind: u32,
    place: Vec3,
    first: Vec3,
    second: Vec3,
    radiance: [f32; 3],
    /// By which lights of its class are chosen.
    weight: f64,
}

impl Lights {
    pub(super) fn new(scene: &Scene) -> Self {
        let mut made = Self::default();
        let mut near = Vec::new();
        let mut far = Vec::new();
        let glowing = made.glowing(scene);
        for instance in &scene.instances {
            if glowing[instance.material] {
                near.extend(triangles(scene, instance));
            }
        }
        near.extend(scene.lights.iter().map(panel));
        for light in &scene.punctual {
            match light.kind {
                PunctualKind::Directional => far.push(directional(light)),
                _ => near.push(spot(light)),
            }
        }
        let panorama = scene.environment.as_ref().map(Panorama::new);
        far.extend(panorama.as_ref().map(|panorama| Light {
            kind: ENVIRONMENT,
            place: Vec3::ZERO,
            first: Vec3::ZERO,
            second: Vec3::ZERO,
            radiance: [0.0; 3],
            weight: PI * panorama.mean,
        }));
        near.retain(|light| light.weight > 0.0);
        far.retain(|light| light.weight > 0.0);
        // Power of what is near and irradiance of what is far cannot be compared without knowing where
        // surfaces are, so each class gets its share.
        let share = if near.is_empty() || far.is_empty() {
            1.0
        } else {
            0.5
        };
        let sum = |lights: &[Light]| lights.iter().map(|light| light.weight).sum::<f64>();
        let scales = [&near, &far].map(|lights| share / sum(lights));
        made.densities = densities(scene, &glowing, scales[0]);
        let chance = |light: &Light, scale: f64| (*light, light.weight * scale);
        let all: Vec<(Light, f64)> = (near.iter().map(|light| chance(light, scales[0])))
            .chain(far.iter().map(|light| chance(light, scales[1])))
            .collect();
        made.add(&all);
        if let Some(panorama) = panorama {
            made.kinds.environment = true;
            made.groups.extend(&panorama.cells);
            let shown = all.iter().find(|(light, _)| light.kind == ENVIRONMENT);
            made.panorama = Some(Shown {
                size: panorama.size,
                texels: panorama.texels,
                scale: panorama.scale,
                grid: panorama.grid,
                turn_rad: scene.environment.as_ref().map_or(0.0, |e| e.turn_rad),
                chance: shown.map_or(0.0, |(_, chance)| single(*chance)),
            });
        }
        made
    }

    /// Of each material, whether paths aim at what it is on.
    fn glowing(&mut self, scene: &Scene) -> Vec<bool> {
        let mut counts = vec![0_usize; scene.materials.len()];
        for instance in &scene.instances {
            let count = scene.meshes[instance.mesh].triangles.len();
            counts[instance.material] = counts[instance.material].saturating_add(count);
        }
        let mut by_count: Vec<usize> = (0..counts.len())
            .filter(|&index| {
                let material = &scene.materials[index];
                // Of a see-through light some rays find nothing: it would have to be looked up.
                luminance(material.emission) > 0.0 && !material.is_veil() && counts[index] > 0
            })
            .collect();
        by_count.sort_by_key(|&index| counts[index]);
        let mut glowing = vec![false; scene.materials.len()];
        let mut left = MOST_TRIANGLES;
        for index in by_count {
            match left.checked_sub(counts[index]) {
                Some(rest) => (left, glowing[index]) = (rest, true),
                None => self.notices.push(format!(
                    "material {index} glows on {} triangles, too many to aim at: it is found by \
                     scattering alone",
                    counts[index]
                )),
            }
        }
        glowing
    }

    fn add(&mut self, lights: &[(Light, f64)]) {
        let weights: Vec<f64> = lights.iter().map(|(_, chance)| *chance).collect();
        for ((light, chance), choice) in lights.iter().zip(alias::table(&weights)) {
            match light.kind {
                PANEL | TRIANGLE => self.kinds.areas = true,
                DIRECTIONAL | SPOT => self.kinds.punctual = true,
                _ => (),
            }
            let vector = |v: Vec3, last: u32| {
                let [x, y, z] = v.to_array().map(f32::to_bits);
                [x, y, z, last]
            };
            // Of an area the density of its points, the chance of a triangle being that of both halves
            // of its parallelogram.
            self.groups.extend([
                vector(light.place, light.kind),
                vector(light.first, (single(*chance)).to_bits()),
                vector(light.second, choice.threshold.to_bits()),
                vector(light.radiance.into(), choice.alias),
            ]);
        }
        self.count = index_u32(lights.len());
    }
}

/// Density per area of what is chosen by luminance and area, which is the same over a material.
fn densities(scene: &Scene, glowing: &[bool], scale: f64) -> Vec<f32> {
    let materials = scene.materials.iter().zip(glowing);
    let meshes = materials.map(|(material, &glows)| match glows {
        true => single(2.0 * PI * luminance(material.emission) * scale),
        false => 0.0,
    });
    let panels = (scene.lights.iter())
        .map(|light| luminance(light.radiance))
        .map(|luminance| match luminance > 0.0 {
            true => single(PI * luminance * scale),
            false => 0.0,
        });
    meshes.chain(panels).collect()
}

fn triangles<'a>(scene: &'a Scene, instance: &Instance) -> impl Iterator<Item = Light> + 'a {
    let mesh = &scene.meshes[instance.mesh];
    let to_world = Affine3A::from_cols_array_2d(&instance.world_from_object);
    let radiance = scene.materials[instance.material].emission;
    mesh.triangles.iter().filter_map(move |corners| {
        let corner = |i: u32| to_world.transform_point3a(mesh.positions[i as usize].into());
        let [a, b, c] = corners.map(corner);
        // Those that no ray can meet would be aimed at in vain.
        if !bvh::is_traceable(&bvh::triangle([a, b, c])) {
            return None;
        }
        let (first, second): (Vec3A, Vec3A) = (b - a, c - a);
        let area = 0.5 * f64::from(first.cross(second).length());
        Some(Light {
            kind: TRIANGLE,
            place: a.into(),
            first: first.into(),
            second: second.into(),
            radiance,
            // It shines to both sides.
            weight: 2.0 * PI * area * luminance(radiance),
        })
    })
}

fn panel(light: &RectLight) -> Light {
    let [place, first, second] = [light.corner, light.edge_u, light.edge_v].map(Vec3::from);
    Light {
        kind: PANEL,
        place,
        first,
        second,
        radiance: light.radiance,
        weight: PI * f64::from(first.cross(second).length()) * luminance(light.radiance),
    }
}

fn directional(light: &PunctualLight) -> Light {
    Light {
        kind: DIRECTIONAL,
        place: -Vec3::from(light.direction).normalize_or(Vec3::NEG_Y),
        first: Vec3::ZERO,
        second: Vec3::ZERO,
        radiance: light.intensity,
        weight: luminance(light.intensity),
    }
}

/// A point, or a spot whose falloff is that of `KHR_lights_punctual`.
fn spot(light: &PunctualLight) -> Light {
    let (scale, offset, angle) = match light.kind {
        PunctualKind::Spot {
            inner_rad,
            outer_rad,
        } => {
            let [inner, outer] = [inner_rad, outer_rad].map(f32::cos);
            let scale = 1.0 / (inner - outer).max(0.001);
            let mean = 0.5 * f64::from(inner + outer);
            (scale, -outer * scale, 2.0 * PI * (1.0 - mean))
        }
        _ => (0.0, 1.0, 4.0 * PI),
    };
    let window = light.range.map_or(0.0, |range| range.powi(-4));
    Light {
        kind: SPOT,
        place: light.position.into(),
        first: Vec3::from(light.direction).normalize_or_zero(),
        second: Vec3::new(scale, offset, window.min(f32::MAX)),
        radiance: light.intensity,
        weight: angle * luminance(light.intensity),
    }
}

/// Rec. 709.
fn luminance([r, g, b]: [f32; 3]) -> f64 {
    0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
}

#[expect(clippy::cast_possible_truncation, reason = "the device has no f64")]
fn single(value: f64) -> f32 {
    value as f32
}
