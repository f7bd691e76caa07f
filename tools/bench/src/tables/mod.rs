//! What is measured: one file for each table or group of tables.

mod answers;
mod isa;
mod load;
mod lookups;
mod parity;
mod processes;
mod rays;
mod rivals;
mod sfg22;
mod sizes;
mod stages;

pub(crate) use answers::answers_table;
pub(crate) use isa::add_isa_tables;
pub(crate) use load::load_table;
pub(crate) use lookups::{count_table, cpu_tables, gpu_tables};
pub(crate) use parity::parity_table;
pub(crate) use processes::{process_tables, rasterise_to_png};
pub(crate) use rays::rays_table;
pub(crate) use rivals::{check_queries, fetch_table, minified_table, sfg22_table};
pub(crate) use sizes::size_tables;
pub(crate) use stages::stages_table;

use crate::subject::Subject;

/// A note about the files for which the time did not suffice.
fn left_out<'a>(subjects: impl IntoIterator<Item = &'a Subject>) -> String {
    let names = subjects.into_iter().map(|subject| subject.name.as_str());
    let names: Vec<&str> = names.collect();
    format!("Left out for lack of time: {}.", names.join(", "))
}
