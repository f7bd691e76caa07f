//! The GPU adapter, and timing kernels on it.

use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, ensure};
use serde_json::{Value, json};
use vtex_runtime::Gpu;
use wgpu::util::DeviceExt as _;

use super::queries::QuerySet;

/// Bytes of two timestamps.
const STAMPS_BYTES: u64 = 16;

/// A device with the limits of core WebGPU.
#[derive(Debug)]
pub(crate) struct Device {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
    stamps: Option<Stamps>,
}

/// Where the GPU writes when a pass began and ended.
#[derive(Debug)]
struct Stamps {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readable: wgpu::Buffer,
    period_ns: f64,
}

/// A compiled kernel with what it reads.
#[derive(Debug)]
pub(crate) struct Kernel {
    pipeline: wgpu::ComputePipeline,
    resources: wgpu::BindGroup,
}

/// What makes queries on the device, and room for their results.
#[derive(Debug)]
pub(crate) struct Batch {
    queries: wgpu::Buffer,
    results: wgpu::Buffer,
    workgroups: [u32; 2],
}

impl Device {
    /// The adapter that the runtime would take.
    pub(crate) fn open() -> Result<Self> {
        let Gpu {
            adapter_info: info,
            device,
            queue,
        } = Gpu::headless()?;
        // The runtime ignores errors it does not expect. Here such an error means that a kernel is
        // broken, and timing it would measure nothing.
        device.on_uncaptured_error(Arc::new(|error| panic!("{error}")));
        let has_timestamps = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let stamps = has_timestamps.then(|| Stamps::new(&device, &queue));
        Ok(Self {
            device,
            queue,
            info,
            stamps,
        })
    }

    /// An error when the adapter is this machine's processor.
    pub(crate) fn refuse_software(&self) -> Result<()> {
        ensure!(
            !self.is_software(),
            "the adapter is {}, which is this machine's processor and no graphics card: install the \
             card's Vulkan driver, or name another adapter with VTEX_ADAPTER",
            self.info.name
        );
        Ok(())
    }

    /// Whether the adapter is this machine's processor.
    pub(crate) fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Whether it has BC7 textures.
    pub(crate) fn has_bc7(&self) -> bool {
        let features = self.device.features();
        features.contains(wgpu::Features::TEXTURE_COMPRESSION_BC)
    }

    /// Name and value, for people.
    pub(crate) fn lines(&self) -> Vec<(&'static str, String)> {
        let wgpu::AdapterInfo {
            name,
            driver,
            driver_info,
            backend,
            ..
        } = &self.info;
        vec![
            ("Adapter", format!("{name} ({backend:?})")),
            ("Driver", format!("{driver} {driver_info}")),
            ("GPU clock", self.clock().to_owned()),
        ]
    }

    /// The same for programs.
    pub(crate) fn to_json(&self) -> Value {
        json!({
            "name": self.info.name,
            "driver": self.info.driver,
            "driver_info": self.info.driver_info,
            "backend": format!("{:?}", self.info.backend),
            "device_type": format!("{:?}", self.info.device_type),
            "clock": self.clock(),
        })
    }

    fn clock(&self) -> &'static str {
        match self.stamps {
            Some(_) => "timestamp queries around the pass",
            None => "wall clock from submit to done",
        }
    }

    /// Compiles `wgsl`, which must define `bench_sample`. Its group 0 is bound to `resources`, in
    /// order.
    pub(crate) fn kernel(&self, wgsl: &str, resources: &[wgpu::BindingResource<'_>]) -> Kernel {
        let source = [include_str!("../wgsl/root.wgsl"), wgsl].concat();
        let module = self
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
        let pipeline = self
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: None,
                layout: None,
                module: &module,
                entry_point: Some("bench_main"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            });
        let resources = self.bind(&pipeline, 0, resources);
        Kernel {
            pipeline,
            resources,
        }
    }

    /// Lookups to time, whose results nobody sees.
    pub(crate) fn batch(&self, set: &QuerySet) -> Batch {
        self.batch_of(set, false)
    }

    /// Lookups with room for the results, 16 bytes each.
    pub(crate) fn kept_batch(&self, set: &QuerySet) -> Batch {
        self.batch_of(set, true)
    }

    fn batch_of(&self, set: &QuerySet, keeps: bool) -> Batch {
        let results = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: if keeps { set.len() as u64 * 16 } else { 16 },
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let record = set.record(keeps);
        Batch {
            queries: self.buffer(bytemuck::bytes_of(&record), wgpu::BufferUsages::UNIFORM),
            results,
            workgroups: set.workgroups(),
        }
    }

    /// A buffer holding `bytes`.
    pub(crate) fn buffer(&self, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents: bytes,
                usage,
            })
    }

    /// Runs a kernel over a batch and returns how long the GPU took.
    pub(crate) fn time(&self, kernel: &Kernel, batch: &Batch) -> Result<Duration> {
        let buffers = [
            batch.queries.as_entire_binding(),
            batch.results.as_entire_binding(),
        ];
        let buffers = self.bind(&kernel.pipeline, 1, &buffers);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: None,
            timestamp_writes: self.stamps.as_ref().map(Stamps::writes),
        });
        pass.set_pipeline(&kernel.pipeline);
        pass.set_bind_group(0, &kernel.resources, &[]);
        pass.set_bind_group(1, &buffers, &[]);
        let [x, y] = batch.workgroups;
        pass.dispatch_workgroups(x, y, 1);
        drop(pass);
        if let Some(stamps) = &self.stamps {
            stamps.resolve(&mut encoder);
        }
        let commands = encoder.finish();
        let start = Instant::now();
        self.queue.submit([commands]);
        self.wait()?;
        let wall = start.elapsed();
        self.stamps
            .as_ref()
            .map_or(Ok(wall), |stamps| stamps.read(self))
    }

    /// Results of the latest run over a batch of [`Self::kept_batch`].
    pub(crate) fn results(&self, batch: &Batch) -> Result<Vec<[f32; 4]>> {
        let size = batch.results.size();
        let readable = readable_buffer(&self.device, size);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&batch.results, 0, &readable, 0, size);
        self.queue.submit([encoder.finish()]);
        Ok(bytemuck::pod_collect_to_vec(&self.read(&readable)?))
    }

    fn bind(
        &self,
        pipeline: &wgpu::ComputePipeline,
        group: u32,
        resources: &[wgpu::BindingResource<'_>],
    ) -> wgpu::BindGroup {
        let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry {
                binding,
                resource: resource.clone(),
            })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(group),
            entries: &entries,
        })
    }

    fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>> {
        let (done, mapped) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver lives until the answer is there.
            let _ = done.send(result);
        });
        self.wait()?;
        mapped.recv().context("the device dropped a mapping")??;
        let bytes = buffer.get_mapped_range(..)?.to_vec();
        buffer.unmap();
        Ok(bytes)
    }

    /// Waits until everything is done, also what was only written.
    pub(crate) fn finish(&self) -> Result<()> {
        self.queue.submit([]);
        self.wait()
    }

    fn wait(&self) -> Result<()> {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .context("the device is lost")?;
        Ok(())
    }
}

impl Stamps {
    fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let set = device.create_query_set(&wgpu::QuerySetDescriptor {
            label: None,
            ty: wgpu::QueryType::Timestamp,
            count: 2,
        });
        let resolved = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: STAMPS_BYTES,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let readable = readable_buffer(device, STAMPS_BYTES);
        Self {
            set,
            resolved,
            readable,
            period_ns: f64::from(queue.get_timestamp_period()),
        }
    }

    fn writes(&self) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.set,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.resolve_query_set(&self.set, 0..2, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readable, 0, STAMPS_BYTES);
    }

    fn read(&self, device: &Device) -> Result<Duration> {
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&device.read(&self.readable)?);
        let ticks = ticks[1].saturating_sub(ticks[0]);
        Ok(Duration::from_secs_f64(
            ticks as f64 * self.period_ns * 1e-9,
        ))
    }
}

fn readable_buffer(device: &wgpu::Device, size: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
