//! Bytes of a file, and of what it replaces.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};
use vtex_baker::{BakeConfig, Resources};
use vtex_format::{BundleInfo, Directory, Limits, Tag, directory};
use vtex_shaders::{PackOptions, pack};

use crate::report::{Cell, Table};
use crate::subject::{RASTER_SIZE, level_count, level_size, name, parse, read, render};

/// Bytes of one MSDF of \[SFG22\]: 512 x 512 texels of three bytes, one a shape.
const SFG22_SHAPE_BYTES: u64 = 512 * 512 * 3;
/// The larger of the two zooms that files are baked for.
const HIGH_ZOOM: f32 = 256.0;

/// Groups of sections, columns of the second table.
const GROUPS: [(&str, &[Tag]); 7] = [
    ("curves", &[Tag::CURV, Tag::OUTL]),
    ("cells", &[Tag::CELL, Tag::ENTR]),
    ("fine cells", &[Tag::FINE]),
    ("tiles", &[Tag::TILE]),
    ("images", &[Tag::IMAG, Tag::MIPS]),
    ("shader", &[Tag::SPEC, Tag::SHDR]),
    (
        "records",
        &[
            Tag::META,
            Tag::PROV,
            Tag::PANT,
            Tag::GRAD,
            Tag::SHAP,
            Tag::LAYR,
        ],
    ),
];

/// Sizes of each file and of its rivals, and sizes of its sections.
pub(crate) fn size_tables(files: &[PathBuf], resources: &Resources) -> Result<Vec<Table>> {
    let raster = format!("raster {RASTER_SIZE}^2");
    let png = format!("{raster} as PNG");
    let mut whole = Table::new(
        "Bytes",
        &[
            "KB (1000 bytes)",
            "shapes",
            "file",
            "unpacked",
            "file, zoom 256",
            "on the GPU",
            "[SFG22]",
            &raster,
            &png,
        ],
    );
    whole.note(
        "Default options, and `--max-zoom 256`. `unpacked`: all sections before zstd. `on the GPU`: packed words and texels for lookups. `[SFG22]`: one MSDF of \
         512 x 512 texels and three bytes a shape, as it is in memory. The raster has four bytes a texel \
         and all mips; its PNG has no mips.",
    );
    let mut columns = vec!["bytes stored (unpacked)"];
    columns.extend(GROUPS.iter().map(|(name, _)| *name));
    columns.extend(["several", "table", "file"]);
    let mut parts = Table::new("Bytes by sections", &columns);
    parts.note(
        "Default options. `several`: bundles of small sections of several kinds. `table`: header and section table.",
    );
    for path in files {
        let sizes = Sizes::of(path, resources)?;
        whole.row(sizes.row());
        parts.row(sizes.section_row());
    }
    Ok(vec![whole, parts])
}

/// Sizes of one file.
struct Sizes {
    name: String,
    shapes: u64,
    file: u64,
    high_zoom: u64,
    packed: u64,
    raster: u64,
    png: u64,
    directory: Directory,
}

impl Sizes {
    fn of(path: &Path, resources: &Resources) -> Result<Self> {
        let name = name(path);
        let svg = read(path)?;
        let fail = || format!("cannot bake {name}");
        let bake = |config: &BakeConfig| -> Result<_> {
            let file = vtex_baker::bake(&svg, config, resources).with_context(fail)?;
            let bytes = file.to_bytes().with_context(fail)?;
            Ok((file, bytes))
        };
        let (file, bytes) = bake(&BakeConfig::default())?;
        let directory = directory(&bytes, &Limits::default())?;
        for section in &directory.sections {
            let tag = section.tag;
            let grouped = GROUPS.iter().any(|(_, tags)| tags.contains(&tag));
            // Else its bytes would be missing from every column.
            ensure!(
                grouped,
                "section {tag} is in no group of the table of sizes"
            );
        }
        let (_, high_zoom) = bake(&BakeConfig {
            max_zoom: HIGH_ZOOM,
            ..BakeConfig::default()
        })?;
        let pixmap = render(&parse(&svg, resources)?, RASTER_SIZE)?;
        let size = [pixmap.width(), pixmap.height()];
        let levels = 0..level_count(size);
        Ok(Self {
            shapes: file.shapes.len() as u64,
            file: bytes.len() as u64,
            high_zoom: high_zoom.len() as u64,
            packed: pack(&file, &PackOptions::default()).bytes() as u64,
            raster: levels.map(|level| level_bytes(size, level)).sum(),
            png: pixmap.encode_png().context("cannot encode a PNG")?.len() as u64,
            directory,
            name,
        })
    }

    fn row(&self) -> Vec<Cell> {
        let kilobytes = |bytes: u64| Cell::Number(bytes as f64 / 1000.0, 1);
        let whole = |bytes: u64| Cell::Number(bytes as f64 / 1000.0, 0);
        vec![
            Cell::Text(self.name.clone()),
            Cell::Number(self.shapes as f64, 0),
            kilobytes(self.file),
            whole(self.directory.bundles.iter().map(|b| b.raw_bytes).sum()),
            kilobytes(self.high_zoom),
            whole(self.packed),
            whole(SFG22_SHAPE_BYTES * self.shapes),
            whole(self.raster),
            whole(self.png),
        ]
    }

    fn section_row(&self) -> Vec<Cell> {
        let mut cells = vec![Cell::Text(self.name.clone())];
        let bundles = &self.directory.bundles;
        let mut column = |wanted: Option<usize>| {
            let group = || bundles.iter().filter(|bundle| self.group(bundle) == wanted);
            let stored: u64 = group().map(|bundle| bundle.stored_bytes).sum();
            let raw: u64 = group().map(|bundle| bundle.raw_bytes).sum();
            cells.push(Cell::Text(format!("{stored} ({raw})")));
        };
        (0..GROUPS.len()).map(Some).for_each(&mut column);
        column(None);
        let stored: u64 = bundles.iter().map(|bundle| bundle.stored_bytes).sum();
        cells.push(Cell::Number((self.file - stored) as f64, 0));
        cells.push(Cell::Number(self.file as f64, 0));
        cells
    }
}

impl Sizes {
    /// The group that all sections of a bundle belong to.
    fn group(&self, bundle: &BundleInfo) -> Option<usize> {
        let sections = self.directory.bundle_sections(bundle);
        GROUPS
            .iter()
            .position(|(_, tags)| sections.iter().all(|section| tags.contains(&section.tag)))
    }
}

fn level_bytes(size: [u32; 2], level: u32) -> u64 {
    let [width, height] = level_size(size, level).map(u64::from);
    4 * width * height
}
