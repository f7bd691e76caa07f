//! What a shader costs on a real instruction set: compiles it with a Vulkan driver and asks the
//! driver for its statistics. Nothing is run, so the driver may be one for a chip that is not
//! there, such as Mesa's RADV with `RADV_FORCE_FAMILY`.
//!
//! ```no_run
//! let compiler = vtex_isa::Compiler::open()?;
//! let wgsl = "@compute @workgroup_size(64) fn nothing() {}";
//! for statistic in compiler.compile(wgsl)?.statistics {
//!     println!("{}: {}", statistic.name, statistic.value);
//! }
//! # Ok::<(), vtex_isa::Error>(())
//! ```

mod shader;
mod vulkan;

use std::time::Duration;

pub use vulkan::Compiler;

/// Why there are no figures.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The Vulkan loader is missing.
    #[error("no Vulkan loader: {0}")]
    Loader(String),
    /// The loader has no driver, or the driver has no device.
    #[error("no Vulkan device")]
    Device,
    /// The driver keeps its statistics to itself.
    #[error("the driver of {0} does not offer VK_KHR_pipeline_executable_properties")]
    Statistics(String),
    /// The shader is not for this crate, or is none at all.
    #[error("{0}")]
    Shader(String),
    /// A call failed.
    #[error("{call}: {result}")]
    Vulkan {
        /// The call's name.
        call: &'static str,
        /// As Vulkan names it.
        result: String,
    },
}

/// A compiled shader.
#[derive(Clone, Debug, PartialEq)]
pub struct Compiled {
    /// What the driver took from SPIR-V to machine code.
    pub time: Duration,
    /// In the driver's order.
    pub statistics: Vec<Statistic>,
}

/// One figure of a driver.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistic {
    /// As the driver calls it.
    pub name: String,
    /// A truth value is 0 or 1.
    pub value: f64,
}
