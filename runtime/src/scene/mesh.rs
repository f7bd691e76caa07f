//! Triangle meshes with texture coordinates, and generators of simple ones.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use crate::RuntimeError;

/// Most triangles a scene may store. A mesh that several instances show is stored once, with one more
/// for each instance, unless its copies are few and small. Bounds the time that building a BVH takes,
/// about a second for a million, and keeps the largest array, 64 bytes a triangle for shading, below
/// a binding of 128 MiB; past it [`RuntimeError::Limit`].
pub const MAX_TRIANGLES: usize = 2_000_000;

/// An indexed triangle mesh in object space (right-handed, y up), counter-clockwise seen from
/// its front.
///
/// uv follows glTF: origin top left, v down.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions.
    pub positions: Vec<[f32; 3]>,
    /// Shading normals, one a vertex, unit length.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, one a vertex.
    pub uvs: Vec<[f32; 2]>,
    /// Colours that multiply the material's, linear, in \[0, 1\], one a vertex; empty for white.
    pub colors: Vec<[f32; 3]>,
    /// Three vertex indices a triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A rectangle in the plane z = 0 around the origin, facing +z; uv (0, 0) is its corner at
    /// -x, +y.
    pub fn plane(width: f32, height: f32) -> Self {
        let mut mesh = Self::default();
        mesh.quad(
            Vec3::ZERO,
            Vec3::X * (0.5 * width),
            Vec3::Y * (0.5 * height),
        );
        mesh
    }

    /// A box around the origin of this size along x, y and z; each face shows the whole texture,
    /// upright on the four sides.
    pub fn cuboid(size: [f32; 3]) -> Self {
        let half = 0.5 * Vec3::from(size);
        let mut mesh = Self::default();
        // Each face: its right and up as seen from outside; right x up points outwards.
        for (right, up) in [
            (Vec3::X, Vec3::Y),
            (Vec3::NEG_Z, Vec3::Y),
            (Vec3::NEG_X, Vec3::Y),
            (Vec3::Z, Vec3::Y),
            (Vec3::X, Vec3::NEG_Z),
            (Vec3::X, Vec3::Z),
        ] {
            let out = right.cross(up);
            mesh.quad(out * half, right * half, up * half);
        }
        mesh
    }

    /// A sphere around the origin, poles on the y axis. `repeat_u` copies of the texture go round
    /// it, u growing eastwards; v runs from the north pole to the south pole.
    pub fn sphere(radius: f32, segments: u32, repeat_u: f32) -> Self {
        let columns = segments.max(3);
        let rows = (columns / 2).max(2);
        Self::lathe(columns, rows, repeat_u, |v| {
            let (sin, cos) = (PI * v).sin_cos();
            ([radius * sin, radius * cos], [sin, cos])
        })
    }

    /// The side of an upright cylinder around the origin, open at both ends; `repeat_u` copies of
    /// the texture go round it.
    pub fn cylinder(radius: f32, height: f32, segments: u32, repeat_u: f32) -> Self {
        Self::lathe(segments.max(3), 1, repeat_u, |v| {
            ([radius, height * (0.5 - v)], [1.0, 0.0])
        })
    }

    /// A flat disc in the plane y = 0 around the origin, facing +y; the texture's canvas is its
    /// bounding square, top towards -z.
    pub fn disc(radius: f32, segments: u32) -> Self {
        let count = segments.max(3);
        let mut mesh = Self::default();
        mesh.push(Vec3::ZERO, Vec3::Y, Vec2::splat(0.5));
        for i in 0..count {
            let (sin, cos) = (TAU * i as f32 / count as f32).sin_cos();
            let position = Vec3::new(radius * cos, 0.0, radius * sin);
            mesh.push(
                position,
                Vec3::Y,
                Vec2::new(0.5 + 0.5 * cos, 0.5 + 0.5 * sin),
            );
            // The angle turns from +x to +z, clockwise seen from above, hence the later one first.
            mesh.triangles.push([0, 1 + (i + 1) % count, 1 + i]);
        }
        mesh
    }

    /// Revolves a profile about the y axis. `profile(v)` gives radius and height, and the normal
    /// in the same plane, for v from 0 (top) to 1 (bottom).
    fn lathe(
        columns: u32,
        rows: u32,
        repeat_u: f32,
        profile: impl Fn(f32) -> ([f32; 2], [f32; 2]),
    ) -> Self {
        let mut mesh = Self::default();
        for row in 0..=rows {
            let v = row as f32 / rows as f32;
            let ([radius, height], [normal_out, normal_up]) = profile(v);
            // One column more than there are strips: the seam has u = 0 on one side and u = 1 on the
            // other, and a shared vertex would run the whole texture backwards in the last strip.
            for column in 0..=columns {
                let u = column as f32 / columns as f32;
                // u = 0.5 faces +z; seen from outside u grows to the right.
                let (sin, cos) = (TAU * (u - 0.5)).sin_cos();
                let around = |r: f32, y: f32| Vec3::new(r * sin, y, r * cos);
                let uv = Vec2::new(repeat_u * u, v);
                mesh.push(around(radius, height), around(normal_out, normal_up), uv);
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let top = row * (columns + 1) + column;
                let bottom = top + columns + 1;
                // At a pole one of the two has next to no area: a triangle wasted, no hit changed.
                mesh.triangles.push([top, bottom, top + 1]);
                mesh.triangles.push([top + 1, bottom, bottom + 1]);
            }
        }
        mesh
    }

    /// Adds a rectangle by its centre and half extents to the right and up.
    fn quad(&mut self, center: Vec3, right: Vec3, up: Vec3) {
        let normal = right.cross(up).normalize_or_zero();
        let first = self.vertex_count();
        for (x, y) in [(-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)] {
            let uv = Vec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y);
            self.push(center + right * x + up * y, normal, uv);
        }
        self.triangles.push([first, first + 1, first + 2]);
        self.triangles.push([first, first + 2, first + 3]);
    }

    fn push(&mut self, position: Vec3, normal: Vec3, uv: Vec2) {
        self.positions.push(position.to_array());
        self.normals.push(normal.to_array());
        self.uvs.push(uv.to_array());
    }

    fn vertex_count(&self) -> u32 {
        u32::try_from(self.positions.len()).unwrap_or(u32::MAX)
    }

    /// Checks that the lists agree and every number is finite.
    pub(crate) fn check(&self) -> Result<(), RuntimeError> {
        let count = self.positions.len();
        let has_colors = self.colors.is_empty() || self.colors.len() == count;
        let agree = self.normals.len() == count && self.uvs.len() == count && has_colors;
        let known = |index: &u32| (*index as usize) < count;
        let vectors = self.positions.iter().chain(&self.normals).flatten();
        let finite = vectors
            .chain(self.uvs.iter().flatten())
            .all(|number| number.is_finite());
        let colors = self.colors.iter().flatten().all(|&c| super::unit(c));
        if agree && finite && colors && self.triangles.iter().flatten().all(known) {
            Ok(())
        } else {
            Err(RuntimeError::Parameter(
                "mesh: lists of different length, an index past the end, a number that is not \
                 finite or a colour out of range"
                    .to_owned(),
            ))
        }
    }
}
