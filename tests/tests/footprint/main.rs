//! What footprint lookups are for: pages with one lookup a pixel, and shapes that abut.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod pages;
mod seams;
