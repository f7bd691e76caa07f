//! What is measured: one file for each table or group of tables.

mod answers;
mod isa;
mod load;
mod lookups;
mod parity;
mod processes;
mod rays;
mod rivals;
mod set;
mod sfg22;
mod sizes;
mod stages;

pub(crate) use answers::answers_table;
pub(crate) use isa::add_isa_tables;
pub(crate) use load::load_table;
pub(crate) use lookups::{count_table, cpu_tables, gpu_tables};
pub(crate) use parity::parity_table;
pub(crate) use processes::{process_tables, rasterise_to_png};
pub(crate) use rays::{rays_table, staged_tables};
pub(crate) use rivals::{check_queries, fetch_table, minified_table, sfg22_table};
pub(crate) use set::set_tables;
pub(crate) use sizes::size_tables;
pub(crate) use stages::stages_table;

use crate::report::Cell;
use crate::subject::Subject;
use crate::timing::{Spread, Timing};

/// A cell for each of the timings of one [`Effort::interleave`](crate::timing::Effort::interleave),
/// with its ratio to the first.
fn compared(timings: &[Timing], value: fn(&Timing) -> Spread) -> impl Iterator<Item = Cell> {
    let cell = move |(index, timing): (usize, &Timing)| Cell::Measured {
        value: value(timing),
        ratio: (index > 0).then(|| timing.speed_against(&timings[0])),
    };
    timings.iter().enumerate().map(cell)
}

/// A note about the files for which the time did not suffice.
fn left_out<'a>(subjects: impl IntoIterator<Item = &'a Subject>) -> String {
    let names = subjects.into_iter().map(|subject| subject.name.as_str());
    let names: Vec<&str> = names.collect();
    format!("Left out for lack of time: {}.", names.join(", "))
}
