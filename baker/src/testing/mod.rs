//! What the crate's own tests share: drawings, a brute-force painter and a plain evaluator.

mod drawings;
mod evaluator;
mod random;

pub(crate) use drawings::{drawing_of, paint_at, shape, solid, stored_at};
pub(crate) use evaluator::{Evaluator, paint_exactly, psnr, render, under, write_png};
pub(crate) use random::{Random, random_outline};
