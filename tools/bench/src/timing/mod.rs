//! What times: the clock, the GPU device, the lookups that every rival answers, the machine.

mod clock;
mod device;
mod machine;
mod queries;

pub(crate) use clock::{Effort, Spread, Timing, Trial, interleave};
pub(crate) use device::{Device, Kernel};
pub(crate) use machine::{Machine, load_average};
pub(crate) use queries::{QuerySet, Screen, random_queries};
