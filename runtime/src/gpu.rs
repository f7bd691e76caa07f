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
    /// Opens an adapter without a window, with the limits of core WebGPU, and with timestamps and
    /// BC textures where the adapter has them. Hardware is preferred; a software driver serves when
    /// it is all there is. [`ADAPTER_VARIABLE`] overrides the choice.
    ///
    /// Errors of this crate's own calls come back as [`RuntimeError`]. wgpu panics on any other
    /// unless told not to; this device is told to drop them, so a program that makes calls of its
    /// own sets [`wgpu::Device::on_uncaptured_error`] to hear of its mistakes.
    ///
    /// # Errors
    /// [`RuntimeError::NoAdapter`] when there is none or none matches,
    /// [`RuntimeError::Device`] when the adapter offers less than core WebGPU.
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn headless() -> Result<Self, RuntimeError> {
        // Outside a browser wgpu answers both requests at once.
        pollster::block_on(Self::headless_async())
    }

    /// As `Gpu::headless`, for callers that must not block, such as a page in a browser. There
    /// the browser chooses the adapter: a page has no environment variables.
    ///
    /// # Errors
    /// [`RuntimeError::NoAdapter`] when there is none or none matches,
    /// [`RuntimeError::Device`] when the adapter offers less than core WebGPU.
    pub async fn headless_async() -> Result<Self, RuntimeError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        // On wasm32 this is always an error, and so the browser's choice.
        let wanted = std::env::var(ADAPTER_VARIABLE).ok();
        let adapter = match wanted.as_deref().filter(|name| !name.is_empty()) {
            Some(name) => named_adapter(&instance, name).await?,
            None => best_adapter(&instance).await?,
        };
        // Clocks, and block-compressed textures beside vector textures.
        let optional = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::TEXTURE_COMPRESSION_BC;
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor {
                label: Some("vtex"),
                // A device refuses features that its adapter lacks, so ask for no more.
                required_features: adapter.features() & optional,
                // Not the adapter's own limits: what runs here then runs on every device.
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
    // One card is listed once for each back-end that sees it; the first one in wgpu's order serves.
    adapters
        .into_iter()
        .find(|adapter| adapter.get_info().name.to_lowercase().contains(&wanted))
        .ok_or_else(|| {
            RuntimeError::NoAdapter(format!(
                "{ADAPTER_VARIABLE}={name} matches none of {names:?}"
            ))
        })
}
