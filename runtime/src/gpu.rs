//! A device to run on, for programs that have none of their own.

use std::sync::Arc;

use crate::RuntimeError;

/// Environment variable that picks the adapter whose name contains its value, case ignored.
pub const ADAPTER_VARIABLE: &str = "VTEX_ADAPTER";

/// An adapter's description with a device and queue of it.
///
/// Everything else in this crate takes `&Device` and `&Queue`, so a program with its own device
/// needs no `Gpu`.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The adapter: name, kind, driver, backend.
    pub adapter_info: wgpu::AdapterInfo,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

impl Gpu {
    /// Opens an adapter without a window, with the limits of core WebGPU, and timestamps where
    /// the adapter has them. Hardware is preferred; a software driver serves when it is all there
    /// is. [`ADAPTER_VARIABLE`] overrides the choice.
    ///
    /// Errors of this crate's own calls come back as [`RuntimeError`]. wgpu panics on any other
    /// unless told not to; this device is told to drop them, so a program that makes calls of its
    /// own sets [`wgpu::Device::on_uncaptured_error`] to hear of its mistakes.
    ///
    /// # Errors
    /// [`RuntimeError::NoAdapter`] when there is none or none matches,
    /// [`RuntimeError::Device`] when the adapter offers less than core WebGPU.
    pub fn headless() -> Result<Self, RuntimeError> {
        let wanted = std::env::var(ADAPTER_VARIABLE).ok();
        pollster::block_on(Self::open(wanted.as_deref()))
    }

    /// As [`Gpu::headless`] for callers that must not block, such as a browser. `wanted` is part
    /// of the adapter's name; `None` takes the best.
    ///
    /// # Errors
    /// As [`Gpu::headless`].
    pub async fn open(wanted: Option<&str>) -> Result<Self, RuntimeError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = match wanted.filter(|name| !name.is_empty()) {
            Some(name) => named_adapter(&instance, name).await?,
            None => best_adapter(&instance).await?,
        };
        let optional = wgpu::Features::TIMESTAMP_QUERY;
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor {
                label: Some("vtex"),
                required_features: adapter.features() & optional,
                required_limits: wgpu::Limits::defaults(),
                ..Default::default()
            })
            .await
            .map_err(|error| RuntimeError::Device(error.to_string()))?;
        device.on_uncaptured_error(Arc::new(|_| {}));
        Ok(Self::from_parts(adapter.get_info(), device, queue))
    }

    /// Bundles a device the caller owns.
    pub fn from_parts(
        adapter_info: wgpu::AdapterInfo,
        device: wgpu::Device,
        queue: wgpu::Queue,
    ) -> Self {
        Self {
            adapter_info,
            device,
            queue,
        }
    }

    /// Name of the adapter, as the driver gives it.
    pub fn adapter_name(&self) -> &str {
        &self.adapter_info.name
    }

    /// Whether the "GPU" is this machine's processor.
    pub fn is_software(&self) -> bool {
        self.adapter_info.device_type == wgpu::DeviceType::Cpu
    }
}

async fn best_adapter(instance: &wgpu::Instance) -> Result<wgpu::Adapter, RuntimeError> {
    instance
        .request_adapter(&wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        })
        .await
        .map_err(|error| RuntimeError::NoAdapter(error.to_string()))
}

async fn named_adapter(
    instance: &wgpu::Instance,
    name: &str,
) -> Result<wgpu::Adapter, RuntimeError> {
    let adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
    let names: Vec<String> = adapters.iter().map(|a| a.get_info().name).collect();
    let wanted = name.to_lowercase();
    adapters
        .into_iter()
        .find(|adapter| adapter.get_info().name.to_lowercase().contains(&wanted))
        .ok_or_else(|| {
            RuntimeError::NoAdapter(format!(
                "{ADAPTER_VARIABLE}={name} matches none of {names:?}"
            ))
        })
}

/// Runs `make` and turns the validation and memory errors it causes into a [`RuntimeError`].
pub(crate) fn checked<T>(
    device: &wgpu::Device,
    what: &str,
    make: impl FnOnce() -> T,
) -> Result<T, RuntimeError> {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let made = make();
    let validation = pollster::block_on(validation.pop());
    let memory = pollster::block_on(memory.pop());
    match (validation, memory) {
        (_, Some(error)) => Err(RuntimeError::Limit(format!("{what}: {error}"))),
        (Some(error), None) => Err(RuntimeError::Device(format!("{what}: {error}"))),
        (None, None) => Ok(made),
    }
}

/// As [`checked`] for shaders and pipelines.
pub(crate) fn compiled<T>(
    device: &wgpu::Device,
    what: &str,
    make: impl FnOnce() -> T,
) -> Result<T, RuntimeError> {
    checked(device, what, make).map_err(|error| match error {
        RuntimeError::Device(message) => RuntimeError::Shader(message),
        other => other,
    })
}

/// Makes a buffer that holds `bytes`; an empty slice becomes one zero word, since bindings may
/// not be empty.
///
/// # Errors
/// [`RuntimeError::Limit`] when `bytes` does not fit one binding of the device.
pub(crate) fn filled_buffer(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    bytes: &[u8],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, RuntimeError> {
    let size = (bytes.len() as u64).max(64).next_multiple_of(4);
    let buffer = empty_buffer(device, label, size, usage | wgpu::BufferUsages::COPY_DST)?;
    // Every record of this crate is whole words long, so no tail is left to pad.
    queue.write_buffer(&buffer, 0, bytes);
    Ok(buffer)
}

/// Makes a zeroed buffer of `size` bytes.
pub(crate) fn empty_buffer(
    device: &wgpu::Device,
    label: &str,
    size: u64,
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, RuntimeError> {
    let limits = device.limits();
    let limit = if usage.contains(wgpu::BufferUsages::STORAGE) {
        limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size)
    } else {
        limits.max_buffer_size
    };
    if size > limit {
        return Err(RuntimeError::Limit(format!(
            "{label} needs {size} bytes, this device binds at most {limit}"
        )));
    }
    checked(device, label, || {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage,
            mapped_at_creation: false,
        })
    })
}

/// Waits for all submitted work.
pub(crate) fn wait(device: &wgpu::Device) -> Result<(), RuntimeError> {
    device
        .poll(wgpu::PollType::wait_indefinitely())
        .map(|_| ())
        .map_err(|error| RuntimeError::Device(error.to_string()))
}

/// Copies the first `size` bytes of `source` back. `source` needs `COPY_SRC`.
pub(crate) fn read_buffer(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    source: &wgpu::Buffer,
    size: u64,
) -> Result<Vec<u8>, RuntimeError> {
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
    let staging = empty_buffer(device, "vtex readback", size, usage)?;
    checked(device, "read-back", || {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(source, 0, &staging, 0, size);
        queue.submit([encoder.finish()]);
    })?;
    let (sender, receiver) = std::sync::mpsc::channel();
    staging.map_async(wgpu::MapMode::Read, .., move |result| {
        // The receiver lives until `recv` below returns; were it gone, nobody would want this.
        let _ = sender.send(result);
    });
    wait(device)?;
    // Another thread that polls the same device may run the callback after this one's wait ends.
    let mapped = receiver
        .recv()
        .map_err(|_| RuntimeError::Device("read-back never finished".to_owned()))?;
    mapped.map_err(|error| RuntimeError::Device(error.to_string()))?;
    let view = staging
        .get_mapped_range(..)
        .map_err(|error| RuntimeError::Device(error.to_string()))?;
    Ok(view.to_vec())
}
