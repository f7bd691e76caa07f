//! The batch kernel as SPIR-V, made and checked by naga at bake time.

use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use vtex_format::{Features, SHADER_ABI, ShaderBlob, SpecKey};

use crate::spec::kernel_key;
use crate::specialize::{BindingSlot, batch_kernel, fragment};

/// SPIR-V version of the kernel: Vulkan 1.1's.
const SPIRV_VERSION: (u8, u8) = (1, 3);

/// `unpack2x16float`, which every WebGPU device has.
const CAPABILITIES: Capabilities = Capabilities::SHADER_FLOAT16_IN_FLOAT32;

/// Why a text could not be compiled.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PrecompileError {
    /// It is not WGSL.
    #[error("cannot parse the shader: {0}")]
    Parse(String),
    /// It is WGSL but breaks a rule.
    #[error("the shader is not valid: {0}")]
    Invalid(String),
    /// It is valid but has no SPIR-V form.
    #[error("cannot write the shader as SPIR-V: {0}")]
    Write(String),
}

/// SPIR-V words of `wgsl`, fully validated. Same text, same words.
///
/// # Errors
/// [`PrecompileError`] with naga's diagnostic.
pub fn spirv(wgsl: &str) -> Result<Vec<u32>, PrecompileError> {
    let module = naga::front::wgsl::parse_str(wgsl)
        .map_err(|error| PrecompileError::Parse(error.emit_to_string(wgsl)))?;
    let info = Validator::new(ValidationFlags::all(), CAPABILITIES)
        .validate(&module)
        .map_err(|error| PrecompileError::Invalid(error.emit_to_string(wgsl)))?;
    let options = spv::Options {
        lang_version: SPIRV_VERSION,
        // The flags are for debug names and for vertex and fragment stages; a kernel needs none.
        flags: spv::WriterFlags::empty(),
        ..spv::Options::default()
    };
    // Without a choice of an entry point: the kernel has only one.
    spv::write_vec(&module, &info, &options, None)
        .map_err(|error| PrecompileError::Write(error.to_string()))
}

/// What `SHDR` stores for `key`: the fragment's text at group 0, binding 0, and the batch
/// kernel's SPIR-V.
///
/// # Errors
/// [`PrecompileError`] when naga refuses the kernel; a test compiles every key.
pub fn shader_blob(key: &SpecKey) -> Result<ShaderBlob, PrecompileError> {
    Ok(ShaderBlob {
        abi: SHADER_ABI,
        wgsl_fragment: fragment(key, BindingSlot::default()),
        batch_spirv: spirv(&batch_kernel(key))?,
    })
}

/// Keys whose shaders are the dictionaries of `vtex_format`, the one with the most modules first. Of
/// 276 real files all have one of them, up to features that change a number in the text.
///
/// Others need texture matrix or address modes, MSDFs, or a distance outline: they would be as
/// many again for each, and each takes 5 to 10 KB of the library.
pub fn dictionary_keys() -> Vec<SpecKey> {
    const GROUPS: u32 = Features::GROUPS | Features::BLENDS;
    let mut sets = Vec::new();
    for brushes in [
        Features::TRANSLUCENT | Features::IMAGES,
        Features::TRANSLUCENT,
        0,
    ] {
        for paints in [Features::GRADIENTS, 0] {
            for groups in [GROUPS, 0] {
                sets.push(Features::LISTS | Features::CURVES | brushes | paints | groups);
            }
        }
    }
    sets.extend([
        Features::LISTS | Features::TRANSLUCENT | Features::IMAGES,
        Features::GRADIENTS,
        0,
    ]);
    let keys = sets.into_iter().map(|features| SpecKey { features });
    keys.map(|key| kernel_key(&key)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_compile_to_the_same_words_twice() {
        let features = Features::ALL;
        let key = SpecKey { features };
        let blob = shader_blob(&key).unwrap();
        assert_eq!(blob, shader_blob(&key).unwrap());
        assert_eq!(blob.batch_spirv[0], 0x0723_0203, "SPIR-V's magic number");
    }

    #[test]
    fn errors_say_what_is_wrong() {
        assert!(matches!(spirv("fn f( {"), Err(PrecompileError::Parse(_))));
        let invalid = "fn f() -> u32 { return 1.0; }";
        assert!(spirv(invalid).is_err(), "a return of the wrong type");
    }
}
