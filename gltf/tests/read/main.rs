//! Assets that load, and assets that must not bring the reader down.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod attached;
mod bad;
mod builder;
mod good;
