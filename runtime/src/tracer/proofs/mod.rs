//! Proofs on the device, by the shader's own text: what is sampled is distributed as its density says, and
//! no surface reflects more light than comes in.

mod bsdf;
mod chi_square;
mod cutouts;
mod lights;

use vtex_shaders::LinkContext;
use wgpu::BufferUsages;

use super::pipeline::{BufferGroup, SHADING, SceneGroup, linked, pipeline};
use crate::device::{READ, WRITE, empty_buffer, filled_buffer, read_back};
use crate::{Gpu, Scene, TraceOptions, Tracer};

/// What all kernels of proofs bind besides the scene.
const BINDINGS: &str = "
@group(1) @binding(0) var<storage, read> proof_input: array<f32>;
@group(1) @binding(1) var<storage, read_write> proof_output: array<atomic<u32>>;
";

/// A scene on the device with a kernel that reads it.
struct Probe {
    gpu: Gpu,
    tracer: Tracer,
    text: String,
}

impl Probe {
    /// `imports` are the modules that `text` builds on. `None` without a GPU to test on.
    fn new(what: &str, scene: &Scene, imports: &[&str], text: &str) -> Option<Self> {
        Self::with(what, scene, imports, text, LinkContext::default())
    }

    /// As [`Self::new`] with modules of its own in `context`.
    fn with(
        what: &str,
        scene: &Scene,
        imports: &[&str],
        text: &str,
        context: LinkContext,
    ) -> Option<Self> {
        if !vtex_testing::gpu(what) {
            return None;
        }
        let gpu = Gpu::headless().expect("an adapter; VTEX_GPU=off skips this test");
        let options = TraceOptions::default();
        let tracer = Tracer::new(&gpu.device, &gpu.queue, scene, [8, 8], &options).unwrap();
        let imports: String = imports
            .iter()
            .map(|name| format!("//!use {name}\n"))
            .collect();
        let text = [imports.as_str(), BINDINGS, text].concat();
        let context = tracer.scene.code(context).define("proof", text);
        let text = linked("proof", &context).unwrap();
        Some(Self { gpu, tracer, text })
    }

    /// Runs `entry_point` in `groups` workgroups; `count` words of what it wrote.
    fn run(&self, entry_point: &str, input: &[f32], count: usize, groups: u32) -> Vec<u32> {
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let input = bytemuck::cast_slice(input);
        let input =
            filled_buffer(device, queue, "proof input", input, BufferUsages::STORAGE).unwrap();
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let size = 4 * count as u64;
        let output = empty_buffer(device, "proof output", size, usage).unwrap();
        let scene = SceneGroup::new(device, &self.tracer.scene, &self.tracer.pass, SHADING);
        let own = BufferGroup::new(device, "proof", &[READ, WRITE], &[&input, &output]);
        let layouts = [&scene.layout, &own.layout];
        let kernel = pipeline(device, &self.text, entry_point, &layouts);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&kernel);
            pass.set_bind_group(0, &scene.group, &[]);
            pass.set_bind_group(1, &own.group, &[]);
            pass.dispatch_workgroups(groups, 1, 1);
        }
        queue.submit([encoder.finish()]);
        let read = read_back(device, queue, &output, size);
        let bytes = crate::device::block_on(device, read).unwrap();
        bytemuck::pod_collect_to_vec(&bytes)
    }
}
