//! The layout that shaders stored in files rely on, frozen under `SHADER_ABI`: the constants of
//! packed words, and as naga sees them in shaders with every feature the bindings, the records in
//! them and the functions that a host calls.
//!
//! The path tracer's own records (`wgsl/trace/layout.wgsl`) are not part of it: no file holds them.

use std::fmt::Write as _;
use std::path::Path;

use naga::{
    AddressSpace, Handle, ImageClass, ImageDimension, Module, ScalarKind, StorageAccess, Type,
    TypeInner,
};
use vtex_format::{Features, SHADER_ABI, SpecKey};
use vtex_shaders::layout::{CONSTANTS, OFFSET_END};
use vtex_shaders::{BindingSlot, batch_kernel, scene_evaluator};
use vtex_testing::Frozen;

#[test]
fn the_gpu_layout_changes_only_with_shader_abi() {
    let features = Features::ALL;
    let key = SpecKey { features };
    let batch = batch_kernel(&key);
    let scene = scene_evaluator(Features::ALL, BindingSlot::default());
    let text = [
        constants(),
        bindings("batch", &batch),
        bindings("scene", &scene),
        functions(&batch),
    ];
    Frozen {
        folder: &Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/layout"),
        constant: "SHADER_ABI (format/src/file/spec.rs)",
        version: &SHADER_ABI.to_string(),
        text: &text.concat(),
    }
    .check();
}

fn constants() -> String {
    let mut text = String::new();
    for (name, value) in CONSTANTS {
        line(&mut text, format_args!("const {name} u32 {value:#x}"));
    }
    let bits = OFFSET_END.to_bits();
    line(&mut text, format_args!("const OFFSET_END f32 {bits:#x}"));
    text
}

/// Bindings of a module, and the structs in them.
fn bindings(kind: &str, wgsl: &str) -> String {
    let module = naga::front::wgsl::parse_str(wgsl).expect("WGSL");
    let mut text = String::new();
    for (_, variable) in module.global_variables.iter() {
        let Some(at) = &variable.binding else {
            continue;
        };
        let name = variable.name.as_deref().unwrap_or("");
        let access = match variable.space {
            AddressSpace::Storage { access } if access.contains(StorageAccess::STORE) => {
                "read_write"
            }
            AddressSpace::Storage { .. } => "read",
            AddressSpace::Handle => "handle",
            other => panic!("{name} lies in {other:?}"),
        };
        let (group, binding) = (at.group, at.binding);
        let ty = type_name(&module, variable.ty);
        line(
            &mut text,
            format_args!("{kind} group {group} binding {binding} {name} {access} {ty}"),
        );
        record(&mut text, &module, variable.ty);
    }
    text
}

/// Fields of the struct that `ty` is, or is an array of.
fn record(text: &mut String, module: &Module, ty: Handle<Type>) {
    match &module.types[ty].inner {
        TypeInner::Array { base, .. } => record(text, module, *base),
        TypeInner::Struct { members, span } => {
            line(
                text,
                format_args!("struct {} {span} bytes", type_name(module, ty)),
            );
            for member in members {
                let name = member.name.as_deref().unwrap_or("");
                let (offset, ty) = (member.offset, type_name(module, member.ty));
                line(text, format_args!("  {offset} {name} {ty}"));
            }
        }
        _ => {}
    }
}

/// The functions that a host calls: their arguments are part of what a stored shader promises.
fn functions(wgsl: &str) -> String {
    let module = naga::front::wgsl::parse_str(wgsl).expect("WGSL");
    let mut text = String::new();
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().unwrap_or("");
        if !["vtex_sample", "vtex_sample_at"].contains(&name) {
            continue;
        }
        let arguments = function.arguments.iter();
        let types: Vec<String> = arguments
            .map(|argument| type_name(&module, argument.ty))
            .collect();
        let result = function
            .result
            .as_ref()
            .map(|result| type_name(&module, result.ty));
        line(
            &mut text,
            format_args!(
                "fn {name} {} -> {}",
                types.join(" "),
                result.unwrap_or_default()
            ),
        );
    }
    for entry in &module.entry_points {
        line(
            &mut text,
            format_args!("entry {} workgroup {:?}", entry.name, entry.workgroup_size),
        );
    }
    text
}

/// As WGSL spells it. Not naga's own words, which another version of naga may change.
fn type_name(module: &Module, ty: Handle<Type>) -> String {
    let scalar = |scalar: &naga::Scalar| match (scalar.kind, scalar.width) {
        (ScalarKind::Float, 4) => "f32",
        (ScalarKind::Uint, 4) => "u32",
        (ScalarKind::Sint, 4) => "i32",
        other => panic!("no scalar of the layout: {other:?}"),
    };
    let ty = &module.types[ty];
    match &ty.inner {
        TypeInner::Scalar(of) => scalar(of).to_owned(),
        TypeInner::Vector { size, scalar: of } => format!("vec{}<{}>", *size as u8, scalar(of)),
        TypeInner::Array { base, stride, .. } => {
            format!("array<{}> of stride {stride}", type_name(module, *base))
        }
        TypeInner::Struct { .. } => ty.name.clone().unwrap_or_default(),
        TypeInner::Image {
            dim: ImageDimension::D2,
            arrayed: true,
            class:
                ImageClass::Sampled {
                    kind: ScalarKind::Float,
                    multi: false,
                },
        } => "texture_2d_array<f32>".to_owned(),
        TypeInner::Sampler { comparison: false } => "sampler".to_owned(),
        other => panic!("no type of the layout: {other:?}"),
    }
}

fn line(text: &mut String, line: std::fmt::Arguments<'_>) {
    writeln!(text, "{line}").expect("a String takes all text");
}
