//! The container from outside: what is written can be read, and what is damaged or hostile is
//! refused without a panic and without memory beyond the limits.

#![expect(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]
#![expect(clippy::cast_possible_truncation, reason = "sample numbers are small")]

mod cases;
mod damage;
mod dictionaries;
mod forge;
mod gradients;
mod grouped;
mod keys;
mod outlined;
mod roundtrip;
mod sample;
mod versions;
