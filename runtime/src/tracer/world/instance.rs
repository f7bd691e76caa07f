//! Which meshes are placed and which are instanced, and the records of instances.

use glam::{Affine3A, Mat3A};

use super::index_u32;
use crate::scene::{Instance, Scene};

/// A record is this many groups of four words: see `trace/world/instance.wgsl`.
pub(super) const RECORD_GROUPS: usize = 7;
/// A mesh of fewer triangles costs less than records of its instances.
const FEWEST_INSTANCED: usize = 4;
/// Sizes of a mesh in its own space between which intersections there neither overflow nor lose
/// their precision to denormal numbers.
const INSTANCED_SIZES: std::ops::RangeInclusive<f32> = 1.0e-6..=1.0e9;

/// How an instance is stored.
#[derive(Clone, Copy, Debug)]
pub(super) enum Placement {
    /// As triangles in world space.
    Placed,
    /// As a record, by its transform from the mesh's space to the world's.
    Instanced(Affine3A),
}

impl Placement {
    pub(super) fn is_instanced(&self) -> bool {
        matches!(self, Self::Instanced(_))
    }
}

/// The placement of each instance of `scene`.
pub(super) fn placements(scene: &Scene, most_placed: usize) -> Vec<Placement> {
    let mut uses = vec![0_usize; scene.meshes.len()];
    for instance in &scene.instances {
        uses[instance.mesh] += 1;
    }
    let repeats: Vec<bool> = (scene.meshes.iter().zip(uses))
        .map(|(mesh, uses)| {
            let count = mesh.triangles.len();
            uses > 1
                && count >= FEWEST_INSTANCED
                && count.saturating_mul(uses) > most_placed
                && INSTANCED_SIZES.contains(&size(&mesh.positions))
        })
        .collect();
    let place = |instance: &Instance| {
        let to_world = Affine3A::from_cols_array_2d(&instance.world_from_object);
        match repeats[instance.mesh] && is_invertible(&to_world) {
            true => Placement::Instanced(to_world),
            false => Placement::Placed,
        }
    };
    scene.instances.iter().map(place).collect()
}

/// The largest coordinate.
fn size(positions: &[[f32; 3]]) -> f32 {
    positions
        .as_flattened()
        .iter()
        .fold(0.0, |most, coordinate| coordinate.abs().max(most))
}

/// How much longer or shorter than in the mesh's space a vector may be in the world's.
const SCALES: std::ops::RangeInclusive<f32> = 1.0e-9..=1.0e9;

/// Whether rays come back from the mesh's space to where they were. A mesh that is flattened, or moved
/// between scales that f32 does not bridge, is placed instead.
fn is_invertible(to_world: &Affine3A) -> bool {
    let matrix = to_world.matrix3;
    let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    if !axes.iter().all(|axis| SCALES.contains(&axis.length())) {
        return false;
    }
    let from_world = to_world.inverse();
    let round = *to_world * from_world;
    let off = (round.matrix3 - Mat3A::IDENTITY).to_cols_array();
    from_world.is_finite() && off.iter().all(|difference| difference.abs() < 1.0e-3)
}

/// The record of an instance.
pub(super) fn record(instance: &Instance, root: u32, is_veil: bool) -> [[u32; 4]; RECORD_GROUPS] {
    let to_world = Affine3A::from_cols_array_2d(&instance.world_from_object);
    let [a, b, c] = rows(&to_world.inverse());
    let [d, e, f] = rows(&to_world);
    let mirrors = u32::from(mirrors(&to_world));
    [
        a,
        b,
        c,
        d,
        e,
        f,
        [
            root,
            index_u32(instance.material),
            mirrors,
            u32::from(is_veil),
        ],
    ]
}

/// Whether a transform turns counter-clockwise into clockwise.
pub(super) fn mirrors(to_world: &Affine3A) -> bool {
    to_world.matrix3.determinant() < 0.0
}

/// The rows of an affine transform, as bits.
fn rows(transform: &Affine3A) -> [[u32; 4]; 3] {
    let matrix = transform.matrix3;
    [0, 1, 2].map(|row| {
        let row = matrix.row(row).extend(transform.translation[row]);
        row.to_array().map(f32::to_bits)
    })
}
