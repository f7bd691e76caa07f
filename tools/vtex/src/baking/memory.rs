//! A limit on the memory of this process, set by the process itself.

use crate::cli::{Failure, Outcome};

/// Limits this process to `bytes` of memory, stacks included. An allocation beyond that fails, and
/// Rust aborts the process. Core dumps are switched off, since an abort is expected here.
///
/// # Errors
/// When the system refuses the limit.
#[cfg(unix)]
pub(crate) fn limit(bytes: u64) -> Outcome<()> {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
    // On Linux the "data" limit counts private writable memory: what a bake allocates, but neither
    // font files that are mapped read-only nor address space that the allocator only reserved.
    // On other systems "data" does not count mapped memory, which allocators use, so the whole
    // address space is limited there.
    const MEMORY: Resource = if cfg!(target_os = "linux") {
        Resource::Data
    } else {
        Resource::As
    };
    for (resource, wanted) in [(MEMORY, bytes), (Resource::Core, 0)] {
        let there = getrlimit(resource);
        // A lower limit that the caller has set stays.
        let lower = |limit: Option<u64>| Some(limit.map_or(wanted, |limit| limit.min(wanted)));
        let limit = Rlimit {
            current: lower(there.current),
            maximum: there.maximum,
        };
        setrlimit(resource, limit)
            .map_err(|error| Failure::runtime(format!("cannot limit the memory: {error}")))?;
    }
    Ok(())
}

/// Does nothing: on this system a process cannot limit its own memory.
///
/// # Errors
/// None.
#[cfg(not(unix))]
pub(crate) fn limit(_bytes: u64) -> Outcome<()> {
    Ok(())
}
