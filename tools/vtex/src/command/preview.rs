//! `vtex preview`.

use std::time::Instant;

use serde_json::json;
use vtex_format::VtexFile;
use vtex_shaders::PackOptions;
use vtex_truth::picture::{Shot, View, fit_size};
use vtex_truth::texture::{pack_options, region_uv};

use crate::cli::args::{Preview, spelled};
use crate::cli::{Console, ExitCode, Failure, Format, Outcome, Size};
use crate::files::{extension, input, lossy, output};
use crate::texture;

/// Runs `vtex preview`.
pub(super) fn run(args: &Preview, console: Console) -> Outcome<ExitCode> {
    let to_stdout = args.output.as_os_str() == "-";
    check_output(args, to_stdout, console)?;
    let begun = Instant::now();
    let bytes = input::read(&args.file)?;
    let file = texture::parse(&args.file, &bytes)?;
    let view = args.view.unwrap_or(View::WHOLE);
    let shot = Shot {
        view,
        size_px: size_px(args.size, view, &file),
        spp: args.lookup.spp,
        region_uv: region_uv(&file, args.lookup.filter.into()),
    };
    let pack = PackOptions {
        samples: args.lookup.footprint_samples.into(),
        ..pack_options(args.lookup.filter.into())
    };
    let picture = texture::shooter(&file, pack, args.lookup.backend)?.shoot(shot)?;
    let png = picture.to_png()?;
    if to_stdout {
        console.result(&png)?;
        return Ok(ExitCode::Ok);
    }
    output::write(&args.output, &png)?;
    let [width, height] = shot.size_px;
    console.note(&format!("{}: {width} x {height}", args.output.display()));
    if console.format == Format::Json {
        console.json(&json!({
            "input": lossy(&args.file), "output": lossy(&args.output), "bytes": png.len(),
            "size_px": shot.size_px, "view": view.as_array(), "spp": args.lookup.spp,
            "filter": spelled(&args.lookup.filter), "footprint_samples": args.lookup.footprint_samples.count(), "backend": spelled(&args.lookup.backend),
            "seconds": begun.elapsed().as_secs_f64(),
        }))?;
    }
    Ok(ExitCode::Ok)
}

/// Refuses an output that is no place for a PNG, before the work.
fn check_output(args: &Preview, to_stdout: bool, console: Console) -> Outcome<()> {
    if to_stdout && console.format == Format::Json {
        return Err(Failure::usage(
            "-o - and --format json cannot both write to standard output",
        ));
    }
    if to_stdout {
        return Ok(());
    }
    output::keep_apart(&args.output, &output::taken([args.file.as_path()]))?;
    // Devices and pipes have no extension.
    if !["png", ""].contains(&extension(&args.output).as_str()) {
        let name = args.output.display();
        return Err(Failure::usage(format!(
            "{name}: the output is a PNG; name a .png file, and convert that for other formats"
        )));
    }
    output::check(&args.output)
}

/// The size in pixels, keeping the proportions of what is shown where one side is given.
pub(super) fn size_px(size: Size, view: View, file: &VtexFile) -> [u32; 2] {
    match size {
        Size::Exact(size) => size,
        Size::Longer(longer) => {
            let extent = view.extent();
            let canvas = file.meta.canvas_size.map(f64::from);
            fit_size([canvas[0] * extent[0], canvas[1] * extent[1]], longer)
        }
    }
}
