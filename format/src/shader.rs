//! The specialised shader made at bake time.

/// Stored in `SHDR`. The key in `SPEC` is the truth, this is a convenience: readers compare
/// hashes and regenerate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaderBlob {
    /// [`crate::SHADER_ABI`] it was made for.
    pub abi: u32,
    /// WGSL text of the fragment: `fn vtex_sample(uv: vec2f, footprint: vec4f) -> vec4f`.
    pub wgsl_fragment: String,
    /// SPIR-V words of the standalone batch kernel.
    pub batch_spirv: Vec<u32>,
}
