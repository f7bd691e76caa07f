//! Records of `shaders/wgsl/trace/layout.wgsl`; a test compares both through naga.

use bytemuck::{Pod, Zeroable};

use crate::scene::MAX_LIGHTS;

/// "No texture", "no light", "no triangle".
pub(crate) const NONE: u32 = u32::MAX;

/// What intersection reads of a triangle: `edge1 = v0 - v1`, `edge2 = v2 - v0`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct TriangleRecord {
    pub(crate) v0: [f32; 4],
    pub(crate) edge1: [f32; 4],
    pub(crate) edge2: [f32; 4],
}

/// What shading reads of a triangle: normals with u in w, then three v and the material's index.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct AttributeRecord {
    pub(crate) normal_u: [[f32; 4]; 3],
    pub(crate) v: [f32; 3],
    pub(crate) material: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct MaterialRecord {
    pub(crate) base_color: [f32; 4],
    pub(crate) emission: [f32; 4],
    pub(crate) backing: [f32; 4],
    pub(crate) metallic: f32,
    pub(crate) ggx_alpha: f32,
    pub(crate) surface: u32,
    pub(crate) texture_word: u32,
    pub(crate) light: u32,
    pub(crate) reserved: [u32; 3],
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct LightRecord {
    pub(crate) corner: [f32; 4],
    pub(crate) edge_u: [f32; 4],
    pub(crate) edge_v: [f32; 4],
    pub(crate) normal_area: [f32; 4],
    pub(crate) radiance: [f32; 4],
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct FrameRecord {
    pub(crate) camera_position: [f32; 4],
    pub(crate) camera_right: [f32; 4],
    pub(crate) camera_up: [f32; 4],
    pub(crate) camera_forward: [f32; 4],
    pub(crate) sky_zenith: [f32; 4],
    pub(crate) sky_horizon: [f32; 4],
    pub(crate) sky_ground: [f32; 4],
    pub(crate) film_size: [u32; 2],
    pub(crate) light_count: u32,
    pub(crate) triangle_count: u32,
    pub(crate) seed: u32,
    pub(crate) max_bounces: u32,
    pub(crate) light_sampling: u32,
    pub(crate) transparent_background: u32,
    pub(crate) camera_slope: f32,
    pub(crate) footprint_scale: f32,
    pub(crate) indirect_clamp: f32,
    pub(crate) reserved: f32,
    pub(crate) lights: [LightRecord; MAX_LIGHTS],
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct PassRecord {
    pub(crate) row_first: u32,
    pub(crate) row_count: u32,
    pub(crate) sample_first: u32,
    pub(crate) sample_count: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct RayRecord {
    pub(crate) origin: [f32; 3],
    pub(crate) t_max: f32,
    pub(crate) direction: [f32; 3],
    pub(crate) reserved: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct HitRecord {
    pub(crate) t: f32,
    pub(crate) triangle: u32,
    pub(crate) reserved: [u32; 2],
}

const _: () = {
    assert!(size_of::<TriangleRecord>() == 48, "three vec4f");
    assert!(size_of::<AttributeRecord>() == 64, "four vec4f");
    assert!(
        size_of::<MaterialRecord>() == 80,
        "three vec4f and eight words"
    );
    assert!(size_of::<LightRecord>() == 80, "five vec4f");
    assert!(
        size_of::<FrameRecord>() == 160 + 80 * MAX_LIGHTS,
        "seven vec4f, twelve words, lights"
    );
};
