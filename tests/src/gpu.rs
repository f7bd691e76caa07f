//! An adapter to run on, and the batch kernel straight through wgpu.

use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use vtex_shaders::{BatchQuery, TexelPages, batch_dispatch};
use wgpu::util::DeviceExt as _;

/// What a test leaves out with `VTEX_GPU=off`.
const UNTESTED: &str = "what runs on the GPU";

/// The runtime's adapter, which all tests of a suite share, or `None` when they are switched off.
///
/// # Panics
/// When there is no adapter; later, on a validation error: no test is to pass over one.
#[track_caller]
pub fn shared() -> Option<&'static vtex_runtime::Gpu> {
    static GPU: OnceLock<vtex_runtime::Gpu> = OnceLock::new();
    let open = || {
        let gpu = vtex_runtime::Gpu::headless();
        let gpu = gpu.expect("an adapter; VTEX_GPU=off skips these tests");
        gpu.device
            .on_uncaptured_error(Arc::new(|error| panic!("{error}")));
        gpu
    };
    vtex_testing::gpu(UNTESTED).then(|| GPU.get_or_init(open))
}

/// A device with core WebGPU's limits. Validation errors panic, which is wgpu's default.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// What it runs on.
    pub adapter_info: wgpu::AdapterInfo,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

impl Gpu {
    /// Opens the best adapter. `None` when the environment says `VTEX_GPU=off`.
    ///
    /// # Panics
    /// When there is no adapter, or it offers less than core WebGPU.
    #[track_caller]
    pub fn open() -> Option<Self> {
        if !vtex_testing::gpu(UNTESTED) {
            return None;
        }
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()))
            .expect("no GPU adapter: install a Vulkan driver or set VTEX_GPU=off");
        let request = adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("vtex tests"),
            required_limits: wgpu::Limits::defaults(),
            ..Default::default()
        });
        let (device, queue) = pollster::block_on(request).expect("core WebGPU");
        Some(Self {
            adapter_info: adapter.get_info(),
            device,
            queue,
        })
    }

    /// Compiles a batch kernel from WGSL or SPIR-V.
    pub fn kernel(&self, source: wgpu::ShaderSource<'_>) -> Kernel<'_> {
        let module = self
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("batch kernel"),
                source,
            });
        let pipeline = self
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some("batch kernel"),
                layout: None,
                module: &module,
                entry_point: Some("vtex_batch"),
                compilation_options: Default::default(),
                cache: None,
            });
        Kernel {
            gpu: self,
            pipeline,
        }
    }

    fn buffer(&self, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents: bytes,
                usage,
            })
    }

    fn texture(&self, pages: &TexelPages) -> wgpu::TextureView {
        let [width, height] = pages.size();
        let texture = self.device.create_texture_with_data(
            &self.queue,
            &wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width,
                    height,
                    depth_or_array_layers: pages.count(),
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba8UnormSrgb,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::LayerMajor,
            pages.bytes(),
        );
        texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        })
    }

    fn read(&self, buffer: &wgpu::Buffer) -> Vec<[f32; 4]> {
        buffer.map_async(wgpu::MapMode::Read, .., |mapped| {
            mapped.expect("readable results");
        });
        self.wait();
        let view = buffer.get_mapped_range(..).expect("mapped results");
        bytemuck::pod_collect_to_vec(&view)
    }

    fn wait(&self) {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device stays");
    }
}

/// A batch kernel that is ready to run.
#[derive(Debug)]
pub struct Kernel<'a> {
    gpu: &'a Gpu,
    pipeline: wgpu::ComputePipeline,
}

/// What a run of the kernel gave.
#[derive(Clone, Debug)]
pub struct Answers {
    /// One colour a query.
    pub colors: Vec<[f32; 4]>,
    /// Wall time from submission to completion, of a second run: drivers compile at the first.
    pub time: Duration,
}

impl Kernel<'_> {
    /// Looks `queries` up in one packed texture, or in several.
    ///
    /// # Panics
    /// When the device fails or there are more than 2^32 queries.
    pub fn run(&self, words: &[u32], texels: &TexelPages, queries: &[BatchQuery]) -> Answers {
        use wgpu::BufferUsages as Usage;
        let gpu = self.gpu;
        let size = size_of::<[f32; 4]>() as u64 * queries.len() as u64;
        let buffer = |usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let results = buffer(Usage::STORAGE | Usage::COPY_SRC);
        let staging = buffer(Usage::MAP_READ | Usage::COPY_DST);
        let words = gpu.buffer(bytemuck::cast_slice(words), Usage::STORAGE);
        let inputs = gpu.buffer(bytemuck::cast_slice(queries), Usage::STORAGE);
        let texels = gpu.texture(texels);
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let bound = [
            words.as_entire_binding(),
            wgpu::BindingResource::TextureView(&texels),
            wgpu::BindingResource::Sampler(&sampler),
            inputs.as_entire_binding(),
            results.as_entire_binding(),
        ];
        let entries: Vec<_> = (0..)
            .zip(bound)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let count = u32::try_from(queries.len()).expect("fewer than 2^32 queries");
        self.dispatch(&group, count);
        let started = Instant::now();
        self.dispatch(&group, count);
        let time = started.elapsed();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&results, 0, &staging, 0, size);
        gpu.queue.submit([encoder.finish()]);
        Answers {
            colors: gpu.read(&staging),
            time,
        }
    }

    fn dispatch(&self, group: &wgpu::BindGroup, count: u32) {
        let [x, y, z] = batch_dispatch(count);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups(x, y, z);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait();
    }
}
