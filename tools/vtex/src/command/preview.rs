//! `vtex preview`.

use vtex_format::VtexFile;
use vtex_truth::picture::{Shot, View, fit_size};
use vtex_truth::texture::{pack_options, region_uv};

use crate::cli::args::Preview;
use crate::cli::{Console, ExitCode, Outcome, Size};
use crate::files::{input, output};
use crate::texture;

/// Runs `vtex preview`.
pub(super) fn run(args: &Preview, console: Console) -> Outcome<ExitCode> {
    output::keep_apart(&args.output, &output::taken([args.file.as_path()]))?;
    let bytes = input::read(&args.file)?;
    let file = texture::parse(&args.file, &bytes)?;
    let view = args.view.unwrap_or(View::WHOLE);
    let shot = Shot {
        view,
        size_px: size_px(args.size, view, &file),
        spp: args.lookup.spp,
        region_uv: region_uv(&file, args.lookup.filter.into()),
    };
    let pack = pack_options(args.lookup.filter.into());
    let picture = texture::shooter(&file, pack, args.lookup.backend)?.shoot(shot)?;
    let png = picture.to_png()?;
    if args.output.as_os_str() == "-" {
        console.result(&png)?;
    } else {
        output::write(&args.output, &png)?;
        let [width, height] = shot.size_px;
        console.note(&format!("{}: {width} x {height}", args.output.display()));
    }
    Ok(ExitCode::Ok)
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
