//! Futures of what a device answers later, and the loop that waits for them.

use std::pin::pin;
#[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
use std::task::{Context, Poll, Waker};

use futures_channel::oneshot;
use wgpu::Device;

use crate::RuntimeError;

/// Calls `ask` with the sender that a callback of wgpu is to use, and waits for what it sends.
///
/// # Errors
/// [`RuntimeError::Device`] when the callback is dropped instead of called, as a device that is
/// lost may do.
pub(super) async fn reply<T>(
    device: &Device,
    ask: impl FnOnce(oneshot::Sender<T>),
) -> Result<T, RuntimeError> {
    let (sender, receiver) = oneshot::channel();
    ask(sender);
    let mut receiver = pin!(receiver);
    std::future::poll_fn(|context| {
        // A browser calls callbacks from its own event loop. Elsewhere they run inside
        // `Device::poll`, which nobody else may ever call.
        if cfg!(not(target_arch = "wasm32")) {
            device
                .poll(wgpu::PollType::Poll)
                .map_err(|error| RuntimeError::Device(error.to_string()))?;
        }
        let answer = receiver.as_mut().poll(context);
        if answer.is_pending() && cfg!(not(target_arch = "wasm32")) {
            // No callback runs until the next `Device::poll`, so ask for another turn.
            context.waker().wake_by_ref();
        }
        answer.map_err(|_| {
            let what = "dropped a request; it may be lost";
            RuntimeError::Device(what.to_owned())
        })
    })
    .await
}

/// Ends when the device has done everything that was submitted to `queue` so far.
#[cfg(feature = "tracer")]
pub(crate) async fn submitted_work(
    device: &Device,
    queue: &wgpu::Queue,
) -> Result<(), RuntimeError> {
    let ask = |done: oneshot::Sender<()>| {
        // Nobody listens any more when the future was dropped.
        queue.on_submitted_work_done(move || {
            let _ = done.send(());
        });
    };
    reply(device, ask).await
}

/// Runs `work` to its end on this thread. Whenever it cannot go on it waits for an answer of
/// `device`, so the thread sleeps until the device has done all that was submitted.
#[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
pub(crate) fn block_on<T>(
    device: &Device,
    work: impl Future<Output = Result<T, RuntimeError>>,
) -> Result<T, RuntimeError> {
    let mut work = pin!(work);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(result) = work.as_mut().poll(&mut context) {
            return result;
        }
        // Another thread that polls the same device may have taken the callback and not yet run
        // it: then this returns at once and the loop turns until it has.
        device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|error| RuntimeError::Device(error.to_string()))?;
    }
}
