//! From command-line options to a bake, in this process or in limited ones.

pub(crate) mod cache;
pub(crate) mod fonts;
pub(crate) mod images;
pub(crate) mod memory;
pub(crate) mod wire;
pub(crate) mod workers;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use rayon::prelude::*;
use vtex_baker::{BakeConfig, BakeError, Mode, Resources, Stage};
use vtex_format::{AddressMode, VtexFile};

use crate::cli::args::{Address, BakeMode, BakeOptions};
use crate::cli::{ExitCode, Failure, Outcome, Profile, panicked};
use fonts::FontLibrary;

/// The baker's options for those of the command line; an option that is not given keeps the baker's
/// default.
pub(crate) fn config(options: &BakeOptions) -> BakeConfig {
    let default = BakeConfig::default();
    let mode = match options.mode {
        BakeMode::Auto => Mode::Auto,
        BakeMode::Msdf => Mode::Msdf,
        BakeMode::Raster => Mode::Raster,
        BakeMode::Curves => Mode::Curves,
    };
    let address = options.address.map(|address| match address {
        Address::Clamp => AddressMode::Clamp,
        Address::Repeat => AddressMode::Repeat,
        Address::Mirror => AddressMode::Mirror,
        Address::Border => AddressMode::Border,
    });
    BakeConfig {
        mode,
        error_px: options.error,
        max_zoom: options.max_zoom,
        mip0_size: options.size,
        msdf_size: options.msdf_size,
        merge: options.merge,
        mask: options.mask,
        smoothing: options.smoothing,
        outline_texels: options.outline,
        fill_color: options.fill_color.map(|color| color.0),
        stroke_color: options.stroke_color.map(|color| color.0),
        address: address.map_or(default.address, |mode| [mode; 2]),
        texture_matrix: options
            .transform
            .map_or(default.texture_matrix, |matrix| matrix.0),
        gpu_budget_bytes: options.gpu_budget,
        profile: match options.profile {
            Profile::Size => vtex_baker::Profile::Size,
            Profile::Load => vtex_baker::Profile::Load,
            Profile::LoadFootprints => vtex_baker::Profile::LoadFootprints,
        },
        ..default
    }
}

/// As [`config`], checked.
///
/// # Errors
/// The first option out of its range, by its name.
pub(crate) fn checked_config(options: &BakeOptions) -> Outcome<BakeConfig> {
    let config = config(options);
    // The baker names its own options, not those of the command line: the one that it refuses
    // while all others have their defaults is the one to name.
    type Take = fn(&mut BakeConfig, &BakeConfig);
    let options: [(&str, Take); 7] = [
        ("--size", |to, from| to.mip0_size = from.mip0_size),
        ("--msdf-size", |to, from| to.msdf_size = from.msdf_size),
        ("--max-zoom", |to, from| to.max_zoom = from.max_zoom),
        ("--error", |to, from| to.error_px = from.error_px),
        ("--smoothing", |to, from| to.smoothing = from.smoothing),
        ("--transform", |to, from| {
            to.texture_matrix = from.texture_matrix;
        }),
        ("--outline", |to, from| {
            (to.outline_texels, to.mode) = (from.outline_texels, from.mode);
        }),
    ];
    for (name, take) in options {
        let mut alone = BakeConfig::default();
        take(&mut alone, &config);
        alone
            .check()
            .map_err(|error| Failure::usage(format!("{name}: {error}")))?;
    }
    config.check().map_err(Failure::usage)?;
    Ok(config)
}

/// Bakes the SVG read from `path` in this process, without limits on time and memory.
///
/// # Errors
/// With an exit code by cause: the file, an option, a limit, or a bug of ours.
pub(crate) fn bake(
    path: &Path,
    svg: &[u8],
    config: &BakeConfig,
    fonts: &FontLibrary,
    observer: &(dyn Fn(Stage) + Sync),
) -> Outcome<VtexFile> {
    let resources = Resources {
        fonts: fonts.for_svg(svg),
        images: None,
    };
    bake_with(path, svg, config, &resources, observer)
}

/// As [`bake`], with image files.
///
/// # Errors
/// As [`bake`].
pub(crate) fn bake_with(
    path: &Path,
    svg: &[u8],
    config: &BakeConfig,
    resources: &Resources,
    observer: &(dyn Fn(Stage) + Sync),
) -> Outcome<VtexFile> {
    let bake = || vtex_baker::bake_observed(svg, config, resources, observer);
    // A bug that one drawing triggers must not stop the bakes of the others.
    match catch_unwind(AssertUnwindSafe(bake)) {
        Ok(baked) => baked.map_err(|error| failure(path, &error)),
        Err(panic) => Err(panicked(&format!("{}: baking", path.display()), &*panic)),
    }
}

fn failure(path: &Path, error: &BakeError) -> Failure {
    let code = match error {
        BakeError::Parameter(_) => return Failure::usage(error),
        BakeError::Svg(_) => ExitCode::InvalidInput,
        BakeError::Limit(_) => ExitCode::Limit,
        _ => ExitCode::Runtime,
    };
    Failure::new(code, format!("{}: {error}", path.display()))
}

/// The bytes of a baked file.
///
/// # Errors
/// When the file breaks the rules of its own format, which is a bug of the baker.
pub(crate) fn to_bytes(path: &Path, file: &VtexFile) -> Outcome<Vec<u8>> {
    let run = |count, job: &(dyn Fn(usize) + Sync)| (0..count).into_par_iter().for_each(job);
    file.to_bytes_by(&run)
        .map_err(|error| Failure::runtime(format!("{}: {error}", path.display())))
}
