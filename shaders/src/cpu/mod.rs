//! The evaluator's Rust twin.

pub mod curve;
