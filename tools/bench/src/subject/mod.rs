//! One SVG file to measure with: baked, and as the raster texture that it replaces.

mod bands;
mod bc7;
pub(crate) mod ktx2;
mod raster;
mod rasterise;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use anyhow::{Context as _, Result};
use vtex_baker::{BakeConfig, Resources};
use vtex_format::{Image, VtexFile};
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{FilterMode, FootprintSamples, PackOptions, Packed, pack};
use vtex_testing::corpus;

use crate::timing::{QuerySet, Screen};

use bands::Bands;
use bc7::{BC7_SIDE_MULTIPLE, Bc7};

pub(crate) use bc7::BC7_SIZES;
pub(crate) use raster::{CpuRaster, RASTER_SIZE, halves_kernel, hardware_kernel, synthetic};
pub(crate) use rasterise::{
    level_count, level_size, parse, rasterise, rasterise_in_blocks, render,
};

/// Points along each side of a window at which its cost is probed.
const PROBES: u16 = 24;

/// The filter modes with the names that columns use.
pub(crate) const FILTERS: [(&str, FilterMode); 3] = [
    ("point", FilterMode::Point),
    ("footprint", FilterMode::Footprint),
    ("paper", FilterMode::Paper),
];

/// Ways of looking up, with the names that columns use: the filter modes, and footprints of fewer
/// samples.
pub(crate) fn modes() -> [(&'static str, PackOptions); 5] {
    let few = |samples| PackOptions {
        samples,
        ..filtered(FilterMode::Footprint)
    };
    let [point, footprint, paper] = FILTERS.map(|(name, filter)| (name, filtered(filter)));
    [
        point,
        footprint,
        ("footprint, 16", few(FootprintSamples::Sixteen)),
        ("footprint, 8", few(FootprintSamples::Eight)),
        paper,
    ]
}

/// The defaults with a filter mode.
pub(crate) fn filtered(filter: FilterMode) -> PackOptions {
    PackOptions {
        filter,
        ..PackOptions::default()
    }
}

/// One SVG with its bake and its raster texture.
#[derive(Debug)]
pub(crate) struct Subject {
    /// File name without its ending.
    pub(crate) name: String,
    /// Baked with the defaults.
    pub(crate) file: VtexFile,
    /// The same drawing with mips at [`RASTER_SIZE`], its sides rounded for BC7.
    pub(crate) raster: Image,
    /// Its outlines for the loop over curves of bands.
    pub(crate) bands: Bands,
    /// Made when a table asks for it.
    bc7: OnceLock<Bc7>,
    screen: Screen,
    busy_corner: [f32; 2],
}

impl Subject {
    /// Reads, bakes and rasterises a file.
    pub(crate) fn bake(path: &Path, resources: &Resources) -> Result<Self> {
        let name = name(path);
        let file = bake(path, resources)?;
        let fail = || format!("cannot rasterise {name}");
        let tree = parse(&read(path)?, resources).with_context(fail)?;
        let raster =
            rasterise_in_blocks(&tree, RASTER_SIZE, BC7_SIDE_MULTIPLE).with_context(fail)?;
        let screen = Screen::new(file.meta.canvas_size);
        let busy_corner = busiest(&file, screen);
        Ok(Self {
            name,
            file,
            raster,
            bands: Bands::of(&tree),
            bc7: OnceLock::new(),
            screen,
            busy_corner,
        })
    }

    /// The query sets of the lookup tables: 8x all over the canvas, 8x where lookups cost most, the
    /// whole canvas at 1x, and 8x at random points.
    pub(crate) fn query_sets(&self, lookups: usize) -> [QuerySet; 4] {
        [
            self.screen.tour(lookups),
            self.screen.close(self.busy_corner, lookups),
            self.screen.whole(lookups),
            self.screen.scattered(lookups),
        ]
    }

    /// The raster in BC7.
    pub(crate) fn bc7(&self) -> &Bc7 {
        self.bc7.get_or_init(|| Bc7::encode(&self.raster))
    }

    /// Words and texels.
    pub(crate) fn packed(&self, options: &PackOptions) -> Packed {
        pack(&self.file, options)
    }
}

/// Reads and bakes a file with the defaults.
pub(crate) fn bake(path: &Path, resources: &Resources) -> Result<VtexFile> {
    let config = BakeConfig::default();
    vtex_baker::bake_observed(&read(path)?, &config, resources, &|_| ())
        .with_context(|| format!("cannot bake {}", path.display()))
}

/// The system's fonts, for drawings with text.
pub(crate) fn system_fonts() -> Resources {
    let mut fonts = resvg::usvg::fontdb::Database::new();
    fonts.load_system_fonts();
    Resources {
        fonts: Arc::new(fonts),
        ..Resources::default()
    }
}

/// File name without its ending.
pub(crate) fn name(path: &Path) -> String {
    path.file_stem()
        .unwrap_or(path.as_os_str())
        .to_string_lossy()
        .into_owned()
}

/// Reads a file and says which when it cannot.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}

/// `named`, or the default samples; never none.
#[expect(clippy::print_stderr, reason = "a tool talks to its user")]
pub(crate) fn find(named: &[PathBuf]) -> Result<Vec<PathBuf>> {
    if !named.is_empty() {
        return Ok(named.to_owned());
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut files = svg_files(&root.join("tests/data/svg/paper"));
    match corpus::folder().map_err(anyhow::Error::msg)? {
        Some(corpus) => files.extend(svg_files(&corpus.join("paper5"))),
        None => eprintln!("no corpus: only the project's own samples are measured"),
    }
    anyhow::ensure!(!files.is_empty(), "no samples found; name SVG files");
    Ok(files)
}

/// SVG files of a folder by name; none when it cannot be listed.
fn svg_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    let mut paths: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|ending| ending == "svg"))
        .collect();
    paths.sort();
    paths
}

/// Corner of the 8x window whose lookups visit the most entries and segments; the first of equals.
fn busiest(file: &VtexFile, screen: Screen) -> [f32; 2] {
    let packed = pack(file, &PackOptions::default());
    let sampler = Sampler::new(&packed);
    let cost = |corner: &[f32; 2]| {
        let set = screen.close(*corner, 1);
        let [width, height] = set.extent_uv();
        let probe = |i: u16| {
            let at = |k: u16| (f32::from(k) + 0.5) / f32::from(PROBES);
            [
                corner[0] + at(i % PROBES) * width,
                corner[1] + at(i / PROBES) * height,
            ]
        };
        let walked = |uv| {
            let cost = sampler.cost(uv, [0.0; 4]);
            cost.entries + cost.segments
        };
        (0..PROBES * PROBES).map(probe).map(walked).sum::<u32>()
    };
    let corners: Vec<[f32; 2]> = screen.close_corners().collect();
    let best = corners.iter().rev().max_by_key(|corner| cost(corner));
    best.copied().unwrap_or_default()
}
