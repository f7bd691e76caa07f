//! A bound of the memory this process may take, set by itself.

use crate::cli::{Failure, Outcome};

/// Lets this process take `bytes` in all, stacks included; what asks for more ends it. Also keeps
/// such an end from writing a core dump.
///
/// # Errors
/// When the system refuses the limit.
#[cfg(unix)]
pub(crate) fn limit(bytes: u64) -> Outcome<()> {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
    // Linux counts private writable memory as "data": what a bake allocates, without the fonts
    // that are mapped from files and without the allocator's untouched reserves. Elsewhere "data"
    // leaves mapped memory out, so the address space has to serve.
    const MEMORY: Resource = if cfg!(target_os = "linux") {
        Resource::Data
    } else {
        Resource::As
    };
    for (resource, wanted) in [(MEMORY, bytes), (Resource::Core, 0)] {
        let there = getrlimit(resource);
        // A tighter limit of our caller stays.
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

/// Does nothing: this system has no such limit that a process can set itself.
///
/// # Errors
/// None.
#[cfg(not(unix))]
pub(crate) fn limit(_bytes: u64) -> Outcome<()> {
    Ok(())
}
