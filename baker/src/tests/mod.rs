//! Tests of whole bakes. Tests of one noun are beside it.

mod corpus;
mod curve_cells;
mod emptiness;
mod gradients;
mod pictures;
mod profiles;
