//! Every sample drawing of `tests/data/svg`, baked and held against resvg: the cells alone, the
//! mips in their place, and the GPU against the evaluator's Rust twin.
//!
//! A case is an `.svg`; a `.toml` of the same name beside it gives its own bounds, with a reason:
//!
//! ```toml
//! reason = "why the usual bounds do not hold"
//! min_cells_db = 25.0        # bound of the check `cells`, dB
//! min_mips_db = 25.0         # bound of the check `mips`, dB
//! fails = ["cells"]          # checks that are known to fail and must do so
//! ```

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use libtest_mimic::{Arguments, Failed, Trial};
use vtex_baker::{BakeConfig, Resources};
use vtex_format::{Limits, VtexFile, validate};
use vtex_runtime::{BatchQuery, Gpu};
use vtex_shaders::cpu;
use vtex_truth::picture::{Picture, Shot, View, difference, fit_size, hash};
use vtex_truth::reference::{Edges, Reference};
use vtex_truth::texture::{FilterMode, Shooter, canvas_options};

/// Pixels of the longer side of all pictures.
const LONGER_PX: u32 = 128;
/// Samples a pixel.
const SPP: u32 = 16;
/// Bounds in dB. 16 stratified samples a pixel alone leave about 40 dB on drawings of this kind.
const MIN_CELLS_DB: f64 = 36.0;
const MIN_MIPS_DB: f64 = 36.0;
/// Lookups compared between GPU and twin in each case and filter mode.
const PARITY_LOOKUPS: u32 = 20_000;
/// Largest difference of a channel, linear light, that counts as equal.
const PARITY_TOLERANCE: f32 = 2.0 / 255.0;
/// Lookups of point mode that may differ more: points on an edge to the last bit of an f32.
const PARITY_FLIPS: usize = 2;

fn main() {
    let arguments = Arguments::from_args();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/svg");
    let mut trials = Vec::new();
    for path in svg_files(&root) {
        let name = path.strip_prefix(&root).unwrap_or(&path).with_extension("");
        let name = name.to_string_lossy().replace('\\', "/");
        let case = Arc::new(Case::new(path));
        let mut add = |check: &'static str, run: fn(&Case) -> Result<(), Failed>| {
            let case = Arc::clone(&case);
            trials.push(Trial::test(format!("{check}::{name}"), move || {
                case.expect(check, run)
            }));
        };
        add("file", Case::file);
        add("cells", Case::cells);
        add("mips", Case::mips);
        add("gpu", Case::gpu);
    }
    assert!(trials.len() > 200, "the sample drawings are missing");
    libtest_mimic::run(&arguments, trials).exit();
}

/// Drawings below a folder; those of a chapter with a table are the suite `cases`'s.
fn svg_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    if folder.join("cases.tsv").exists() {
        return files;
    }
    let entries = fs::read_dir(folder).into_iter().flatten();
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        if path.is_dir() {
            files.extend(svg_files(&path));
        } else if path.extension().is_some_and(|ext| ext == "svg") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// A case's own bounds.
#[derive(Default, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Sidecar {
    reason: String,
    min_cells_db: Option<f64>,
    min_mips_db: Option<f64>,
    #[serde(default)]
    fails: Vec<String>,
}

/// What all checks of a case share.
struct Baked {
    bytes: Vec<u8>,
    file: VtexFile,
    truth: Picture,
}

struct Case {
    path: PathBuf,
    baked: OnceLock<Result<Baked, String>>,
}

impl Case {
    fn new(path: PathBuf) -> Self {
        Self {
            path,
            baked: OnceLock::new(),
        }
    }

    fn sidecar(&self) -> Result<Sidecar, Failed> {
        let path = self.path.with_extension("toml");
        let Ok(text) = fs::read_to_string(&path) else {
            return Ok(Sidecar::default());
        };
        let sidecar: Sidecar = toml::from_str(&text)?;
        match sidecar.reason.len() {
            0..20 => Err(format!("{}: a reason is needed", path.display()).into()),
            _ => Ok(sidecar),
        }
    }

    /// Runs a check; one that is declared to fail must fail.
    fn expect(&self, check: &str, run: fn(&Self) -> Result<(), Failed>) -> Result<(), Failed> {
        let declared = self.sidecar()?.fails.iter().any(|name| name == check);
        match (declared, run(self)) {
            (true, Ok(())) => Err("declared to fail, but passes: drop it from the sidecar".into()),
            (true, Err(_)) => Ok(()),
            (false, outcome) => outcome,
        }
    }

    fn baked(&self) -> Result<&Baked, Failed> {
        let baked = self.baked.get_or_init(|| self.bake());
        baked
            .as_ref()
            .map_err(|message| Failed::from(message.as_str()))
    }

    fn bake(&self) -> Result<Baked, String> {
        let svg = fs::read(&self.path).map_err(|error| error.to_string())?;
        let observer = |_| ();
        let config = BakeConfig::default();
        let file = vtex_baker::bake_observed(&svg, &config, &Resources::default(), &observer)
            .map_err(|error| error.to_string())?;
        let bytes = file.to_bytes().map_err(|error| error.to_string())?;
        let reference = Reference::parse(&svg, Arc::default(), Edges::Crisp)?;
        let size_px = fit_size(reference.canvas_size(), LONGER_PX);
        let truth = reference
            .render(View::WHOLE, size_px)
            .map_err(|failure| failure.to_string())?;
        Ok(Baked { bytes, file, truth })
    }

    /// The file is valid and reads back as it was.
    fn file(&self) -> Result<(), Failed> {
        let baked = self.baked()?;
        let issues = validate(&baked.bytes, &Limits::default());
        if let Some(issue) = issues.first() {
            return Err(format!("{} issues, the first: {issue}", issues.len()).into());
        }
        let again = VtexFile::parse(&baked.bytes, &Limits::default())?;
        if again != baked.file {
            return Err("the file does not read back as it was".into());
        }
        Ok(())
    }

    /// Point lookups without footprint, which never see the mips.
    fn cells(&self) -> Result<(), Failed> {
        let baked = self.baked()?;
        let words = vtex_shaders::pack(&baked.file, &canvas_options(FilterMode::Point));
        let sampler = cpu::Sampler::new(&words);
        let picture = shot(baked).shoot(|uv, _| sampler.sample(uv, [0.0; 4]));
        bounded(
            baked,
            &picture,
            self.sidecar()?.min_cells_db.unwrap_or(MIN_CELLS_DB),
        )
    }

    /// Lookups with their footprint, which at this size see mip 0 only.
    fn mips(&self) -> Result<(), Failed> {
        let baked = self.baked()?;
        let words = vtex_shaders::pack(&baked.file, &canvas_options(FilterMode::Point));
        let picture = Shooter::Cpu { words }.shoot(shot(baked))?;
        bounded(
            baked,
            &picture,
            self.sidecar()?.min_mips_db.unwrap_or(MIN_MIPS_DB),
        )
    }

    /// The batch kernel and the twin agree on random lookups with footprints of all sizes.
    fn gpu(&self) -> Result<(), Failed> {
        let Some(gpu) = gpu()? else {
            return Ok(());
        };
        let baked = self.baked()?;
        for filter in [FilterMode::Point, FilterMode::Footprint, FilterMode::Paper] {
            let pack = canvas_options(filter);
            let Shooter::Gpu { sampler } = Shooter::on_gpu(gpu, &baked.file, pack)? else {
                return Err("no batch sampler".into());
            };
            let words = vtex_shaders::pack(&baked.file, &pack);
            let twin = cpu::Sampler::new(&words);
            let queries: Vec<_> = (0..PARITY_LOOKUPS).map(query).collect();
            let colors = sampler.sample(&queries)?;
            let wrong: Vec<_> = queries
                .iter()
                .zip(&colors)
                .filter(|(query, color)| {
                    let expected = twin.sample(query.uv, query.footprint);
                    expected
                        .iter()
                        .zip(*color)
                        .any(|(a, b)| (a - b).is_nan() || (a - b).abs() > PARITY_TOLERANCE)
                })
                .collect();
            let allowed = if filter == FilterMode::Point {
                PARITY_FLIPS
            } else {
                0
            };
            if let Some((query, color)) = wrong.first().filter(|_| wrong.len() > allowed) {
                let count = wrong.len();
                let expected = twin.sample(query.uv, query.footprint);
                let message = format!(
                    "{filter:?}: {count} differ; {query:?}: GPU {color:?}, twin {expected:?}"
                );
                return Err(message.into());
            }
        }
        Ok(())
    }
}

fn shot(baked: &Baked) -> Shot {
    Shot {
        view: View::WHOLE,
        size_px: baked.truth.size_px,
        spp: SPP,
    }
}

fn bounded(baked: &Baked, picture: &Picture, bound_db: f64) -> Result<(), Failed> {
    let found = difference(&baked.truth, picture);
    match found.psnr_db >= bound_db {
        true => Ok(()),
        false => Err(format!("below {bound_db} dB: {found:?}").into()),
    }
}

/// Random lookup `index`: uv a little beyond the canvas, footprints from none to a tenth of it.
fn query(index: u32) -> BatchQuery {
    let random = |lane: u64| {
        let bits = hash(u64::from(index) * 8 + lane) >> 40;
        // 24 bits are exact in f32.
        bits as f32 / 16_777_216.0
    };
    let uv = [random(0), random(1)].map(|r| r * 1.02 - 0.01);
    let size = if index.is_multiple_of(3) {
        0.0
    } else {
        0.1 * random(2).powi(6)
    };
    let turn = random(3) * std::f32::consts::TAU;
    let (sin, cos) = turn.sin_cos();
    let footprint = [cos, sin, -sin * random(4), cos * random(4)].map(|axis| axis * size);
    BatchQuery {
        uv,
        padding: [0.0; 2],
        footprint,
    }
}

/// The GPU; `None` when `VTEX_GPU=off` says that there need not be one.
fn gpu() -> Result<Option<&'static Gpu>, Failed> {
    static GPU: OnceLock<Result<Gpu, String>> = OnceLock::new();
    if std::env::var_os("VTEX_GPU").is_some_and(|value| value == "off") {
        return Ok(None);
    }
    let gpu = GPU.get_or_init(|| Gpu::headless().map_err(|error| error.to_string()));
    match gpu {
        Ok(gpu) => Ok(Some(gpu)),
        Err(message) => Err(format!("{message} (VTEX_GPU=off skips GPU checks)").into()),
    }
}
