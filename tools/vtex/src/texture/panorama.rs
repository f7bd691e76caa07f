//! Light from everywhere else: panoramas in HDR files.

use std::io::Cursor;

use image::{ImageFormat, ImageReader, Limits};
use vtex_runtime::{Environment, Scene, Sky};

use crate::cli::light::Surroundings;
use crate::cli::{ExitCode, Failure, Outcome};
use crate::files::{extension, input};

/// Longest side of a panorama that is read. Longer ones than 8192 are halved when they are used.
const MAX_SIDE: u32 = 32_768;
/// Most bytes that its pixels may take while they are read: 16,384 x 8,192 pixels of four floats.
const MAX_BYTES: u64 = 1 << 31;

/// Lights `scene` as the command line says.
///
/// # Errors
/// When the panorama cannot be read.
pub(crate) fn surround(scene: &mut Scene, surroundings: &Surroundings) -> Outcome<()> {
    if let Some(level) = surroundings.sky {
        scene.sky = Sky::uniform(level);
    }
    let Some(path) = &surroundings.environment else {
        return Ok(());
    };
    let name = path.display();
    let format = match extension(path).as_str() {
        "hdr" => ImageFormat::Hdr,
        "exr" => ImageFormat::OpenExr,
        _ => {
            return Err(Failure::usage(format!(
                "{name}: a panorama must be an .hdr or .exr file"
            )));
        }
    };
    let mut reader = ImageReader::with_format(Cursor::new(input::read(path)?), format);
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_BYTES);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| {
        let code = match error {
            image::ImageError::Limits(_) => ExitCode::Limit,
            _ => ExitCode::InvalidInput,
        };
        Failure::new(code, format!("{name}: {error}"))
    })?;
    let image = image.into_rgb32f();
    let size = image.dimensions().into();
    let texels = image.pixels().map(|pixel| pixel.0).collect();
    let mut environment = Environment::new(size, texels);
    environment.turn_rad = surroundings.environment_turn.unwrap_or(0.0).to_radians();
    scene.environment = Some(environment);
    Ok(())
}
