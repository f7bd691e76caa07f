//! `vtex compare`.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use vtex_format::VtexFile;
use vtex_shaders::PackOptions;
use vtex_truth::comparison::{Column, Comparison, Page, Sizes, Terms, Window, ZoomReport};
use vtex_truth::picture::difference_picture;
use vtex_truth::reference::{Edges, Reference};
use vtex_truth::texture::{RasterTexture, Shooter, TODAY_TEXELS, canvas_options, region_uv};

use crate::baking::fonts::FontLibrary;
use crate::cli::args::{Compare, spelled};
use crate::cli::{Console, ExitCode, Failure, Format, Outcome};
use crate::files::{extension, input, is_svg, lossy, output};
use crate::texture;

/// Runs `vtex compare`.
pub(super) fn run(args: Compare, console: Console) -> Outcome<ExitCode> {
    if let Some(zoom) = args
        .zoom
        .iter()
        .find(|&&zoom| !(1.0..=65_536.0).contains(&zoom))
    {
        return Err(Failure::usage(format!(
            "--zoom {zoom}: a zoom must be between 1 and 65536"
        )));
    }
    let svg = input::read(&args.svg)?;
    let bytes = input::read(&args.file)?;
    if extension(&args.svg) == "vtex" && is_svg(&args.file, &bytes) {
        let message = "the SVG comes first: vtex compare IN.svg FILE";
        return Err(Failure::invalid(&args.svg, message));
    }
    let file = texture::parse(&args.file, &bytes)?;
    let source_matches = source_matches(&file, &svg);
    if source_matches == Some(false) {
        let [name, svg] = [&args.file, &args.svg].map(|path| path.display());
        console.note(&format!(
            "{name}: warning: it was baked from another drawing than {svg}, or from another \
             version of it"
        ));
    }
    let fonts = FontLibrary::new(args.fonts.clone())?;
    let reference = Reference::parse(&svg, fonts.for_svg(&svg), Edges::Crisp)
        .map_err(|error| Failure::invalid(&args.svg, format!("not a usable SVG: {error}")))?;
    let comparison = Comparison::new(&reference, terms(&args, &file))?;
    let pack = PackOptions {
        samples: args.lookup.footprint_samples.into(),
        ..canvas_options(args.lookup.filter.into())
    };
    let shooter = texture::shooter(&file, pack, args.lookup.backend)?;
    let progress = console.progress(args.zoom.len() as u64, "comparing");
    let mut reports = Vec::new();
    for &zoom in &args.zoom {
        reports.push(comparison.measure(zoom, |shot| shooter.shoot(shot))?);
        progress.step();
    }
    drop(progress);
    let noise = args
        .noise
        .then(|| noise_db(&comparison, &reports))
        .transpose()?;
    match console.format {
        Format::Json => {
            let mut report = json(&args, &reports, noise.as_deref());
            report["source_matches"] = json!(source_matches);
            console.json(&report)?;
        }
        Format::Text => console.result(text(&reports, noise.as_deref()).as_bytes())?,
    }
    if let Some(folder) = &args.html {
        let stock = Stock {
            svg: &svg,
            file: &file,
            vtex_bytes: bytes.len() as u64,
            fonts: &fonts,
        };
        write_page(&args, folder, &stock, &comparison, &shooter, &reports)?;
        console.note(&format!("{}", folder.join("index.html").display()));
    }
    if let Some(folder) = &args.pictures {
        write_pictures(&args, folder, &comparison, &shooter, &reports)?;
    }
    Ok(verdict(&args, &reports, console))
}

/// Whether the file was baked from these bytes; `None` when it does not say from which.
fn source_matches(file: &VtexFile, svg: &[u8]) -> Option<bool> {
    let provenance = file.provenance.as_ref()?;
    Some(provenance.source_hash == *blake3::hash(svg).as_bytes())
}

/// The noise of the truth in the worst window of each zoom.
fn noise_db(comparison: &Comparison<'_>, reports: &[ZoomReport]) -> Outcome<Vec<f64>> {
    let worst = reports.iter().map(|report| report.worst().view);
    worst.map(|view| Ok(comparison.noise_db(view)?)).collect()
}

/// Writes three PNGs of the worst window of all zooms.
fn write_pictures(
    args: &Compare,
    folder: &Path,
    comparison: &Comparison<'_>,
    shooter: &Shooter,
    reports: &[ZoomReport],
) -> Outcome<()> {
    let windows = reports.iter().map(ZoomReport::worst);
    let db = |window: &Window| window.difference.psnr_db;
    let Some(worst) = windows.min_by(|a, b| db(a).total_cmp(&db(b))) else {
        return Ok(());
    };
    let truth = comparison.truth(worst.view)?;
    let picture = comparison.as_compared(shooter.shoot(comparison.shot(worst.view))?);
    let apart = difference_picture(&truth, &picture, 4.0);
    output::create_folder(folder)?;
    for (name, picture) in [("svg", &truth), ("vtex", &picture), ("difference", &apart)] {
        let path = folder.join(format!("{name}.png"));
        output::write_apart(&path, &picture.to_png()?, &taken(args))?;
    }
    Ok(())
}

/// What no output may overwrite.
fn taken(args: &Compare) -> BTreeSet<PathBuf> {
    output::taken([args.svg.as_path(), args.file.as_path()])
}

fn terms(args: &Compare, file: &VtexFile) -> Terms {
    Terms {
        longer_px: args.size,
        spp: args.lookup.spp,
        region_uv: region_uv(file, args.lookup.filter.into()),
        windows: args.windows,
        mask: file.meta.sampler.mask,
    }
}

fn verdict(args: &Compare, reports: &[ZoomReport], console: Console) -> ExitCode {
    let Some(bound) = args.min_psnr else {
        return ExitCode::Ok;
    };
    let below = |report: &&ZoomReport| report.worst().difference.psnr_db < bound;
    let mut code = ExitCode::Ok;
    for report in reports.iter().filter(below) {
        let psnr = report.worst().difference.psnr_db;
        let zoom = report.zoom;
        let name = args.file.display();
        let message = format!("{name}: {psnr:.2} dB at zoom {zoom} is below --min-psnr {bound}");
        let failure = Failure::new(ExitCode::Difference, message);
        console.failure(&failure);
        code = failure.code;
    }
    code
}

fn json(args: &Compare, reports: &[ZoomReport], noise_db: Option<&[f64]>) -> Value {
    let zoom = |(index, report): (usize, &ZoomReport)| {
        let mut zoom = report.to_json();
        if let Some(noise_db) = noise_db.and_then(|all| all.get(index)) {
            zoom["noise_db"] = json!(noise_db);
        }
        zoom
    };
    json!({
        "svg": lossy(&args.svg), "file": lossy(&args.file), "size": args.size, "spp": args.lookup.spp,
        "filter": spelled(&args.lookup.filter), "footprint_samples": args.lookup.footprint_samples.count(), "backend": spelled(&args.lookup.backend),
        "zooms": reports.iter().enumerate().map(zoom).collect::<Vec<_>>(),
    })
}

fn text(reports: &[ZoomReport], noise_db: Option<&[f64]>) -> String {
    let mut out = format!(
        "{:>7} {:>9} {:>10} {:>9}  worst window, uv\n",
        "zoom", "PSNR dB", "wrong px", "max diff"
    );
    for report in reports {
        let worst = report.worst();
        let found = worst.difference;
        let view = worst.view;
        // Writing to a String does not fail.
        let _ = writeln!(
            out,
            "{:>7} {:>9.2} {:>9.3}% {:>9.1}  {:.5},{:.5} to {:.5},{:.5}",
            report.zoom,
            found.psnr_db,
            100.0 * found.wrong_share,
            found.max_difference,
            view.u0,
            view.v0,
            view.u1,
            view.v1
        );
    }
    for (report, noise_db) in reports.iter().zip(noise_db.unwrap_or_default()) {
        let zoom = report.zoom;
        let _ = writeln!(
            out,
            "{zoom:>7} {noise_db:>9.2} the truth against itself, with a quarter of the samples"
        );
    }
    out
}

struct Stock<'a> {
    svg: &'a [u8],
    file: &'a VtexFile,
    vtex_bytes: u64,
    fonts: &'a FontLibrary,
}

fn write_page(
    args: &Compare,
    folder: &Path,
    stock: &Stock<'_>,
    comparison: &Comparison<'_>,
    shooter: &Shooter,
    reports: &[ZoomReport],
) -> Outcome<()> {
    let smooth = Reference::parse(stock.svg, stock.fonts.for_svg(stock.svg), Edges::Smooth)
        .map_err(|error| Failure::invalid(&args.svg, error))?;
    let texture = RasterTexture::new(&smooth, TODAY_TEXELS)?;
    let name = args
        .svg
        .file_stem()
        .map_or_else(|| "drawing".into(), |stem| stem.to_string_lossy());
    let mut page = Page::new("vtex compare");
    page.drawing(
        &name,
        &Sizes::new(
            stock.svg.len() as u64,
            (stock.file, stock.vtex_bytes),
            &texture,
        )?,
    );
    for report in reports {
        let view = report.worst().view;
        let truth = comparison.truth(view)?;
        let shot = comparison.shot(view);
        let columns = [
            Column::new(comparison, &truth, shooter.shoot(shot)?),
            Column::new(comparison, &truth, texture.shoot(shot)),
        ];
        page.row(report.zoom, &truth, &columns)?;
    }
    output::write_page(folder, page, &taken(args))
}
