//! Primitives as meshes.

use vtex_runtime::Mesh;

use crate::buffers::accessor::Reader;
use crate::document::Primitive;
use crate::error::{Outcome, malformed};

const TRIANGLES: u32 = 4;
const TRIANGLE_STRIP: u32 = 5;
const TRIANGLE_FAN: u32 = 6;

/// What a primitive has besides a [`Mesh`]; lists are empty where it has none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attributes {
    /// `TEXCOORD_0` and `TEXCOORD_1`.
    pub uvs: [Vec<[f32; 2]>; 2],
    /// `COLOR_0`, linear, with alpha.
    pub colors: Vec<[f32; 4]>,
    /// `TANGENT`: direction, and the side of the bitangent.
    pub tangents: Vec<[f32; 4]>,
}

/// A primitive as read; its mesh has no uv yet. `None` for what makes no triangles.
pub(crate) fn read(
    reader: &mut Reader<'_>,
    primitive: &Primitive,
    place: &str,
    warnings: &mut Vec<String>,
) -> Outcome<Option<(Mesh, Attributes)>> {
    let mode = primitive.mode.unwrap_or(TRIANGLES);
    if mode < TRIANGLES {
        warnings.push(format!(
            "{place}: points and lines are left out (mode {mode})"
        ));
        return Ok(None);
    }
    if mode > TRIANGLE_FAN {
        return malformed(place, format!("mode {mode} is not one"));
    }
    let Some(&positions) = primitive.attributes.get("POSITION") else {
        warnings.push(format!("{place}: it has no POSITION and was left out"));
        return Ok(None);
    };
    if !primitive.targets.is_empty() {
        warnings.push(format!("{place}: morph targets are left out"));
    }
    let positions: Vec<[f32; 3]> = reader.floats(positions, &["VEC3"], 0.0, place)?;
    let count = positions.len();
    let indices = match primitive.indices {
        Some(index) => reader.indices(index, place)?,
        None => (0..u32::try_from(count).unwrap_or(u32::MAX)).collect(),
    };
    if let Some(index) = indices.iter().find(|&&index| index as usize >= count) {
        return malformed(
            &format!("{place}.indices"),
            format!("index {index}, and there are {count} vertices"),
        );
    }
    let attribute = |name: &str| primitive.attributes.get(name).copied();
    let named = [
        attribute("NORMAL"),
        attribute("TEXCOORD_0"),
        attribute("TEXCOORD_1"),
        attribute("COLOR_0"),
        attribute("TANGENT"),
    ];
    let normals = optional(reader, named[0], &["VEC3"], 0.0, count, place)?;
    let attributes = Attributes {
        uvs: [
            optional(reader, named[1], &["VEC2"], 0.0, count, place)?,
            optional(reader, named[2], &["VEC2"], 0.0, count, place)?,
        ],
        colors: optional(reader, named[3], &["VEC3", "VEC4"], 1.0, count, place)?,
        tangents: optional(reader, named[4], &["VEC4"], 0.0, count, place)?,
    };
    let mesh = Mesh {
        triangles: triangles(&indices, mode),
        // Without length: the tracer shades flat, as glTF asks where there are no normals.
        normals: match normals.is_empty() {
            true => vec![[0.0; 3]; count],
            false => normals,
        },
        uvs: vec![[0.0; 2]; count],
        // The caller has them among the other attributes.
        colors: Vec::new(),
        positions,
    };
    Ok(Some((mended(mesh, place, warnings), attributes)))
}

/// An attribute that may be missing. What is no number becomes 0.
fn optional<const N: usize>(
    reader: &mut Reader<'_>,
    accessor: Option<usize>,
    kinds: &[&str],
    pad: f32,
    count: usize,
    place: &str,
) -> Outcome<Vec<[f32; N]>> {
    let Some(accessor) = accessor else {
        return Ok(Vec::new());
    };
    let mut values = reader.floats::<N>(accessor, kinds, pad, place)?;
    if values.len() != count {
        let what = format!(
            "accessors[{accessor}] has {} elements for {count}",
            values.len()
        );
        return malformed(place, what);
    }
    for value in values.as_flattened_mut() {
        if !value.is_finite() {
            *value = 0.0;
        }
    }
    Ok(values)
}

fn triangles(indices: &[u32], mode: u32) -> Vec<[u32; 3]> {
    match mode {
        TRIANGLE_STRIP => (0..indices.len().saturating_sub(2))
            .map(|i| match i % 2 {
                0 => [indices[i], indices[i + 1], indices[i + 2]],
                _ => [indices[i + 1], indices[i], indices[i + 2]],
            })
            .collect(),
        TRIANGLE_FAN => (1..indices.len().saturating_sub(1))
            .map(|i| [indices[0], indices[i], indices[i + 1]])
            .collect(),
        _ => indices.as_chunks().0.to_vec(),
    }
}

/// Without triangles at corners that are no numbers. Those without area the tracer drops and counts.
fn mended(mut mesh: Mesh, place: &str, warnings: &mut Vec<String>) -> Mesh {
    let is_sound = |position: &[f32; 3]| position.iter().all(|c| c.is_finite());
    if mesh.positions.iter().all(is_sound) {
        return mesh;
    }
    let before = mesh.triangles.len();
    let sound: Vec<bool> = mesh.positions.iter().map(is_sound).collect();
    mesh.triangles
        .retain(|corners| corners.iter().all(|&i| sound[i as usize]));
    for (position, is_sound) in mesh.positions.iter_mut().zip(sound) {
        if !is_sound {
            *position = [0.0; 3];
        }
    }
    let dropped = before - mesh.triangles.len();
    warnings.push(format!(
        "{place}: {dropped} triangles at infinite or undefined positions were left out"
    ));
    mesh
}
