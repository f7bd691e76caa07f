//! What the tests of this crate share: drawings, random outlines, a plain evaluator, exact
//! pictures.

mod drawings;
mod evaluator;
mod random;

pub(crate) use drawings::{closed, drawing_of, paint_at, shape, solid, stored_at};
pub(crate) use evaluator::{Evaluator, paint_exactly, psnr, render, under, write_png};
pub(crate) use random::{Random, random_outline};
