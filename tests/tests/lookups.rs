//! Point lookups, twin and GPU, against the brute-force oracle: random places of whole pictures.
//!
//! `cargo test` takes 20,000 places of the project's own drawings and of a dozen of the corpus.
//! With `VTEX_SLOW=1` it takes `VTEX_POINTS` (default 1,000,000) of every solid drawing of the
//! corpus named by `VTEX_CORPUS`, those whose path contains `VTEX_FILTER` if that is set, and
//! writes `lookups.csv` to the folder named by `VTEX_REPORT`. A tenth as many places more lie at
//! heights of corners.

#![expect(clippy::print_stdout, reason = "the figures are wanted")]
#![expect(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use vtex_baker::{BakeConfig, Resources, bake, oracle::Oracle};
use vtex_format::VtexFile;
use vtex_runtime::{BatchQuery, BatchSampler, FilterMode, Gpu, LoadOptions, Trust};
use vtex_shaders::{PackOptions, cpu, pack};
use vtex_testing::{Corpus, slow_only};
use vtex_tests::random::Random;

/// A lookup may fall on the other side of an edge that is this near, in units of the curve lattice:
/// f32 coordinates of 64 cells move it by up to 0.4, cuts at cells the outline by up to 0.5. (Lines
/// in place of flat quadratics may add to that, up to 1.25 at `max_zoom` 256; of 158 million lookups
/// in 144 drawings none that differed was further off than 0.62.)
const BAND_UNITS: f64 = 1.0;
/// How far from an edge a mismatch is still given a distance.
const REACH_UNITS: f64 = 64.0;
/// Colours that differ by less are equal: f32 composites of a few hundred translucent paints.
const SAME_COLOR: f32 = 2e-4;

/// What lookups were compared with, and how they fared.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    /// Other colour than the oracle's, further than [`BAND_UNITS`] from any edge.
    wrong: usize,
    /// Other colour, nearer: of the places all over the canvas, and of those at heights of corners.
    near: [usize; 2],
    /// The largest distance of one from an edge.
    far_units: f64,
    /// Where the furthest was.
    at: [f32; 2],
}

/// A drawing with its file and its oracle.
struct Subject {
    file: VtexFile,
    oracle: Oracle,
    expected: Vec<[f32; 4]>,
    places: Vec<[f32; 2]>,
    /// How many of the places are random in both directions; they come first.
    random: usize,
}

impl Subject {
    /// `None` when the drawing holds more than solid shapes.
    fn new(svg: &[u8], resources: &Resources, max_zoom: f32, points: usize) -> Option<Self> {
        let config = BakeConfig {
            max_zoom,
            ..BakeConfig::default()
        };
        let file = bake(svg, &config, resources).ok()?;
        let oracle = Oracle::new(svg, &config, resources, &file).unwrap()?;
        let places = places(&oracle, points);
        let expected = places.par_iter().map(|&uv| oracle.color(uv)).collect();
        Some(Self {
            file,
            oracle,
            expected,
            places,
            random: points,
        })
    }

    fn tally(&self, seen: &[[f32; 4]]) -> Tally {
        let mut tally = Tally::default();
        assert_eq!(seen.len(), self.expected.len(), "one answer a lookup");
        let pairs = seen.iter().zip(&self.expected).zip(&self.places);
        for (index, ((seen, expected), &uv)) in pairs.enumerate() {
            let same = seen
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() <= SAME_COLOR);
            if same {
                continue;
            }
            let distance = self.oracle.edge_distance_units(uv, REACH_UNITS);
            tally.wrong += usize::from(distance > BAND_UNITS);
            tally.near[usize::from(index >= self.random)] += usize::from(distance <= BAND_UNITS);
            if distance > tally.far_units {
                (tally.far_units, tally.at) = (distance, uv);
            }
        }
        tally
    }

    fn twin(&self) -> Tally {
        let packed = pack(&self.file, &options().pack);
        let sampler = cpu::Sampler::new(&packed);
        let look = |&uv: &[f32; 2]| sampler.sample(uv, [0.0; 4]);
        self.tally(&self.places.par_iter().map(look).collect::<Vec<_>>())
    }

    fn gpu(&self, gpu: &Gpu) -> Tally {
        let trust = Trust::Regenerate;
        let sampler = BatchSampler::new(&gpu.device, &gpu.queue, &self.file, &options(), trust);
        let query = |&uv: &[f32; 2]| BatchQuery {
            uv,
            ..BatchQuery::default()
        };
        let queries: Vec<BatchQuery> = self.places.iter().map(query).collect();
        self.tally(&sampler.unwrap().sample(&queries).unwrap())
    }
}

fn options() -> LoadOptions {
    LoadOptions {
        pack: PackOptions {
            filter: FilterMode::Point,
            ..PackOptions::default()
        },
        ..LoadOptions::default()
    }
}

/// `count` places all over the canvas, and a tenth as many at the height of some corner of an
/// outline, where comparisons of heights could disagree.
fn places(oracle: &Oracle, count: usize) -> Vec<[f32; 2]> {
    let mut random = Random::new(20);
    let mut places: Vec<[f32; 2]> = (0..count).map(|_| [random.unit(), random.unit()]).collect();
    let corners = (0..count / 10).filter_map(|_| {
        let [_, v] = oracle.corner(u64::from(random.bits()))?;
        #[expect(clippy::cast_possible_truncation, reason = "lookups take f32")]
        let v = v as f32;
        Some([random.unit(), v.clamp(0.0, 1.0)])
    });
    places.extend(corners);
    places
}

/// Compares `files`; `(solid ones, lookups further off than rounding explains, report)`.
fn compare(files: &[PathBuf], resources: &Resources, points: usize) -> (usize, usize, String) {
    let gpu = vtex_tests::gpu::shared();
    let look = |path: &PathBuf| compare_one(path, resources, points, gpu);
    // Most of the time goes into bakes, each of which uses one thread for most of it.
    let rows: Vec<(String, usize)> = files.par_iter().filter_map(look).collect();
    let mut report = String::from(
        "file,points,twin_wrong,twin_near,twin_near_corners,twin_far_units,\
         gpu_wrong,gpu_near,gpu_near_corners,gpu_far_units\n",
    );
    for (row, _) in &rows {
        report.push_str(row);
    }
    let wrong = rows.iter().map(|(_, wrong)| wrong).sum();
    (rows.len(), wrong, report)
}

/// A drawing's row of the report and its lookups further off than rounding explains; `None` when it
/// holds more than solid shapes.
fn compare_one(
    path: &Path,
    resources: &Resources,
    points: usize,
    gpu: Option<&Gpu>,
) -> Option<(String, usize)> {
    let svg = std::fs::read(path).unwrap();
    let subject = Subject::new(&svg, resources, 256.0, points)?;
    let name = path.file_name().unwrap().display().to_string();
    let name = name.replace(',', "_");
    let (mut row, mut wrong) = (format!("{name},{points}"), 0);
    let gpu = gpu.map(|gpu| subject.gpu(gpu));
    for (backend, tally) in [("twin", Some(subject.twin())), ("gpu", gpu)] {
        let Some(tally) = tally else { continue };
        let ([near, corners], far) = (tally.near, tally.far_units);
        write!(row, ",{},{near},{corners},{far:.3}", tally.wrong).unwrap();
        wrong += tally.wrong;
        if tally.wrong > 0 {
            println!("{}, {backend}: {tally:?}", path.display());
        }
    }
    println!("{row}");
    Some((row + "\n", wrong))
}

/// The fonts of the tests, for every family a file asks for.
fn resources() -> Resources {
    Resources {
        fonts: vtex_tests::fonts::library(),
        ..Resources::default()
    }
}

#[test]
fn own_drawings_look_as_the_oracle_says() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/svg");
    let files = vtex_testing::corpus::svg_files(&folder);
    let (solid, wrong, _) = compare(&files, &resources(), 5_000);
    assert!(solid >= 350, "only {solid} drawings are solid");
    assert_eq!(wrong, 0);
}

#[test]
fn a_dozen_of_the_corpus_look_as_the_oracle_says() {
    let Some(corpus) = Corpus::find("lookups of a dozen real drawings") else {
        return;
    };
    let files = corpus.drawings();
    // Spread over all folders.
    let files: Vec<PathBuf> = files.iter().step_by(files.len() / 16).cloned().collect();
    let (solid, wrong, _) = compare(&files, &resources(), 20_000);
    assert!(solid > 0);
    assert_eq!(wrong, 0);
}

#[test]
fn the_solid_corpus_looks_as_the_oracle_says() {
    let untested = "lookups of every solid drawing of the corpus";
    if !slow_only(untested) {
        return;
    }
    let Some(corpus) = Corpus::find(untested) else {
        return;
    };
    let mut files = corpus.drawings();
    let wanted = std::env::var("VTEX_FILTER").unwrap_or_default();
    files.retain(|path| path.to_string_lossy().contains(&wanted));
    let points = std::env::var("VTEX_POINTS").map_or(1_000_000, |text| text.parse().unwrap());
    let (solid, wrong, report) = compare(&files, &resources(), points);
    if let Some(folder) = std::env::var_os("VTEX_REPORT") {
        std::fs::write(Path::new(&folder).join("lookups.csv"), &report).unwrap();
    }
    println!("{solid} solid drawings of {}", files.len());
    assert_eq!(wrong, 0);
}
