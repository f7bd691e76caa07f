//! The data of `<image>` and `feImage`: from the SVG itself, or from the caller's reader.

use std::sync::Arc;

use imagesize::ImageType;
use usvg::{ImageHrefResolver, ImageKind, Options};
use vtex_format::WarningCode;

use super::{
    fonts,
    text::{GZIP_MAGIC, checked_text},
    tree,
};
use crate::{config::ImageReader, warning::Warnings};

/// Most pixels of a raster image, by its header. A PNG that claims 60000 x 60000 would end the
/// process when the decoder allocates memory. 64 Mpx are 256 MiB of RGBA.
const MAX_IMAGE_PIXELS: u64 = 64 << 20;
/// Most bytes of a nested SVG image.
const MAX_NESTED_SVG_BYTES: usize = 16 << 20;
/// Levels of SVG images inside SVG images. Real files have one. Each level is parsed on the stack
/// of the level above.
const MAX_NESTED_LEVELS: usize = 4;
/// Characters of a link that a warning quotes.
const QUOTED_CHARS: usize = 80;

/// A resolver that decodes data URLs and asks the reader, if there is one, for everything else.
/// usvg's own resolver would read any local path.
pub(crate) fn resolver<'a>(
    warnings: &'a Warnings,
    reader: Option<&'a ImageReader>,
) -> ImageHrefResolver<'a> {
    at_level(warnings, reader, 0)
}

fn at_level<'a>(
    warnings: &'a Warnings,
    reader: Option<&'a ImageReader>,
    level: usize,
) -> ImageHrefResolver<'a> {
    let nest = Nest { warnings, level };
    ImageHrefResolver {
        resolve_data: Box::new(move |mime, data, options| {
            let may_be_svg = mime == "image/svg+xml" || mime == "text/plain";
            load(data, may_be_svg, nest, options)
                .inspect_err(|reason| not_loaded(warnings, &format!("embedded {mime}: {reason}")))
                .ok()
        }),
        resolve_string: Box::new(move |href, options| {
            let quoted: String = href.chars().take(QUOTED_CHARS).collect();
            let Some(reader) = reader else {
                let message = format!("only embedded images are drawn, not {quoted:?}");
                not_loaded(warnings, &message);
                return None;
            };
            let data = reader.read(href);
            data.and_then(|data| load(Arc::new(data), true, nest, options))
                .inspect_err(|reason| not_loaded(warnings, &format!("{quoted:?}: {reason}")))
                .ok()
        }),
    }
}

/// How deep an image is nested, and where its warnings go.
#[derive(Clone, Copy)]
struct Nest<'a> {
    warnings: &'a Warnings,
    level: usize,
}

fn not_loaded(warnings: &Warnings, message: &str) {
    warnings.push(WarningCode::ImageNotLoaded, "image", "", message);
}

fn load(
    data: Arc<Vec<u8>>,
    may_be_svg: bool,
    nest: Nest<'_>,
    options: &Options<'_>,
) -> Result<ImageKind, String> {
    // The bytes decide and not the MIME type, as in browsers: many files name a wrong one.
    match imagesize::image_type(&data) {
        Ok(ImageType::Png) => checked(&data).map(|()| ImageKind::PNG(data)),
        Ok(ImageType::Jpeg) => checked(&data).map(|()| ImageKind::JPEG(data)),
        Ok(ImageType::Gif) => checked(&data).map(|()| ImageKind::GIF(data)),
        Ok(ImageType::Webp) => checked(&data).map(|()| ImageKind::WEBP(data)),
        Ok(_) => Err("the format is not supported".to_owned()),
        Err(_) if may_be_svg => nested(&data, nest, options),
        Err(_) => Err("neither PNG, JPEG, GIF, WebP nor SVG".to_owned()),
    }
}

/// Checks the size in the header.
fn checked(data: &[u8]) -> Result<(), String> {
    let size = imagesize::blob_size(data).map_err(|_| "the header is broken".to_owned())?;
    let (width, height) = (size.width as u64, size.height as u64);
    if width == 0 || height == 0 {
        return Err("zero size".to_owned());
    }
    if width.saturating_mul(height) > MAX_IMAGE_PIXELS {
        return Err(format!("{width} x {height} pixels are too many"));
    }
    Ok(())
}

/// A nested SVG. It cannot link to files, so it cannot contain itself. What it embeds has the same
/// limits as what the outer one embeds.
fn nested(data: &[u8], nest: Nest<'_>, outer: &Options<'_>) -> Result<ImageKind, String> {
    if data.starts_with(&GZIP_MAGIC) {
        return Err("a compressed SVG inside an SVG is not read".to_owned());
    }
    if data.len() > MAX_NESTED_SVG_BYTES || nest.level >= MAX_NESTED_LEVELS {
        return Err("too large or too deeply nested".to_owned());
    }
    // The same limits as for the outer text.
    let text = checked_text(data).map_err(|e| e.to_string())?;
    let options = Options {
        dpi: outer.dpi,
        image_href_resolver: at_level(nest.warnings, None, nest.level + 1),
        font_resolver: fonts::resolver(nest.warnings),
        fontdb: Arc::clone(&outer.fontdb),
        font_size: outer.font_size,
        ..Options::default()
    };
    // `from_data_nested` would drop linked images without asking the hook, so without a warning.
    tree(text, &options, nest.warnings)
        .map(ImageKind::SVG)
        .map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png_header(width: u32, height: u32) -> Vec<u8> {
        let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec();
        png.extend(width.to_be_bytes());
        png.extend(height.to_be_bytes());
        png.extend([8, 6, 0, 0, 0, 0, 0, 0, 0]);
        png
    }

    #[test]
    fn what_a_header_claims_is_checked_before_decoding() {
        let warnings = Warnings::default();
        let nest = Nest {
            warnings: &warnings,
            level: 0,
        };
        let load = |data: Vec<u8>| load(Arc::new(data), false, nest, &Options::default());
        assert!(load(png_header(4000, 4000)).is_ok());
        assert!(load(png_header(60_000, 60_000)).is_err_and(|e| e.contains("too many")));
        assert!(load(png_header(0, 7)).is_err());
        assert!(load(b"GIF89a\xff\xff\xff\xff".to_vec()).is_err());
        assert!(load(b"nothing".to_vec()).is_err());
    }

    /// `inner` as an image of an SVG.
    fn framed(inner: &str) -> String {
        let quoted = inner
            .replace('%', "%25")
            .replace('"', "%22")
            .replace('<', "%3C");
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><image width='9' \
             height='9' href=\"data:image/svg+xml,{quoted}\"/></svg>"
        )
    }

    #[test]
    fn svg_images_nest_a_few_levels_and_read_no_files() {
        let mut svg = "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>\
                       <image width='9' height='9' href='file.png'/></svg>"
            .to_owned();
        for level in 0..=MAX_NESTED_LEVELS {
            svg = framed(&svg);
            let reader = ImageReader::new(|href| panic!("{href} was asked for"));
            let resources = crate::Resources {
                images: Some(reader),
                ..crate::Resources::default()
            };
            let warnings = Warnings::default();
            crate::svg::parse(svg.as_bytes(), &resources, &warnings).unwrap();
            let list = warnings.into_list();
            let wanted = match level {
                MAX_NESTED_LEVELS => "too deeply nested",
                _ => "only embedded images",
            };
            assert!(list[0].message.contains(wanted), "{level}: {list:?}");
        }
    }
}
