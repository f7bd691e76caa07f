//! Records of `shaders/wgsl/trace/layout.wgsl`; a test compares both through naga.

use bytemuck::{Pod, Zeroable};

/// "No texture", "no triangle".
pub(crate) const NONE: u32 = u32::MAX;

/// [`MaterialRecord::surface`]: Lambert.
pub(crate) const SURFACE_DIFFUSE: u32 = 0;
/// [`MaterialRecord::surface`]: GGX over Lambert.
pub(crate) const SURFACE_GLOSSY: u32 = 1;
/// [`MaterialRecord::surface`]: its colour alone.
pub(crate) const SURFACE_UNLIT: u32 = 2;

/// What intersection reads of a triangle: `edge1 = v0 - v1`, `edge2 = v2 - v0`; or an instance, whose
/// place the bits of `v0[3]` say.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct TriangleRecord {
    pub(crate) v0: [f32; 4],
    pub(crate) edge1: [f32; 4],
    pub(crate) edge2: [f32; 4],
}

/// What shading reads of a triangle: normals with u in w, then three v and the bits of the
/// material's index.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct AttributeRecord {
    pub(crate) normal0_u: [f32; 4],
    pub(crate) normal1_u: [f32; 4],
    pub(crate) normal2_u: [f32; 4],
    pub(crate) v_material: [f32; 4],
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct MaterialRecord {
    pub(crate) base_color: [f32; 4],
    pub(crate) emission: [f32; 4],
    pub(crate) backing: [f32; 4],
    pub(crate) dielectric: [f32; 4],
    pub(crate) glass: [f32; 4],
    pub(crate) metallic: f32,
    pub(crate) ggx_alpha: f32,
    pub(crate) surface: u32,
    pub(crate) texture_word: u32,
    pub(crate) light_density: f32,
    pub(crate) texture_queue: u32,
    pub(crate) is_panel: u32,
    pub(crate) cutout: u32,
    pub(crate) transmission: f32,
    pub(crate) coat: f32,
    pub(crate) coat_alpha: f32,
    pub(crate) reserved: f32,
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
    pub(crate) environment_turn: [f32; 4],
    pub(crate) film_width: u32,
    pub(crate) film_height: u32,
    pub(crate) light_count: u32,
    pub(crate) triangle_count: u32,
    pub(crate) seed: u32,
    pub(crate) max_bounces: u32,
    pub(crate) light_sampling: u32,
    pub(crate) transparent_background: u32,
    pub(crate) camera_slope: f32,
    pub(crate) footprint_scale: f32,
    pub(crate) indirect_clamp: f32,
    pub(crate) reach: f32,
    pub(crate) light_first: u32,
    pub(crate) environment_first: u32,
    pub(crate) environment_columns: u32,
    pub(crate) environment_rows: u32,
    pub(crate) albedo_first: u32,
    pub(crate) colors_first: u32,
    pub(crate) reserved0: u32,
    pub(crate) reserved1: u32,
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
    pub(crate) origin_t_max: [f32; 4],
    pub(crate) direction: [f32; 4],
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct HitRecord {
    pub(crate) t: f32,
    pub(crate) triangle: u32,
    pub(crate) instance: u32,
    pub(crate) reserved: u32,
}

#[cfg(test)]
mod tests {
    use std::mem::offset_of;

    use naga::TypeInner;

    use super::*;
    use crate::LightSampling;

    /// Name, size and the fields' names and offsets of a record.
    type Layout = (&'static str, usize, Vec<(&'static str, usize)>);

    macro_rules! layouts {
        ($($record:ident { $($field:ident),* $(,)? })*) => {
            [$((
                stringify!($record),
                size_of::<$record>(),
                vec![$((stringify!($field), offset_of!($record, $field))),*],
            )),*]
        };
    }

    fn rust_layouts() -> [Layout; 7] {
        layouts! {
            TriangleRecord { v0, edge1, edge2 }
            AttributeRecord { normal0_u, normal1_u, normal2_u, v_material }
            MaterialRecord {
                base_color, emission, backing, dielectric, glass, metallic, ggx_alpha, surface, texture_word,
                light_density, texture_queue, is_panel, cutout, transmission, coat,
                coat_alpha, reserved,
            }
            FrameRecord {
                camera_position, camera_right, camera_up, camera_forward, sky_zenith, sky_horizon,
                sky_ground, environment_turn, film_width, film_height, light_count, triangle_count, seed,
                max_bounces, light_sampling, transparent_background, camera_slope,
                footprint_scale, indirect_clamp, reach, light_first, environment_first,
                environment_columns, environment_rows, albedo_first, colors_first,
                reserved0, reserved1,
            }
            PassRecord { row_first, row_count, sample_first, sample_count }
            RayRecord { origin_t_max, direction }
            HitRecord { t, triangle, instance, reserved }
        }
    }

    fn layout_wgsl() -> String {
        vtex_shaders::link("trace/layout", &vtex_shaders::LinkContext::default()).unwrap()
    }

    #[test]
    fn constants_are_those_of_the_shader() {
        let wgsl = layout_wgsl();
        for (name, value) in [
            ("LIGHT_SAMPLING_MIS", LightSampling::Mis as usize),
            (
                "LIGHT_SAMPLING_SCATTER",
                LightSampling::ScatterOnly as usize,
            ),
            ("SURFACE_DIFFUSE", SURFACE_DIFFUSE as usize),
            ("SURFACE_GLOSSY", SURFACE_GLOSSY as usize),
            ("SURFACE_UNLIT", SURFACE_UNLIT as usize),
        ] {
            let line = format!("const {name}: u32 = {value}u;");
            assert!(wgsl.contains(&line), "no `{line}`");
        }
        assert!(wgsl.contains(&format!("const TRACE_NONE: u32 = {NONE:#x}u;")));
    }

    #[test]
    fn records_lie_as_the_shader_reads_them() {
        let module = naga::front::wgsl::parse_str(&layout_wgsl()).unwrap();
        let mut structs = 0;
        for (_, ty) in module.types.iter() {
            let TypeInner::Struct { members, span } = &ty.inner else {
                continue;
            };
            structs += 1;
            let name = ty.name.as_deref().unwrap();
            let (_, size, fields) = rust_layouts()
                .into_iter()
                .find(|(record, ..)| *record == name)
                .unwrap_or_else(|| panic!("{name} has no Rust record"));
            let shader_fields: Vec<(&str, usize)> = members
                .iter()
                .map(|m| (m.name.as_deref().unwrap(), m.offset as usize))
                .collect();
            assert_eq!((fields, size), (shader_fields, *span as usize), "{name}");
        }
        assert_eq!(structs, rust_layouts().len());
    }
}
