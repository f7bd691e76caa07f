//! Pictures of one drawing: the truth, the twin's and the GPU's from the same lookups.

use std::path::Path;
use std::sync::Arc;

use vtex_baker::{BakeConfig, Resources, bake};
use vtex_format::{Limits, VtexFile, validate};
use vtex_runtime::Gpu;
use vtex_tests::fonts;
use vtex_tests::parity::{Parities, Parity};
use vtex_truth::comparison::EdgeFinder;
use vtex_truth::picture::{POINTS, Picture, Shot, View, difference, difference_picture, fit_size};
use vtex_truth::reference::{Edges, Reference, SUPERSAMPLES};
use vtex_truth::texture::FilterMode;

use crate::eyes::{Eyes, queries};
use crate::lookups;
use crate::table::Fonts;

/// Pixels of the pictures' longer side.
const LONGER_PX: u32 = 64;
/// Samples a pixel: their noise alone leaves 45 dB or so on drawings of this kind.
const SPP: u32 = 64;
/// Texels along the longer side of mip 0: one for each sample of the pictures, so that the mips are seen
/// alone. The default is a quarter of that.
const MIP0_SIZE: u32 = 8 * LONGER_PX;
/// Samples along each side of the truth's pixels at zoom 8 where there are filters: resvg's time
/// grows with the square of the size, for feMorphology with the fourth power. At zoom 1 so few would
/// cost up to 16 dB.
const FILTER_SAMPLES: u32 = 6;
/// The zooms that are compared.
pub(crate) const ZOOMS: [f64; 2] = [1.0, 8.0];

/// What a case came to.
pub(crate) struct Found {
    pub(crate) file: VtexFile,
    /// What is wrong with the file's bytes.
    pub(crate) invalid: Option<String>,
    /// One a zoom.
    pub(crate) views: [Seen; 2],
    /// The whole canvas from the mips alone.
    pub(crate) mips: Picture,
    /// PSNR of that, dB.
    pub(crate) mips_db: f64,
    /// How GPU and twin differ in the lookups of the views and in random ones.
    pub(crate) parities: Parities,
}

impl Found {
    /// Writes pictures of all views, and of the mips.
    pub(crate) fn write(&self, folder: &Path, name: &str) {
        std::fs::create_dir_all(folder).unwrap();
        for view in &self.views {
            view.write(folder, name);
        }
        let path = folder.join(format!("{name}.mips.png"));
        std::fs::write(path, self.mips.to_png().unwrap()).unwrap();
    }
}

/// One view of the canvas.
pub(crate) struct Seen {
    pub(crate) zoom: f64,
    pub(crate) truth: Picture,
    pub(crate) twin: Picture,
    /// PSNR of the twin's picture, and of the GPU's where there is one, dB.
    pub(crate) psnr_db: Vec<f64>,
    /// How GPU and twin differ.
    parity: Parity,
}

impl Seen {
    /// The worse of the two pictures' PSNR.
    pub(crate) fn least_db(&self) -> f64 {
        self.psnr_db.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Writes truth, twin and their difference, fourfold.
    pub(crate) fn write(&self, folder: &Path, name: &str) {
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

/// Bakes a drawing and looks at it, also on `gpu`; an error where it does not bake.
pub(crate) fn look(svg: &[u8], fonts: Fonts, gpu: Option<&Gpu>) -> Result<Found, String> {
    let fonts = match fonts {
        Fonts::Library => fonts::library(),
        Fonts::None => Arc::default(),
    };
    let resources = Resources {
        fonts: Arc::clone(&fonts),
        ..Resources::default()
    };
    let config = BakeConfig {
        mip0_size: MIP0_SIZE,
        // Its warning is of bytes, not of pictures.
        gpu_budget_bytes: u64::MAX,
        ..BakeConfig::default()
    };
    let file = bake(svg, &config, &resources).map_err(|error| error.to_string())?;
    let bytes = file.to_bytes().map_err(|error| error.to_string())?;
    let reference = Reference::parse(svg, fonts, Edges::Crisp)?;
    let close_samples = match svg.windows(6).any(|word| word == b"filter") {
        true => FILTER_SAMPLES,
        false => SUPERSAMPLES,
    };
    let size_px = fit_size(reference.canvas_size(), LONGER_PX);
    let truth = |view, samples| reference.render_with(view, size_px, samples).unwrap();
    let whole = truth(View::WHOLE, SUPERSAMPLES);
    let finder = EdgeFinder::new(&reference, whole.clone());
    let close = finder.window(ZOOMS[1], 0).unwrap();
    let eyes = Eyes::new(gpu, &file, FilterMode::Point);
    let mips = mips(&eyes, size_px);
    let views = [
        see(&eyes, ZOOMS[0], View::WHOLE, whole.clone()),
        see(&eyes, ZOOMS[1], close, truth(close, close_samples)),
    ];
    let mut parities = Parities::default();
    if let Some(gpu) = gpu {
        parities = lookups::compare(gpu, &file, &eyes);
        for view in &views {
            parities.add(eyes.features, view.parity);
        }
    }
    Ok(Found {
        invalid: invalid(&file, &bytes),
        mips_db: difference(&whole, &mips).psnr_db,
        mips,
        views,
        parities,
        file,
    })
}

/// What the validator finds, or that the file does not read back as it was.
fn invalid(file: &VtexFile, bytes: &[u8]) -> Option<String> {
    let issues = validate(bytes, &Limits::default());
    if let Some(issue) = issues.first() {
        return Some(format!("{} issues, the first: {issue}", issues.len()));
    }
    match VtexFile::parse(bytes, &Limits::default()) {
        Ok(again) if again == *file => None,
        Ok(_) => Some("the file does not read back as it was".to_owned()),
        Err(error) => Some(error.to_string()),
    }
}

/// The whole canvas from footprints: at this size they are a texel of mip 0. On the twin alone: the
/// random lookups compare it with the GPU.
fn mips(eyes: &Eyes, size_px: [u32; 2]) -> Picture {
    let shot = Shot {
        view: View::WHOLE,
        size_px,
        spp: SPP,
        region_uv: POINTS,
    };
    picture(shot, &eyes.look_up_twin(&queries(shot)))
}

/// A view from points: cells answer them at every zoom, mips never.
fn see(eyes: &Eyes, zoom: f64, view: View, truth: Picture) -> Seen {
    let shot = Shot {
        view,
        size_px: truth.size_px,
        spp: SPP,
        region_uv: POINTS,
    };
    let mut queries = queries(shot);
    for query in &mut queries {
        query.footprint = [0.0; 4];
    }
    let answers = eyes.look_up(&queries);
    let twin = picture(shot, &answers.twin);
    let mut psnr_db = vec![difference(&truth, &twin).psnr_db];
    if let Some(colors) = &answers.gpu {
        psnr_db.push(difference(&truth, &picture(shot, colors)).psnr_db);
    }
    Seen {
        zoom,
        truth,
        twin,
        psnr_db,
        parity: answers.parity,
    }
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
