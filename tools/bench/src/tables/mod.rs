//! What is measured: one file for each table or group of tables.

mod lookups;
mod processes;
mod rays;
mod rivals;
mod sfg22;
mod sizes;
mod stages;

pub(crate) use lookups::{count_table, cpu_tables, gpu_tables};
pub(crate) use processes::{process_tables, rasterise_to_png};
pub(crate) use rays::rays_table;
pub(crate) use rivals::{check_queries, fetch_table, minified_table, sfg22_table};
pub(crate) use sizes::size_tables;
pub(crate) use stages::stages_table;
