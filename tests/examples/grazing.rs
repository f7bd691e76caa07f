//! Pictures of a drawing on a plane seen at 80 degrees from its normal: one point lookup a pixel,
//! one footprint lookup a pixel, and the truth, the mean of many point lookups. To be looked at;
//! prints the PSNR of both.
//!
//! `cargo run --release -p vtex-tests --example grazing -- FILE.vtex FOLDER`

#![expect(clippy::print_stdout, reason = "a report")]
#![expect(clippy::cast_possible_truncation, reason = "lookups take f32")]

use std::error::Error;
use std::path::Path;

use rayon::prelude::*;
use vtex_format::{Limits, VtexFile};
use vtex_shaders::cpu::Sampler;
use vtex_shaders::pack;
use vtex_truth::picture::{Picture, difference, difference_picture};
use vtex_truth::texture::{FilterMode, canvas_options};

/// Pixels of the pictures.
const SIZE_PX: [u32; 2] = [768, 480];
/// Between the middle ray and the plane's normal.
const ANGLE_DEGREES: f64 = 80.0;
/// Tangent of half the camera's horizontal angle.
const HALF_WIDTH: f64 = 0.28;
/// From the camera to the point of the plane in the middle of the picture, in widths of the canvas.
const DISTANCE: f64 = 1.6;
/// How often the canvas is repeated along the plane, so that the far end is minified.
const REPEATS: f64 = 8.0;
/// Point lookups along a pixel's side, for the truth.
const TRUTH: u32 = 24;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, file, folder] = arguments.as_slice() else {
        return Err("usage: grazing FILE.vtex FOLDER".into());
    };
    let folder = Path::new(folder);
    let file = VtexFile::parse(&std::fs::read(file)?, &Limits::default())?;
    let plane = Plane::new(&file);
    let words = |filter| pack(&file, &canvas_options(filter));
    let point = words(FilterMode::Point);
    let point = Sampler::new(&point);
    let truth = plane.picture(TRUTH, |uv, _| point.sample(uv, [0.0; 4]));
    truth_to(folder, "truth", &truth)?;
    let footprint = words(FilterMode::Footprint);
    let footprint = Sampler::new(&footprint);
    for (name, sampler) in [("point", point), ("footprint", footprint)] {
        let picture = plane.picture(1, |uv, axes| {
            // What a ray tracer without footprints gets.
            let axes = if name == "point" { [0.0; 4] } else { axes };
            sampler.sample(uv, axes)
        });
        truth_to(folder, name, &picture)?;
        let apart = difference_picture(&truth, &picture, 4.0);
        truth_to(folder, &format!("{name}-difference"), &apart)?;
        let bands = Band::ALL.map(|band| {
            let [truth, picture] = [&truth, &picture].map(|whole| band.of(whole));
            format!("{} {:.1}", band.name, difference(&truth, &picture).psnr_db)
        });
        println!("{name}, dB: {}", bands.join(", "));
    }
    Ok(())
}

fn truth_to(folder: &Path, name: &str, picture: &Picture) -> Result<(), Box<dyn Error>> {
    Ok(std::fs::write(
        folder.join(format!("{name}.png")),
        picture.to_png()?,
    )?)
}

/// Rows of a picture.
struct Band {
    name: &'static str,
    rows: [u32; 2],
}

impl Band {
    const ALL: [Self; 4] = [
        Self {
            name: "all",
            rows: [0, SIZE_PX[1]],
        },
        Self {
            name: "far",
            rows: [0, SIZE_PX[1] / 3],
        },
        Self {
            name: "middle",
            rows: [SIZE_PX[1] / 3, 2 * SIZE_PX[1] / 3],
        },
        Self {
            name: "near",
            rows: [2 * SIZE_PX[1] / 3, SIZE_PX[1]],
        },
    ];

    fn of(&self, picture: &Picture) -> Picture {
        let [first, end] = self.rows.map(|row| (row * SIZE_PX[0]) as usize);
        Picture {
            size_px: [SIZE_PX[0], self.rows[1] - self.rows[0]],
            pixels: picture.pixels[first..end].to_vec(),
        }
    }
}

/// The plane y = 0 with the canvas repeated along z, and a camera above it.
struct Plane {
    /// Height of the canvas in widths.
    height: f64,
}

impl Plane {
    fn new(file: &VtexFile) -> Self {
        let [width, height] = file.meta.canvas_size.map(f64::from);
        Self {
            height: height / width,
        }
    }

    /// Where the plane is seen at a place on the film in pixels: uv, v beyond [0, 1] in repetitions.
    /// `None` where it is not.
    fn uv(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let [width, height] = SIZE_PX.map(f64::from);
        let (sin, cos) = ANGLE_DEGREES.to_radians().sin_cos();
        let across = HALF_WIDTH * (2.0 * x / width - 1.0);
        let down = HALF_WIDTH * (2.0 * y - height) / width;
        // The middle ray is (0, -cos, sin); "down" on the film is (0, -sin, -cos).
        let fall = cos + down * sin;
        let ahead = sin - down * cos;
        let eye = DISTANCE * cos;
        let t = Some(eye / fall).filter(|t| *t > 0.0)?;
        let z = (t * ahead - DISTANCE * sin) / self.height;
        let uv = [0.5 + t * across, 0.5 - z];
        let seen = (0.0..=1.0).contains(&uv[0]) && (1.0 - REPEATS..=1.0).contains(&uv[1]);
        seen.then_some(uv)
    }

    /// The mean of `side` by `side` lookups in each pixel.
    fn picture(&self, side: u32, look: impl Fn([f32; 2], [f32; 4]) -> [f32; 4] + Sync) -> Picture {
        let pixel = |index: u32| {
            let [x, y] = [index % SIZE_PX[0], index / SIZE_PX[0]].map(f64::from);
            let step = f64::from(side).recip();
            let mut sum = [0.0; 4];
            for sample in 0..side * side {
                let [i, j] = [sample % side, sample / side].map(|k| (f64::from(k) + 0.5) * step);
                let color = self.look([x + i, y + j], step, &look);
                sum = std::array::from_fn(|c| sum[c] + color[c]);
            }
            sum.map(|channel| channel / (side * side) as f32)
        };
        Picture {
            size_px: SIZE_PX,
            pixels: (0..SIZE_PX[0] * SIZE_PX[1])
                .into_par_iter()
                .map(pixel)
                .collect(),
        }
    }

    /// White beside the plane.
    fn look(
        &self,
        [x, y]: [f64; 2],
        step: f64,
        look: &impl Fn([f32; 2], [f32; 4]) -> [f32; 4],
    ) -> [f32; 4] {
        let half = 0.5 * step;
        let around = [
            [x, y],
            [x + half, y],
            [x - half, y],
            [x, y + half],
            [x, y - half],
        ];
        let [Some(at), Some(right), Some(left), Some(below), Some(above)] =
            around.map(|place| self.uv(place))
        else {
            return [1.0; 4];
        };
        let axis = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|i| (a[i] - b[i]) as f32);
        let ([au, av], [bu, bv]) = (axis(right, left), axis(below, above));
        let [r, g, b, a] = look(
            [at[0] as f32, at[1].rem_euclid(1.0) as f32],
            [au, av, bu, bv],
        );
        let over_white = 1.0 - a;
        [r + over_white, g + over_white, b + over_white, 1.0]
    }
}
