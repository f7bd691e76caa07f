//! SVG to a [`Plan`]: what is geometry already, and what resvg has to paint.

mod cost;
mod path;
mod plan;
mod source;
mod walk;

pub(crate) use cost::Cost;
pub(crate) use plan::{Plan, Step, Subtree};
pub use source::font_selector;
pub(crate) use source::parse;
pub(crate) use walk::{WalkOptions, plan};
