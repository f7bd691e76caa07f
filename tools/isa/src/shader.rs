//! From WGSL to what a pipeline needs: SPIR-V, entry points, bindings.

use std::collections::BTreeMap;

use naga::{AddressSpace, ImageClass, ShaderStage, TypeInner};

use crate::Error;

/// A shader with one kernel, or with one vertex and one fragment stage.
#[derive(Debug)]
pub(crate) struct Shader {
    /// Made here from validated WGSL, so drivers may trust it.
    pub(crate) spirv: Vec<u32>,
    pub(crate) stages: Stages,
    /// Bindings of each group; a group that the shader leaves out is empty.
    pub(crate) groups: Vec<Vec<Binding>>,
}

/// Names of entry points.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Stages {
    Compute(String),
    Graphics { vertex: String, fragment: String },
}

/// One resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Binding {
    pub(crate) binding: u32,
    pub(crate) kind: Kind,
}

/// What is bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Uniform,
    Storage,
    Texture,
    Sampler,
}

impl Shader {
    pub(crate) fn new(wgsl: &str) -> Result<Self, Error> {
        let spirv = vtex_shaders::spirv(wgsl).map_err(|error| Error::Shader(error.to_string()))?;
        let module = naga::front::wgsl::parse_str(wgsl)
            .map_err(|error| Error::Shader(error.emit_to_string(wgsl)))?;
        Ok(Self {
            spirv,
            stages: stages(&module)?,
            groups: groups(&module)?,
        })
    }
}

fn stages(module: &naga::Module) -> Result<Stages, Error> {
    let points: Vec<(ShaderStage, &str)> = module
        .entry_points
        .iter()
        .map(|point| (point.stage, point.name.as_str()))
        .collect();
    match *points.as_slice() {
        [(ShaderStage::Compute, name)] => Ok(Stages::Compute(name.to_owned())),
        [
            (ShaderStage::Vertex, vertex),
            (ShaderStage::Fragment, fragment),
        ]
        | [
            (ShaderStage::Fragment, fragment),
            (ShaderStage::Vertex, vertex),
        ] => Ok(Stages::Graphics {
            vertex: vertex.to_owned(),
            fragment: fragment.to_owned(),
        }),
        _ => Err(Error::Shader(format!(
            "a shader has one kernel, or a vertex and a fragment stage, not {points:?}"
        ))),
    }
}

fn groups(module: &naga::Module) -> Result<Vec<Vec<Binding>>, Error> {
    let mut groups: BTreeMap<u32, Vec<Binding>> = BTreeMap::new();
    for (_, variable) in module.global_variables.iter() {
        let Some(place) = &variable.binding else {
            continue;
        };
        let kind = match (variable.space, &module.types[variable.ty].inner) {
            (AddressSpace::Uniform, _) => Kind::Uniform,
            (AddressSpace::Storage { .. }, _) => Kind::Storage,
            (
                AddressSpace::Handle,
                TypeInner::Image {
                    class: ImageClass::Sampled { .. },
                    ..
                },
            ) => Kind::Texture,
            (AddressSpace::Handle, TypeInner::Sampler { .. }) => Kind::Sampler,
            _ => {
                let name = variable.name.as_deref().unwrap_or("a variable");
                let problem = "is no buffer, sampled texture or sampler";
                return Err(Error::Shader(format!("{name} {problem}")));
            }
        };
        groups.entry(place.group).or_default().push(Binding {
            binding: place.binding,
            kind,
        });
    }
    let count = groups.keys().next_back().map_or(0, |last| last + 1);
    Ok((0..count)
        .map(|group| groups.remove(&group).unwrap_or_default())
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_and_their_bindings_are_found() {
        let shader = Shader::new(
            "@group(0) @binding(1) var<uniform> a: vec4f;
             @group(2) @binding(0) var<storage, read_write> b: array<vec4f>;
             @group(2) @binding(1) var t: texture_2d_array<f32>;
             @group(2) @binding(2) var s: sampler;
             @compute @workgroup_size(64) fn main() {
                 b[0] = a + textureSampleLevel(t, s, a.xy, 0, 0.0);
             }",
        )
        .unwrap();
        assert_eq!(shader.stages, Stages::Compute("main".to_owned()));
        let binding = |binding, kind| Binding { binding, kind };
        let groups = [
            vec![binding(1, Kind::Uniform)],
            vec![],
            vec![
                binding(0, Kind::Storage),
                binding(1, Kind::Texture),
                binding(2, Kind::Sampler),
            ],
        ];
        assert_eq!(shader.groups, groups);
    }

    #[test]
    fn other_shaders_are_refused() {
        let none = "fn f() {}";
        let texture = "@group(0) @binding(0) var t: texture_storage_2d<rgba8unorm, write>;
             @compute @workgroup_size(64) fn main() { _ = textureDimensions(t); }";
        for (wgsl, problem) in [(none, "one kernel"), (texture, "no buffer")] {
            let error = Shader::new(wgsl).unwrap_err().to_string();
            assert!(error.contains(problem), "{error}");
        }
    }
}
