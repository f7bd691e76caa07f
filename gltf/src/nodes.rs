//! The hierarchy of nodes: what stands where.

use std::collections::BTreeMap;

use glam::{Affine3A, Mat3A, Mat4, Quat, Vec3, Vec3A};
use vtex_runtime::{Camera, PunctualKind as TraceKind, PunctualLight as TraceLight};

use crate::buffers::accessor::Reader;
use crate::document::{Document, Node};
use crate::error::{Outcome, find, malformed};

/// A camera of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedCamera {
    /// The name of the camera, or of its node; may be empty.
    pub name: String,
    /// Where it stands.
    pub camera: Camera,
}

/// A light of `KHR_lights_punctual`.
#[derive(Clone, Debug, PartialEq)]
pub struct PunctualLight {
    /// Its name; may be empty.
    pub name: String,
    /// What it is.
    pub kind: PunctualKind,
    /// Linear colour.
    pub color: [f32; 3],
    /// Candela; lux for a directional one.
    pub intensity: f32,
    /// Beyond which it does not shine; `None` is without end.
    pub range: Option<f32>,
    /// World space.
    pub position: [f32; 3],
    /// Where it shines to, unit length.
    pub direction: [f32; 3],
}

/// Kinds of [`PunctualLight`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PunctualKind {
    /// From infinitely far.
    Directional,
    /// To all sides.
    Point,
    /// Into a cone.
    Spot {
        /// Half angle within which it is as bright as in the middle, radians.
        inner: f32,
        /// Half angle beyond which it is dark, radians.
        outer: f32,
    },
}

impl PunctualLight {
    /// As the tracer has it. Angles and colours out of range are mended; a light without a place or an
    /// intensity that is a number is left out, with a warning.
    pub(crate) fn traced(&self, warnings: &mut Vec<String>) -> Option<TraceLight> {
        let half_turn = std::f32::consts::FRAC_PI_2;
        let kind = match self.kind {
            PunctualKind::Directional => TraceKind::Directional,
            PunctualKind::Point => TraceKind::Point,
            PunctualKind::Spot { inner, outer } => {
                // `max` and `min` drop what is no number.
                let outer_rad = outer.max(0.0).min(half_turn);
                TraceKind::Spot {
                    inner_rad: inner.max(0.0).min(outer_rad),
                    outer_rad,
                }
            }
        };
        let intensity = self.color.map(|c| (c * self.intensity).max(0.0));
        let is_finite = self
            .position
            .iter()
            .chain(&intensity)
            .all(|n| n.is_finite());
        if !is_finite {
            let name = &self.name;
            warnings.push(format!(
                "KHR_lights_punctual: a light {name:?} whose numbers are not finite was left out"
            ));
            return None;
        }
        Some(TraceLight {
            kind,
            position: self.position,
            direction: self.direction,
            intensity,
            range: self.range.filter(|&range| range > 0.0),
        })
    }
}

/// What the nodes of a scene place.
#[derive(Debug, Default)]
pub(crate) struct Placed {
    /// Mesh of the asset, and its transform.
    pub(crate) meshes: Vec<(usize, Affine3A)>,
    pub(crate) cameras: Vec<NamedCamera>,
    pub(crate) lights: Vec<PunctualLight>,
}

/// Walks the nodes of `scene`.
pub(crate) fn walk(
    reader: &mut Reader<'_>,
    scene: usize,
    warnings: &mut Vec<String>,
) -> Outcome<Placed> {
    let document = reader.document;
    let scene_place = format!("scenes[{scene}].nodes");
    let roots = &find(&document.scenes, scene, "scenes", "scene")?.nodes;
    let mut placed = Placed::default();
    let mut parent: BTreeMap<usize, String> = BTreeMap::new();
    let mut open = Vec::new();
    for &root in roots.iter().rev() {
        open.push((root, Affine3A::IDENTITY, scene_place.clone()));
    }
    // A list instead of recursion: a file may nest as deeply as it likes.
    while let Some((index, world_from_parent, from)) = open.pop() {
        let node = find(&document.nodes, index, "nodes", &from)?;
        let place = format!("nodes[{index}]");
        if let Some(other) = parent.insert(index, from.clone()) {
            let what = format!(
                "it is below {other} and below {from}: nodes must form a tree, without cycles"
            );
            return malformed(&place, what);
        }
        let transform = world_from_parent * transform(node);
        if !transform.is_finite() {
            warnings.push(format!(
                "{place}: its transform is not finite; it was left out"
            ));
            continue;
        }
        place_node(reader, node, transform, &place, &mut placed, warnings)?;
        for &child in node.children.iter().rev() {
            open.push((child, transform, format!("{place}.children")));
        }
    }
    Ok(placed)
}

fn transform(node: &Node) -> Affine3A {
    if let Some(matrix) = node.matrix {
        let matrix = Mat4::from_cols_array(&matrix);
        return Affine3A {
            matrix3: Mat3A::from_mat4(matrix),
            translation: matrix.w_axis.truncate().into(),
        };
    }
    placement(
        node.translation.unwrap_or_default(),
        node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]),
        node.scale.unwrap_or([1.0; 3]),
    )
}

fn placement(translation: [f32; 3], rotation: [f32; 4], scale: [f32; 3]) -> Affine3A {
    let rotation = Quat::from_array(rotation);
    // A quaternion without length turns nothing.
    let unit = match rotation.length_squared() > 0.0 {
        true => rotation.normalize(),
        false => Quat::IDENTITY,
    };
    Affine3A::from_scale_rotation_translation(scale.into(), unit, translation.into())
}

fn place_node(
    reader: &mut Reader<'_>,
    node: &Node,
    transform: Affine3A,
    place: &str,
    placed: &mut Placed,
    warnings: &mut Vec<String>,
) -> Outcome<()> {
    let document = reader.document;
    if let Some(mesh) = node.mesh {
        find(&document.meshes, mesh, "meshes", place)?;
        let copies = match &node.extensions.instancing {
            Some(instancing) => copies(reader, &instancing.attributes, place)?,
            None => vec![Affine3A::IDENTITY],
        };
        let before = copies.len();
        let copies = copies.into_iter().map(|copy| transform * copy);
        let first = placed.meshes.len();
        placed.meshes.extend(
            copies
                .filter(|copy| copy.is_finite())
                .map(|copy| (mesh, copy)),
        );
        let left_out = before - (placed.meshes.len() - first);
        if left_out > 0 {
            warnings.push(format!(
                "{place}: {left_out} instances are not finite and were left out"
            ));
        }
    }
    if let Some(camera) = node.camera {
        placed.cameras.extend(seen_from(
            document, camera, node, &transform, place, warnings,
        )?);
    }
    if let Some(light) = &node.extensions.light {
        placed
            .lights
            .push(shining(document, light.light, &transform, place)?);
    }
    Ok(())
}

/// Transforms of `EXT_mesh_gpu_instancing`.
fn copies(
    reader: &mut Reader<'_>,
    attributes: &BTreeMap<String, usize>,
    place: &str,
) -> Outcome<Vec<Affine3A>> {
    let place = format!("{place}.EXT_mesh_gpu_instancing");
    let of = |name: &str| attributes.get(name).copied();
    let (translations, rotations, scales) = (of("TRANSLATION"), of("ROTATION"), of("SCALE"));
    let translations = translations.map(|at| reader.floats::<3>(at, &["VEC3"], 0.0, &place));
    let rotations = rotations.map(|at| reader.floats::<4>(at, &["VEC4"], 0.0, &place));
    let scales = scales.map(|at| reader.floats::<3>(at, &["VEC3"], 0.0, &place));
    let (translations, rotations, scales) = (
        translations.transpose()?,
        rotations.transpose()?,
        scales.transpose()?,
    );
    let counts: Vec<usize> = [
        translations.as_ref().map(Vec::len),
        rotations.as_ref().map(Vec::len),
        scales.as_ref().map(Vec::len),
    ]
    .into_iter()
    .flatten()
    .collect();
    let count = counts.first().copied().unwrap_or(0);
    if counts.iter().any(|&other| other != count) {
        return malformed(
            &place,
            format!("attributes of different lengths: {counts:?}"),
        );
    }
    let at = |i: usize| {
        placement(
            translations.as_ref().map_or([0.0; 3], |list| list[i]),
            rotations
                .as_ref()
                .map_or([0.0, 0.0, 0.0, 1.0], |list| list[i]),
            scales.as_ref().map_or([1.0; 3], |list| list[i]),
        )
    };
    Ok((0..count).map(at).collect())
}

fn seen_from(
    document: &Document,
    index: usize,
    node: &Node,
    transform: &Affine3A,
    place: &str,
    warnings: &mut Vec<String>,
) -> Outcome<Option<NamedCamera>> {
    let camera = find(&document.cameras, index, "cameras", place)?;
    let name = match camera.name.is_empty() {
        true => node.name.clone(),
        false => camera.name.clone(),
    };
    let position = Vec3::from(transform.translation);
    let axis = |v: Vec3A| Vec3::from(transform.matrix3 * v).try_normalize();
    let (Some(forward), Some(up)) = (axis(Vec3A::NEG_Z), axis(Vec3A::Y)) else {
        warnings.push(format!("{place}: a camera without direction was left out"));
        return Ok(None);
    };
    let (fov_y_rad, back) = match (&camera.perspective, &camera.orthographic) {
        (Some(perspective), _) => (perspective.yfov, 0.0),
        (None, Some(orthographic)) => {
            warnings.push(format!(
                "{place}: the orthographic camera is shown as one with a narrow angle, from afar"
            ));
            let fov: f32 = 0.05;
            (fov, orthographic.ymag / (0.5 * fov).tan())
        }
        (None, None) => return malformed(&format!("cameras[{index}]"), "it has no projection"),
    };
    if !(fov_y_rad > 0.0 && fov_y_rad < std::f32::consts::PI && back.is_finite()) {
        return malformed(
            &format!("cameras[{index}]"),
            "its angle or size is out of range",
        );
    }
    let position = position - forward * back;
    Ok(Some(NamedCamera {
        name,
        camera: Camera {
            position: position.to_array(),
            // A step that does not vanish beside large coordinates.
            target: (position + forward * (1.0 + position.abs().max_element())).to_array(),
            up: up.to_array(),
            fov_y_rad,
        },
    }))
}

fn shining(
    document: &Document,
    index: usize,
    transform: &Affine3A,
    place: &str,
) -> Outcome<PunctualLight> {
    let lights = &document.extensions.lights.lights;
    let light = find(lights, index, "KHR_lights_punctual.lights", place)?;
    let kind = match light.kind.as_str() {
        "directional" => PunctualKind::Directional,
        "point" => PunctualKind::Point,
        "spot" => PunctualKind::Spot {
            inner: light.spot.inner_cone_angle,
            outer: light.spot.outer_cone_angle,
        },
        other => {
            let place = format!("KHR_lights_punctual.lights[{index}]");
            return malformed(&place, format!("type {other:?} is not one"));
        }
    };
    let direction = Vec3::from(transform.matrix3 * Vec3A::NEG_Z);
    Ok(PunctualLight {
        name: light.name.clone(),
        kind,
        color: light.color,
        intensity: light.intensity,
        range: light.range,
        position: transform.translation.to_array(),
        direction: direction.try_normalize().unwrap_or(Vec3::NEG_Z).to_array(),
    })
}
