//! Support of the test suites: comparing lookups, an adapter to run on, fonts, random textures, random numbers.
//!
//! Functions here panic when something is wrong: they run inside tests.

pub mod clips_and_groups;
pub mod fixture;
pub mod fonts;
pub mod gpu;
pub mod hostile;
pub mod parity;
pub mod random;
pub mod variants;
