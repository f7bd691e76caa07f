//! `vtex gltf`.

pub(super) mod beside;

use std::path::Path;

use serde_json::json;
use vtex_baker::BakeConfig;
use vtex_format::{Features, VtexFile};
use vtex_gltf::{Attachment, attach};
use vtex_shaders::srgb;
use vtex_truth::picture::Picture;

use crate::baking::fonts::FontLibrary;
use crate::cli::args::Gltf;
use crate::cli::{Console, ExitCode, Failure, Format, Outcome};
use crate::files::{extension, input, lossy, output};
use crate::{baking, texture};
use beside::Beside;

/// Texels along the longer side of the raster for other programs.
const FALLBACK_SIDE: u32 = 512;

/// Runs `vtex gltf`.
pub(super) fn run(args: &Gltf, console: Console) -> Outcome<ExitCode> {
    if extension(&args.output) != "glb" {
        let name = args.output.display();
        return Err(Failure::usage(format!(
            "{name}: the output must be a .glb file"
        )));
    }
    output::check(&args.output)?;
    let fonts = FontLibrary::new(args.fonts.clone())?;
    let bytes = input::read(&args.input)?;
    let mut attachments = Vec::new();
    for (name, path) in &args.attach {
        attachments.push(attachment(name, path, &fonts)?);
    }
    let mut files = Beside {
        path: &args.input,
        fonts: &fonts,
    };
    let made = attach(&bytes, &mut files, &attachments);
    let made = made.map_err(|error| beside::failure(&args.input, &error))?;
    output::write(&args.output, &made)?;
    let (output, count) = (args.output.display(), attachments.len());
    console.note(&format!(
        "{output}: {} bytes, {count} vector textures attached",
        made.len()
    ));
    if console.format == Format::Json {
        console.json(&json!({
            "input": lossy(&args.input), "output": lossy(&args.output), "bytes": made.len(),
            "attached": count,
        }))?;
    }
    Ok(ExitCode::Ok)
}

fn attachment(name: &str, path: &Path, fonts: &FontLibrary) -> Outcome<Attachment> {
    let bytes = input::read(path)?;
    let is_vtex = extension(path) == "vtex";
    // Baked also to find out here, and not at each load, whether the drawing can be.
    let file = match is_vtex {
        true => texture::parse(path, &bytes)?,
        false => {
            let config = BakeConfig {
                mip0_size: FALLBACK_SIDE,
                ..BakeConfig::default()
            };
            baking::bake(path, &bytes, &config, fonts, &|_| ())?
        }
    };
    Ok(Attachment {
        name: name.to_owned(),
        fallback_png: fallback(path, &file)?,
        bytes,
        is_vtex,
    })
}

/// The canvas image as PNG.
fn fallback(path: &Path, file: &VtexFile) -> Outcome<Vec<u8>> {
    let has_canvas = file.spec.features & Features::MIPS != 0;
    let canvas = file.images.first().filter(|_| has_canvas);
    let level = canvas.and_then(|canvas| Some((canvas.size, canvas.mips.first()?)));
    let Some((size, texels)) = level else {
        return Err(Failure::invalid(
            path,
            "the file has no mips to make a PNG of",
        ));
    };
    let pixels = texels.as_chunks::<4>().0.iter().map(|&texel| linear(texel));
    let picture = Picture {
        size_px: size,
        pixels: pixels.collect(),
    };
    Ok(picture.to_png()?)
}

/// A stored texel as linear light, premultiplied.
fn linear([r, g, b, a]: [u8; 4]) -> [f32; 4] {
    let table = srgb::decode_table();
    let [r, g, b] = [r, g, b].map(|c| table[usize::from(c)]);
    [r, g, b, f32::from(a) / 255.0]
}
