//! Tests of whole bakes.

mod corpus;
mod curve_cells;
mod gradients;
mod pictures;
