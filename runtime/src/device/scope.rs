//! Calls whose errors come back as values.
//!
//! wgpu reports what is wrong with a call not to the caller but to the innermost error scope, and
//! panics where there is none. On the web the scope's answer comes from another process.

use wgpu::{Device, ErrorFilter};

use crate::RuntimeError;

/// Runs `make` at once; the future ends with what it made or with the first validation or memory
/// error that it caused. `what` starts the message.
///
/// All calls of `make` share the two scopes: on the web each scope costs a round trip.
pub(crate) fn checked<T>(
    device: &Device,
    what: &str,
    make: impl FnOnce() -> Result<T, RuntimeError>,
) -> impl Future<Output = Result<T, RuntimeError>> {
    let memory = device.push_error_scope(ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(ErrorFilter::Validation);
    let made = make();
    // Scopes form a stack, natively one for each thread. Both are closed before the first await:
    // after it another task may open scopes, or this one may go on in another thread.
    let validation = validation.pop();
    let memory = memory.pop();
    let what = what.to_owned();
    async move {
        match (validation.await, memory.await) {
            // A buffer that was refused for its size makes what uses it invalid too.
            (_, Some(error)) => Err(RuntimeError::Limit(format!("{what}: {error}"))),
            (Some(error), None) => Err(RuntimeError::Device(format!("{what}: {error}"))),
            (None, None) => made,
        }
    }
}

/// As [`checked`] for shaders and pipelines.
pub(crate) fn compiled<T>(
    device: &Device,
    what: &str,
    make: impl FnOnce() -> Result<T, RuntimeError>,
) -> impl Future<Output = Result<T, RuntimeError>> {
    let made = checked(device, what, make);
    async move {
        made.await.map_err(|error| match error {
            RuntimeError::Device(message) => RuntimeError::Shader(message),
            other => other,
        })
    }
}
