//! Futures of what a device answers later, and the loop that waits for them.

use std::mem;
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};

use wgpu::Device;

use crate::RuntimeError;

/// One answer on its way from a callback of wgpu to the future that waits for it.
#[derive(Debug)]
enum Slot<T> {
    /// Not yet given; whom to wake then.
    Open(Option<Waker>),
    /// Given, not yet taken.
    Given(T),
    /// Taken, or never to be given.
    Closed,
}

/// The callback's end. A device that is lost may drop a callback instead of calling it; then the
/// other end gets an error instead of waiting for ever.
#[derive(Debug)]
pub(super) struct Promise<T> {
    slot: Arc<Mutex<Slot<T>>>,
}

/// The future's end.
#[derive(Debug)]
pub(super) struct Reply<T> {
    device: Device,
    slot: Arc<Mutex<Slot<T>>>,
}

/// Both ends of an answer that `device` will give.
pub(super) fn reply<T>(device: &Device) -> (Promise<T>, Reply<T>) {
    let slot = Arc::new(Mutex::new(Slot::Open(None)));
    let promise = Promise {
        slot: Arc::clone(&slot),
    };
    let device = device.clone();
    (promise, Reply { device, slot })
}

/// A panic elsewhere leaves the slot whole: each change is a single assignment.
fn locked<T>(slot: &Mutex<Slot<T>>) -> MutexGuard<'_, Slot<T>> {
    slot.lock().unwrap_or_else(PoisonError::into_inner)
}

impl<T> Promise<T> {
    /// Gives the answer.
    pub(super) fn keep(self, answer: T) {
        self.fill(Slot::Given(answer));
    }

    fn fill(&self, with: Slot<T>) {
        let mut slot = locked(&self.slot);
        if let Slot::Open(waker) = &mut *slot {
            let waker = waker.take();
            *slot = with;
            // The lock is released first: the woken task may be polled at once.
            drop(slot);
            if let Some(waker) = waker {
                waker.wake();
            }
        }
    }
}

impl<T> Drop for Promise<T> {
    /// Does nothing after [`Promise::keep`].
    fn drop(&mut self) {
        self.fill(Slot::Closed);
    }
}

impl<T> Future for Reply<T> {
    type Output = Result<T, RuntimeError>;

    fn poll(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Self::Output> {
        // A browser calls callbacks from its own event loop. Elsewhere they run inside
        // `Device::poll`, which nobody else may ever call; before the lock, which they take.
        if cfg!(not(target_arch = "wasm32")) {
            self.device
                .poll(wgpu::PollType::Poll)
                .map_err(|error| RuntimeError::Device(error.to_string()))?;
        }
        let mut slot = locked(&self.slot);
        match mem::replace(&mut *slot, Slot::Closed) {
            Slot::Given(answer) => Poll::Ready(Ok(answer)),
            Slot::Closed => {
                let what = "dropped a request; it may be lost";
                Poll::Ready(Err(RuntimeError::Device(what.to_owned())))
            }
            Slot::Open(_) => {
                *slot = Slot::Open(Some(context.waker().clone()));
                if cfg!(not(target_arch = "wasm32")) {
                    // No callback runs until the next `Device::poll`, so ask for another turn.
                    context.waker().wake_by_ref();
                }
                Poll::Pending
            }
        }
    }
}

/// Ends when the device has done everything that was submitted to `queue` so far.
#[cfg(feature = "tracer")]
pub(crate) async fn submitted_work(
    device: &Device,
    queue: &wgpu::Queue,
) -> Result<(), RuntimeError> {
    let (promise, reply) = reply(device);
    queue.on_submitted_work_done(move || promise.keep(()));
    reply.await
}

/// Runs `work` to its end on this thread. Whenever it cannot go on it waits for an answer of
/// `device`, so the thread sleeps until the device has done all that was submitted.
#[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
pub(crate) fn block_on<T>(
    device: &Device,
    work: impl Future<Output = Result<T, RuntimeError>>,
) -> Result<T, RuntimeError> {
    let mut work = std::pin::pin!(work);
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
