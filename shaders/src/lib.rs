//! The vtex evaluator: WGSL in `wgsl/`, its Rust twin in [`cpu`], and the linker that makes the
//! specialised text from a [`vtex_format::SpecKey`].
//!
//! Both sides read the same packed words ([`pack`]), so a lookup on the CPU and on the GPU walks
//! the same numbers.

pub mod cpu;
pub mod layout;
