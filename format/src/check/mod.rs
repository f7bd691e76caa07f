//! The rules a value must keep to be written, and a file's content to be read: one module a
//! subject.

mod cells;
pub(crate) mod images;
mod meta;
mod paints;
mod prov;
mod shapes;
mod spec;

use crate::container::issue::{Issue, Issues};
use crate::file::texture::VtexFile;

pub(crate) use meta::meta;

impl VtexFile {
    /// Everything wrong with the value, up to 256 issues; what `VtexFile::parse` returns has
    /// none.
    pub fn check(&self) -> Vec<Issue> {
        let mut issues = Issues::default();
        file(self, &mut issues);
        issues.into_vec()
    }
}

/// Checks a whole value.
pub(crate) fn file(file: &VtexFile, issues: &mut Issues) {
    // Without sound settings the lengths of cells and tiles mean nothing.
    if meta(&file.meta, issues) {
        content(file, issues);
        // Not part of `content`: a reader has just made the records from the outlines.
        meta::outlines(file, issues);
    }
}

/// Checks a value whose settings are known to be sound.
pub(crate) fn content(file: &VtexFile, issues: &mut Issues) {
    paints::paints(file, issues);
    meta::outline_paint(file, issues);
    meta::curve_lattice(file, issues);
    shapes::shapes(file, issues);
    shapes::layers(file, issues);
    images::images(file, issues);
    images::tiles(file, issues);
    let tables = cells::Tables::of(file);
    cells::entries(file, &tables, issues);
    cells::cells(file, issues);
    spec::spec(file, issues);
    if let Some(provenance) = &file.provenance {
        prov::provenance(provenance, file.shapes.len(), issues);
    }
}

/// Checks a value of which a reader has left out the lists and what lookups do not need.
pub(crate) fn without_lists(file: &VtexFile, issues: &mut Issues) {
    paints::paints(file, issues);
    meta::outline_paint(file, issues);
    images::images(file, issues);
    images::tiles(file, issues);
    spec::spec(file, issues);
}
