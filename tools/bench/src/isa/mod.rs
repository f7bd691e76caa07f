//! What shaders cost on instruction sets: which shaders, and the process that compiles them.

mod kernels;
mod process;

pub(crate) use kernels::{Kernel, fragment_and_tracer, named, of_files};
pub(crate) use process::{Chip, Compiled, measure, serve};
