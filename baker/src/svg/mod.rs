//! From SVG text to a [`Plan`]: shapes in painter's order, and subtrees that resvg has to paint.
//!
//! [`source`] turns bytes into usvg's tree, within limits. [`walk`] goes through the tree.

mod cost;
mod path;
mod plan;
mod source;
mod walk;

pub(crate) use cost::Cost;
pub(crate) use plan::{Plan, PlanItem, Subtree};
pub(crate) use source::parse;
pub use source::{font_selector, styled_text};
pub(crate) use walk::{WalkOptions, plan};
