//! The triangles of meshes, in world space or in their own.

use glam::{Affine3A, Vec3A, Vec4};
use obvhs::aabb::Aabb;
use obvhs::cwbvh::CwBvh;
use obvhs::triangle::Triangle;

use super::index_u32;
use super::instance::mirrors;
use crate::scene::{Instance, Mesh};
use crate::tracer::bvh;
use crate::tracer::records::{AttributeRecord, TriangleRecord};

/// By how much of its size and of its coordinates the box of an instance is larger than that of its
/// mesh: as much as a ray may be off after it changed spaces.
const BOX_SLACK: f32 = 1.0e-5;

/// The colours of a triangle without any.
pub(super) const WHITE: [u32; 4] = [0x3fff_ffff; 4];

/// Ten bits a channel, of the root.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "roots of numbers from 0 to 1"
)]
fn color(color: [f32; 3]) -> u32 {
    let [r, g, b] = color.map(|c| (c.sqrt() * 1023.0).round() as u32);
    r | g << 10 | b << 20
}

/// A triangle as it is stored.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub(super) triangle: TriangleRecord,
    pub(super) attributes: AttributeRecord,
    pub(super) colors: [u32; 4],
    pub(super) source: u32,
}

impl Default for Placed {
    fn default() -> Self {
        Self {
            triangle: bytemuck::Zeroable::zeroed(),
            attributes: bytemuck::Zeroable::zeroed(),
            colors: WHITE,
            source: 0,
        }
    }
}

/// A mesh with a hierarchy in its own space.
#[derive(Debug)]
pub(super) struct MeshTree {
    pub(super) bvh: CwBvh,
    triangles: Vec<Placed>,
    count: usize,
}

impl MeshTree {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let mut kept = Vec::with_capacity(mesh.triangles.len());
        let mut triangles = Vec::with_capacity(mesh.triangles.len());
        // The material is the instance's.
        let placed = placed(mesh, &Instance::IDENTITY, 0);
        for (source, (triangle, attributes, colors)) in placed.enumerate() {
            if bvh::is_traceable(&triangle) {
                kept.push(triangle);
                triangles.push(Placed {
                    // So is whether rays go through it.
                    triangle: triangle_record(&triangle, false),
                    attributes,
                    colors,
                    source: index_u32(source),
                });
            }
        }
        Self {
            bvh: bvh::build(&kept),
            triangles,
            count: mesh.triangles.len(),
        }
    }

    pub(super) fn depth(&self) -> usize {
        bvh::depth(&self.bvh)
    }

    /// Triangles that are left out.
    pub(super) fn dropped(&self) -> u32 {
        index_u32(self.count - self.triangles.len())
    }

    pub(super) fn placed_in_order(&self) -> impl Iterator<Item = Placed> + '_ {
        let order = self.bvh.primitive_indices.iter();
        order.map(|&index| self.triangles[index as usize])
    }

    /// The box of the mesh where `to_world` places it; none where there is nothing to meet.
    pub(super) fn bounds_in(&self, to_world: &Affine3A) -> Option<Aabb> {
        if self.triangles.is_empty() {
            return None;
        }
        let Aabb { min, max } = self.bvh.total_aabb;
        let mut placed = Aabb::empty();
        for corner in 0..8 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { min } else { max }[axis];
            let corner = Vec3A::new(pick(0), pick(1), pick(2));
            placed.extend(to_world.transform_point3a(corner));
        }
        let slack = BOX_SLACK
            * (placed.max - placed.min)
                .max(placed.max.abs())
                .max(placed.min.abs());
        placed.min -= slack;
        placed.max += slack;
        bvh::is_within(placed.min).then_some(())?;
        bvh::is_within(placed.max).then_some(placed)
    }
}

/// The triangles of a mesh where `world_from_object` places them, counter-clockwise from the front as
/// in the mesh, also where it mirrors.
pub(super) fn placed(
    mesh: &Mesh,
    world_from_object: &[[f32; 3]; 4],
    material: u32,
) -> impl Iterator<Item = (Triangle, AttributeRecord, [u32; 4])> {
    let to_world = Affine3A::from_cols_array_2d(world_from_object);
    // Inverse transpose: normals stay at right angles to surfaces that are stretched. A matrix
    // without an inverse gives no numbers, and those become normals of length 0.
    let normal_to_world = to_world.matrix3.inverse().transpose();
    let mirrors = mirrors(&to_world);
    mesh.triangles.iter().map(move |&[a, b, c]| {
        let indices = if mirrors { [a, c, b] } else { [a, b, c] };
        let corners = indices.map(|i| i as usize);
        let triangle =
            bvh::triangle(corners.map(|i| to_world.transform_point3a(mesh.positions[i].into())));
        let normals = corners.map(|i| {
            let normal = normal_to_world * Vec3A::from(mesh.normals[i]);
            normal.normalize_or_zero()
        });
        let uvs = corners.map(|i| mesh.uvs[i]);
        let normal_u = [0, 1, 2].map(|k| normals[k].extend(uvs[k][0]));
        let attributes = attribute_record(normal_u, uvs.map(|[_, v]| v), material);
        let colors = match mesh.colors.is_empty() {
            true => WHITE,
            false => {
                let [a, b, c] = corners.map(|i| color(mesh.colors[i]));
                [a, b, c, 0]
            }
        };
        (triangle, attributes, colors)
    })
}

pub(super) fn attribute_record(
    normal_u: [Vec4; 3],
    [v0, v1, v2]: [f32; 3],
    material: u32,
) -> AttributeRecord {
    let [normal0_u, normal1_u, normal2_u] = normal_u.map(|n| n.to_array());
    AttributeRecord {
        normal0_u,
        normal1_u,
        normal2_u,
        // The index as bits. The shader only reinterprets them: small ones are denormal numbers, which
        // arithmetic may flush to zero.
        v_material: [v0, v1, v2, f32::from_bits(material)],
    }
}

/// `is_veil`: whether the surface may let rays through.
pub(super) fn triangle_record(triangle: &Triangle, is_veil: bool) -> TriangleRecord {
    let veil = if is_veil { 1.0 } else { 0.0 };
    TriangleRecord {
        v0: triangle.v0.extend(0.0).to_array(),
        // Signs and operations as in obvhs, whose CPU traversal must give the same bits.
        edge1: (triangle.v0 - triangle.v1).extend(veil).to_array(),
        edge2: (triangle.v2 - triangle.v0).extend(0.0).to_array(),
    }
}
