//! Pictures of one drawing: the truth, the twin's and the GPU's from the same lookups.

use std::path::Path;

use vtex_baker::{BakeConfig, Resources, bake};
use vtex_format::VtexFile;
use vtex_runtime::BatchQuery;
use vtex_shaders::cpu;
use vtex_tests::{fonts, gpu};
use vtex_truth::comparison::EdgeFinder;
use vtex_truth::picture::{Picture, Shot, View, difference, difference_picture, fit_size};
use vtex_truth::reference::{Edges, Reference, SUPERSAMPLES};
use vtex_truth::texture::{FilterMode, Shooter, canvas_options};

/// Pixels of the pictures' longer side.
const LONGER_PX: u32 = 64;
/// Samples a pixel: their noise alone leaves 45 dB or so on drawings of this kind.
const SPP: u32 = 64;
/// Samples along each side of the truth's pixels where there are filters: resvg takes its time
/// with those, and what they make is smooth.
const FILTER_SAMPLES: u32 = 6;
/// The zooms that are compared.
pub(crate) const ZOOMS: [f64; 2] = [1.0, 8.0];
/// Largest difference of a channel, linear light, that counts as equal.
const SAME: f32 = 2.0 / 255.0;

/// What a case came to.
pub(crate) struct Found {
    pub(crate) file: VtexFile,
    /// One a zoom.
    pub(crate) views: Vec<Seen>,
}

/// One view of the canvas.
pub(crate) struct Seen {
    pub(crate) zoom: f64,
    pub(crate) truth: Picture,
    pub(crate) twin: Picture,
    /// PSNR of the twin's picture, and of the GPU's where there is one, dB.
    pub(crate) psnr_db: Vec<f64>,
    pub(crate) lookups: usize,
    /// Lookups that GPU and twin answer differently.
    pub(crate) apart: usize,
}

impl Seen {
    /// The worse of the two pictures' PSNR.
    pub(crate) fn least_db(&self) -> f64 {
        self.psnr_db.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Writes truth, twin and their difference, fourfold.
    pub(crate) fn write(&self, folder: &Path, name: &str) {
        std::fs::create_dir_all(folder).unwrap();
        let apart = difference_picture(&self.truth, &self.twin, 4.0);
        let pictures = [
            ("svg", &self.truth),
            ("vtex", &self.twin),
            ("difference", &apart),
        ];
        for (what, picture) in pictures {
            let path = folder.join(format!("{name}.{}x.{what}.png", self.zoom));
            std::fs::write(path, picture.to_png().unwrap()).unwrap();
        }
    }
}

/// Bakes a drawing and looks at it; an error where it does not bake.
pub(crate) fn look(svg: &[u8]) -> Result<Found, String> {
    let resources = Resources {
        fonts: fonts::library(),
        ..Resources::default()
    };
    let file = bake(svg, &BakeConfig::default(), &resources).map_err(|error| error.to_string())?;
    file.to_bytes().map_err(|error| error.to_string())?;
    let reference = Reference::parse(svg, fonts::library(), Edges::Crisp)?;
    let samples = match svg.windows(6).any(|word| word == b"filter") {
        true => FILTER_SAMPLES,
        false => SUPERSAMPLES,
    };
    let size_px = fit_size(reference.canvas_size(), LONGER_PX);
    let truth = |view| reference.render_with(view, size_px, samples).unwrap();
    let finder = EdgeFinder::new(&reference, truth(View::WHOLE));
    let eyes = Eyes::new(&file);
    let view = |zoom| {
        let view = match zoom > 1.0 {
            true => finder.window(zoom, 0).unwrap(),
            false => View::WHOLE,
        };
        eyes.see(zoom, view, truth(view))
    };
    let views = ZOOMS.map(view).into();
    Ok(Found { file, views })
}

/// Both evaluators with one texture.
struct Eyes {
    words: Vec<u32>,
    gpu: Option<Shooter>,
}

impl Eyes {
    fn new(file: &VtexFile) -> Self {
        let pack = canvas_options(FilterMode::Point);
        let shooter = |gpu| Shooter::on_gpu(gpu, file, pack).unwrap();
        Self {
            words: vtex_shaders::pack(file, &pack),
            gpu: gpu::shared().map(shooter),
        }
    }

    fn see(&self, zoom: f64, view: View, truth: Picture) -> Seen {
        let shot = Shot {
            view,
            size_px: truth.size_px,
            spp: SPP,
        };
        let queries = lookups(shot);
        let sampler = cpu::Sampler::new(&self.words);
        let look = |query: &BatchQuery| sampler.sample(query.uv, query.footprint);
        let colors: Vec<[f32; 4]> = queries.iter().map(look).collect();
        let twin = picture(shot, &colors);
        let mut seen = Seen {
            zoom,
            psnr_db: vec![difference(&truth, &twin).psnr_db],
            truth,
            twin,
            lookups: queries.len(),
            apart: 0,
        };
        if let Some(Shooter::Gpu { sampler }) = &self.gpu {
            let answers = sampler.sample(&queries).unwrap();
            let pairs = colors.iter().zip(&answers);
            seen.apart = pairs.filter(|(a, b)| !same(a, b)).count();
            let theirs = picture(shot, &answers);
            seen.psnr_db.push(difference(&seen.truth, &theirs).psnr_db);
        }
        seen
    }
}

/// The lookups of a shot as points: cells answer them at every zoom, mips none.
fn lookups(shot: Shot) -> Vec<BatchQuery> {
    let [width, height] = shot.size_px;
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let point = |query| BatchQuery {
        footprint: [0.0; 4],
        ..query
    };
    pixels
        .flat_map(|[x, y]| shot.queries(x, y))
        .map(point)
        .collect()
}

/// The means of each pixel's colours.
fn picture(shot: Shot, colors: &[[f32; 4]]) -> Picture {
    let mean = |colors: &[[f32; 4]]| {
        let sum = |channel: usize| colors.iter().map(|color| color[channel]).sum::<f32>();
        [0, 1, 2, 3].map(|channel| sum(channel) / shot.spp as f32)
    };
    Picture {
        size_px: shot.size_px,
        pixels: colors.chunks_exact(shot.spp as usize).map(mean).collect(),
    }
}

/// Never for what is no number.
fn same(a: &[f32; 4], b: &[f32; 4]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME)
}
