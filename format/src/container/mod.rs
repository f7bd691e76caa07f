//! The outer form of a file: header, section table, the names of sections, and the issues that
//! everything above reports. Knows no record.

pub(crate) mod directory;
pub(crate) mod error;
pub(crate) mod header;
pub(crate) mod issue;
pub(crate) mod layout;
pub(crate) mod limits;
pub(crate) mod section;
pub(crate) mod tag;
pub(crate) mod words;
