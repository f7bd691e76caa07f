//! Arrays of lookups in, colours out.

use vtex_format::{SHADER_ABI, SpecKey, VtexFile};
use vtex_shaders::{BatchQuery, BindingSlot, batch_dispatch};
use wgpu::{
    BindGroupEntry, Buffer, BufferUsages, ComputePipeline, Device, Queue, ShaderSource,
    ShaderStages,
};

use crate::device::{
    READ, Uploaded, WRITE, buffer_entry, checked, compiled, empty_buffer, filled_buffer, kernel,
    read_back,
};
use crate::{LoadOptions, RuntimeError};

/// Whose shader is compiled. The key is the truth: text made from it is what a file means.
///
/// | | the file's text is what its key makes | it is not, or is of another ABI |
/// |---|---|---|
/// | [`Trust::Regenerate`] | our text | our text and a notice |
/// | [`Trust::File`] | the file's SPIR-V | the file's SPIR-V and a notice; of another ABI: our text and a notice |
///
/// "Text" is the WGSL fragment stored beside the SPIR-V. The SPIR-V itself cannot be compared
/// here, since this crate carries no SPIR-V writer: using it means to trust whoever wrote the
/// file as far as naga's validation leaves room, which is to compute wrong colours or to run
/// long, not to reach other memory. wgpu puts bounds on its loops and array indices as on any
/// shader. Where it is refused, or the caller's [`LoadOptions`] change the key, our text is used
/// and a notice says so.
///
/// SPIR-V is read only with the feature `spirv`, and not in a browser: naga may panic over words
/// that no compiler would write, and a panic there ends the program. Otherwise [`Trust::File`]
/// gives our text and a notice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trust {
    /// Ours, made from the key. What the file stores is only compared.
    #[default]
    Regenerate,
    /// The kernel stored in the file, if naga accepts it.
    File,
}

/// Queries of one dispatch; longer arrays are cut. 2 MiB of queries and 1 MiB of colours keep
/// well inside core limits and each submission short.
const CHUNK: usize = 1 << 16;

/// Evaluates lookups of one texture on the GPU.
#[derive(Clone, Debug)]
pub struct BatchSampler {
    device: Device,
    queue: Queue,
    pipeline: ComputePipeline,
    texture: Uploaded,
    notices: Vec<String>,
}

impl BatchSampler {
    /// Uploads the texture and compiles its kernel.
    ///
    /// # Errors
    /// As [`crate::GpuVtex::upload`]; [`RuntimeError::Shader`] when the device refuses our own
    /// kernel, which is a defect.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn new(
        device: &Device,
        queue: &Queue,
        file: &VtexFile,
        options: &LoadOptions,
        trust: Trust,
    ) -> Result<Self, RuntimeError> {
        let made = Self::new_async(device, queue, file, options, trust);
        crate::device::block_on(device, made)
    }

    /// As `BatchSampler::new`, for callers that must not block.
    ///
    /// # Errors
    /// As [`crate::GpuVtex::upload_async`]; [`RuntimeError::Shader`] when the device refuses our
    /// own kernel, which is a defect.
    pub async fn new_async(
        device: &Device,
        queue: &Queue,
        file: &VtexFile,
        options: &LoadOptions,
        trust: Trust,
    ) -> Result<Self, RuntimeError> {
        let packed = vtex_shaders::pack(file, &options.pack);
        // The upload has error scopes of its own: a texture too large for the device is the
        // caller's affair, while a kernel that does not compile is ours or the driver's.
        let texture = checked(device, "texture", || {
            Uploaded::new(device, queue, &packed.words, &packed.texels, options.texels)
        })
        .await?;
        let key = vtex_shaders::spec_key(file, &options.pack);
        let mut notices = Vec::new();
        let stored = match trusted_spirv(file, &key, trust, &mut notices) {
            Some(spirv) => stored_kernel(device, spirv, &mut notices).await,
            None => None,
        };
        let pipeline = match stored {
            Some(pipeline) => pipeline,
            None => {
                let wgsl = ShaderSource::Wgsl(vtex_shaders::batch_kernel(&key).into());
                compiled(device, "batch kernel", || Ok(batch_pipeline(device, wgsl))).await?
            }
        };
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            pipeline,
            texture,
            notices,
        })
    }

    /// Looks all queries up, in order; linear light, premultiplied.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device is lost.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn sample(&self, queries: &[BatchQuery]) -> Result<Vec<[f32; 4]>, RuntimeError> {
        crate::device::block_on(&self.device, self.sample_async(queries))
    }

    /// As `BatchSampler::sample`, for callers that must not block.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device is lost.
    pub async fn sample_async(
        &self,
        queries: &[BatchQuery],
    ) -> Result<Vec<[f32; 4]>, RuntimeError> {
        let mut colors = Vec::with_capacity(queries.len());
        // One chunk at a time: memory on the device stays that of one chunk, at the price of a wait
        // between chunks.
        for chunk in queries.chunks(CHUNK) {
            colors.extend(self.sample_chunk(chunk).await?);
        }
        Ok(colors)
    }

    async fn sample_chunk(&self, queries: &[BatchQuery]) -> Result<Vec<[f32; 4]>, RuntimeError> {
        let (device, queue) = (&self.device, &self.queue);
        let size = (queries.len() * size_of::<[f32; 4]>()) as u64;
        let output = checked(device, "batch", || {
            let bytes = bytemuck::cast_slice(queries);
            let storage = BufferUsages::STORAGE;
            let input = filled_buffer(device, queue, "vtex queries", bytes, storage)?;
            let usage = storage | BufferUsages::COPY_SRC;
            // Not padded as `input` may be: its length tells the kernel where the queries end.
            let output = empty_buffer(device, "vtex colours", size, usage)?;
            let group = self.bind(&input, &output);
            self.dispatch(&group, queries.len());
            Ok(output)
        })
        .await?;
        let bytes = read_back(device, queue, &output, size).await?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }

    fn bind(&self, input: &Buffer, output: &Buffer) -> wgpu::BindGroup {
        let [words, texels, sampler] = self.texture.entries(0);
        let [input, output] = [(3, input), (4, output)].map(|(binding, buffer)| BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        });
        let entries = [words, texels, sampler, input, output];
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("vtex batch"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    }

    fn dispatch(&self, group: &wgpu::BindGroup, count: usize) {
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, group, &[]);
            let count = u32::try_from(count).unwrap_or(u32::MAX);
            let [x, y, z] = batch_dispatch(count);
            pass.dispatch_workgroups(x, y, z);
        }
        self.queue.submit([encoder.finish()]);
    }

    /// Where the file's own shader differs from its key or was not used though asked for, one
    /// sentence each.
    pub fn notices(&self) -> &[String] {
        &self.notices
    }
}

/// The file's SPIR-V where [`Trust`]'s table says that it is used.
pub(crate) fn trusted_spirv<'a>(
    file: &'a VtexFile,
    key: &SpecKey,
    trust: Trust,
    notices: &mut Vec<String>,
) -> Option<&'a [u32]> {
    let blob = &file.shader;
    // First: text of another ABI differs from ours by right, which would look like tampering.
    if blob.abi != SHADER_ABI {
        notices.push(format!(
            "the file's shader is of ABI {}, this runtime's is {SHADER_ABI}: using our own",
            blob.abi
        ));
        return None;
    }
    // The key of the file, not `key`: the caller's options change ours, never what was stored.
    let ours = vtex_shaders::fragment(&file.spec, BindingSlot::default());
    if ours != blob.wgsl_fragment {
        let used = match trust {
            Trust::Regenerate => "using our own",
            Trust::File => "using the file's, as asked",
        };
        notices.push(format!(
            "the file's shader is not what its key makes: {used}"
        ));
    }
    if trust == Trust::Regenerate {
        return None;
    }
    if vtex_shaders::kernel_key(key) != vtex_shaders::kernel_key(&file.spec) {
        notices.push("load options need another shader: using our own".to_owned());
        return None;
    }
    Some(&blob.batch_spirv)
}

/// Compiles the file's kernel; `None` and a notice where that is refused.
#[cfg(all(feature = "spirv", not(target_arch = "wasm32")))]
pub(crate) async fn stored_kernel(
    device: &Device,
    spirv: &[u32],
    notices: &mut Vec<String>,
) -> Option<ComputePipeline> {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    let made = compiled(device, "batch kernel", || {
        let source = ShaderSource::SpirV(spirv.into());
        // naga may stumble over words no compiler would write; the process must not.
        catch_unwind(AssertUnwindSafe(|| batch_pipeline(device, source)))
            .map_err(|_| RuntimeError::Shader("the parser panicked".to_owned()))
    });
    match made.await {
        Ok(pipeline) => Some(pipeline),
        Err(error) => {
            notices.push(format!(
                "the file's kernel was refused, using our own: {error}"
            ));
            None
        }
    }
}

/// This build reads no SPIR-V.
#[cfg(not(all(feature = "spirv", not(target_arch = "wasm32"))))]
pub(crate) async fn stored_kernel(
    _: &Device,
    _: &[u32],
    notices: &mut Vec<String>,
) -> Option<ComputePipeline> {
    notices.push("this build reads no SPIR-V, using our own shader".to_owned());
    None
}

/// Compiles a kernel of the batch interface: group 0 with words, texels, sampler, queries, colours.
pub(crate) fn batch_pipeline(device: &Device, source: ShaderSource<'_>) -> ComputePipeline {
    let label = "vtex batch";
    // Written out, not derived from the shader: a derived layout leaves out what a kernel does not
    // read, and a kernel from a file may read less than we bind.
    let [words, texels, sampler] = Uploaded::layout_entries(0, ShaderStages::COMPUTE);
    let [input, output] = [buffer_entry(3, READ), buffer_entry(4, WRITE)];
    let group = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[words, texels, sampler, input, output],
    });
    kernel(device, label, source, "vtex_batch", &[&group])
}
