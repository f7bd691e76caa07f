//! From WGSL to what a pipeline needs: SPIR-V, entry points, bindings.

use std::collections::BTreeMap;

use naga::{AddressSpace, ShaderStage};

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

/// One buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Binding {
    pub(crate) binding: u32,
    pub(crate) is_uniform: bool,
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
        let is_uniform = match variable.space {
            AddressSpace::Uniform => true,
            AddressSpace::Storage { .. } => false,
            _ => {
                let name = variable.name.as_deref().unwrap_or("a variable");
                return Err(Error::Shader(format!("{name} is not a buffer")));
            }
        };
        groups.entry(place.group).or_default().push(Binding {
            binding: place.binding,
            is_uniform,
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
             @compute @workgroup_size(64) fn main() { b[0] = a; }",
        )
        .unwrap();
        assert_eq!(shader.stages, Stages::Compute("main".to_owned()));
        let binding = |binding, is_uniform| Binding {
            binding,
            is_uniform,
        };
        let groups = [vec![binding(1, true)], vec![], vec![binding(0, false)]];
        assert_eq!(shader.groups, groups);
    }

    #[test]
    fn other_shaders_are_refused() {
        let none = "fn f() {}";
        let texture = "@group(0) @binding(0) var t: texture_2d<f32>;
             @compute @workgroup_size(64) fn main() { _ = textureDimensions(t); }";
        for (wgsl, problem) in [(none, "one kernel"), (texture, "not a buffer")] {
            let error = Shader::new(wgsl).unwrap_err().to_string();
            assert!(error.contains(problem), "{error}");
        }
    }
}
