//! Buffers of bytes, there and back.

use futures_channel::oneshot;
use wgpu::{Buffer, BufferUsages, Device, Queue};

use super::reply::reply;
use super::scope::checked;
use crate::RuntimeError;

/// Least size of a buffer with contents. A binding may not be smaller than one element of the array
/// that the shader declares, even when the scene has none; the tracer's largest record has 80 bytes.
const MIN_FILLED_BYTES: u64 = 128;

/// Makes a buffer that holds `bytes`, and zeros where they end before [`MIN_FILLED_BYTES`]. To be
/// called in [`checked`].
///
/// # Errors
/// [`RuntimeError::Limit`] when `bytes` does not fit one binding of the device.
pub(crate) fn filled_buffer(
    device: &Device,
    queue: &Queue,
    label: &str,
    bytes: &[u8],
    usage: BufferUsages,
) -> Result<Buffer, RuntimeError> {
    let size = (bytes.len() as u64)
        .max(MIN_FILLED_BYTES)
        .next_multiple_of(4);
    let buffer = empty_buffer(device, label, size, usage | BufferUsages::COPY_DST)?;
    // WebGPU copies whole words. Every record of this crate is whole words long, so no tail is left
    // to pad.
    queue.write_buffer(&buffer, 0, bytes);
    Ok(buffer)
}

/// Makes a zeroed buffer of `size` bytes. To be called in [`checked`].
///
/// # Errors
/// [`RuntimeError::Limit`] when it does not fit one binding of the device. wgpu would say so too,
/// but as a validation error, and on the web only in English.
pub(crate) fn empty_buffer(
    device: &Device,
    label: &str,
    size: u64,
    usage: BufferUsages,
) -> Result<Buffer, RuntimeError> {
    let limits = device.limits();
    // Two independent limits: core WebGPU binds 128 MiB of buffers that may hold 256.
    let limit = if usage.contains(BufferUsages::STORAGE) {
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
    Ok(device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage,
        mapped_at_creation: false,
    }))
}

/// Copies the first `size` bytes of `source` back. `source` needs `COPY_SRC`.
///
/// A buffer that shaders write cannot be mapped on core WebGPU, hence the copy in between.
pub(crate) async fn read_back(
    device: &Device,
    queue: &Queue,
    source: &Buffer,
    size: u64,
) -> Result<Vec<u8>, RuntimeError> {
    let staging = checked(device, "read-back", || {
        // With MAP_READ core WebGPU allows no usage but this.
        let usage = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
        let staging = empty_buffer(device, "vtex read-back", size, usage)?;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(source, 0, &staging, 0, size);
        queue.submit([encoder.finish()]);
        Ok(staging)
    })
    .await?;
    let ask = |mapped: oneshot::Sender<_>| {
        // Nobody listens any more when the future was dropped.
        staging.map_async(wgpu::MapMode::Read, .., move |result| {
            let _ = mapped.send(result);
        });
    };
    // Two failures: the callback never came, or it came and says that mapping failed.
    reply(device, ask)
        .await?
        .map_err(|error| RuntimeError::Device(error.to_string()))?;
    let view = staging
        .get_mapped_range(..)
        .map_err(|error| RuntimeError::Device(error.to_string()))?;
    // A copy: the view borrows the staging buffer, which ends here.
    Ok(view.to_vec())
}
