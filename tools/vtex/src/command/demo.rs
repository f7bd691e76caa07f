//! `vtex demo`, which `tools/demo` calls: bakes drawings, traces a scene, writes the page.

use std::path::Path;
use std::time::Instant;

use vtex_baker::BakeConfig;
use vtex_format::VtexFile;
use vtex_runtime::ToneMap;
use vtex_truth::comparison::{Column, Comparison, Page, Sizes, Terms, WINDOWS, human_bytes};
use vtex_truth::reference::{Edges, Reference};
use vtex_truth::texture::{
    FilterMode, RasterTexture, Shooter, TODAY_TEXELS, canvas_options, region_uv,
};

use crate::baking;
use crate::baking::fonts::FontLibrary;
use crate::cli::args::Demo;
use crate::cli::{Console, ExitCode, Failure, Outcome};
use crate::files::input::{self, Input};
use crate::files::output;
use crate::texture::film::{self, Grade, SceneKind, Settings};

/// Zooms that the page shows.
const ZOOMS: [f64; 4] = [1.0, 8.0, 32.0, 256.0];
/// Samples per pixel of the pictures.
const SPP: u32 = 16;
/// How the scene is traced.
const SCENE: Settings = Settings {
    size_px: [720, 480],
    spp: 32,
    filter: FilterMode::Point,
    bounces: 5,
    seed: 0,
    time_limit: None,
};

/// How it shows its light: as `vtex render` does.
const GRADE: Grade = Grade {
    tone_map: ToneMap::AgX,
    stops: 0.0,
};

const INTRODUCTION: &str = "Each drawing at zoom 1, 8, 32 and 256, three times: drawn from the SVG \
    at that zoom with 257 samples per pixel, which is the truth; looked up in the .vtex file; and \
    looked up in a raster texture of 4096 texels with mips, as engines use today. Lookups take 16 \
    samples per pixel. PSNR is measured against the truth, over white; higher is better.";

/// Runs `vtex demo`.
pub(super) fn run(args: Demo, console: Console) -> Outcome<ExitCode> {
    output::create_folder(&args.output)?;
    let fonts = FontLibrary::new(args.fonts.clone())?;
    let inputs = input::expand(&args.inputs)?;
    let mut drawings = Vec::new();
    for input in &inputs {
        drawings.push(Drawing::bake(input, &args.output, &fonts, console)?);
    }
    let mut page = Page::new("Vector textures: SVG, vtex, raster");
    if !args.no_render {
        let begun = Instant::now();
        let files = drawings
            .iter()
            .map(|drawing| drawing.file.clone())
            .collect();
        let scene = film::scene_of(files, SceneKind::Showroom);
        let film = film::trace(scene, SCENE, console)?.film;
        let png = film::encode(&film, GRADE, Path::new("scene.png"))?;
        page.large_picture(
            png,
            "Path-traced with the textures baked from these drawings",
        );
        console.note(&format!(
            "traced the scene in {:.1} s",
            begun.elapsed().as_secs_f64()
        ));
    }
    page.paragraph(INTRODUCTION);
    for drawing in &drawings {
        drawing.show(&mut page, args.size, &fonts, console)?;
    }
    let taken = output::taken(inputs.iter().map(|input| input.path.as_path()));
    output::write_page(&args.output, page, &taken)?;
    console.result(format!("{}\n", args.output.join("index.html").display()).as_bytes())?;
    Ok(ExitCode::Ok)
}

struct Drawing {
    input: Input,
    svg: Vec<u8>,
    file: VtexFile,
    vtex_bytes: u64,
}

impl Drawing {
    fn bake(input: &Input, folder: &Path, fonts: &FontLibrary, console: Console) -> Outcome<Self> {
        let begun = Instant::now();
        let svg = input.read()?;
        let file = baking::bake(&input.path, &svg, &BakeConfig::default(), fonts, &|_| ())?;
        let bytes = baking::to_bytes(&input.path, &file)?;
        let path = folder.join(
            input
                .relative
                .file_name()
                .unwrap_or(input.relative.as_os_str()),
        );
        let path = path.with_extension("vtex");
        output::write(&path, &bytes)?;
        let vtex_bytes = bytes.len() as u64;
        let seconds = begun.elapsed().as_secs_f64();
        let size = human_bytes(vtex_bytes);
        console.note(&format!(
            "baked {}: {size} in {seconds:.2} s",
            path.display()
        ));
        Ok(Self {
            input: input.clone(),
            svg,
            file,
            vtex_bytes,
        })
    }

    /// Adds the drawing to the page: a row for each zoom.
    fn show(
        &self,
        page: &mut Page,
        longer_px: u32,
        fonts: &FontLibrary,
        console: Console,
    ) -> Outcome<()> {
        let begun = Instant::now();
        let path = &self.input.path;
        let draw = |edges| {
            Reference::parse(&self.svg, fonts.for_svg(&self.svg), edges)
                .map_err(|error| Failure::invalid(path, error))
        };
        let crisp = draw(Edges::Crisp)?;
        let texture = RasterTexture::new(&draw(Edges::Smooth)?, TODAY_TEXELS)?;
        let comparison = Comparison::new(
            &crisp,
            Terms {
                longer_px,
                spp: SPP,
                region_uv: region_uv(&self.file, FilterMode::Point),
                windows: WINDOWS,
                mask: false,
            },
        )?;
        let shooter = Shooter::on_cpu(&self.file, canvas_options(FilterMode::Point));
        let name = path
            .file_stem()
            .map_or_else(|| "drawing".into(), |stem| stem.to_string_lossy());
        page.drawing(
            &name,
            &Sizes::new(
                self.svg.len() as u64,
                (&self.file, self.vtex_bytes),
                &texture,
            )?,
        );
        for zoom in ZOOMS {
            let view = comparison.first_window(zoom)?;
            let shot = comparison.shot(view);
            let truth = comparison.truth(view)?;
            let vtex = Column::new(&comparison, &truth, shooter.shoot(shot)?);
            let raster = Column::new(&comparison, &truth, texture.shoot(shot));
            page.row(zoom, &truth, &[vtex, raster])?;
        }
        console.note(&format!(
            "compared {name} in {:.1} s",
            begun.elapsed().as_secs_f64()
        ));
        Ok(())
    }
}
