//! The rules a value must keep to be written, and a file's content to be read: one module a
//! subject.

mod cells;
mod images;
mod meta;
mod paints;
mod prov;
mod shapes;
mod spec;

use crate::container::issue::Issues;
use crate::file::texture::VtexFile;

pub(crate) use images::image_records;
pub(crate) use meta::meta;

/// Checks a whole value.
pub(crate) fn file(file: &VtexFile, issues: &mut Issues) {
    // Without sound settings the lengths of cells and tiles mean nothing.
    if meta(&file.meta, issues) {
        content(file, issues);
        meta::sources(file, issues);
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
    let bounds = cells::cells(file, issues);
    spec::spec(file, bounds, issues);
    if let Some(provenance) = &file.provenance {
        prov::provenance(provenance, file.shapes.len(), issues);
    }
}
