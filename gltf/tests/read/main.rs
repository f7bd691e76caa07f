//! Assets that load, and assets that must not bring the reader down.

mod attached;
mod bad;
mod builder;
mod good;
