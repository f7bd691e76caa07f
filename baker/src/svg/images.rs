//! Where `<image>` and `feImage` get their data: from the SVG itself, never from a file.

use std::sync::Arc;

use imagesize::ImageType;
use usvg::{ImageHrefResolver, ImageKind, Options, Tree};
use vtex_format::WarningCode;

use crate::warning::Warnings;

/// Pixels that a raster image may claim in its header. A PNG that claims 60000 x 60000 would end
/// the process inside the decoder's allocation; 64 Mpx are 256 MiB of RGBA.
const MAX_IMAGE_PIXELS: u64 = 64 << 20;
/// Bytes of a nested SVG image.
const MAX_NESTED_SVG_BYTES: usize = 16 << 20;
/// How much of a refused reference a warning quotes.
const QUOTED_CHARS: usize = 80;

/// usvg's own resolver reads any local path; this one decodes data URLs only.
pub(crate) fn resolver(warnings: &Warnings) -> ImageHrefResolver<'_> {
    ImageHrefResolver {
        resolve_data: Box::new(move |mime, data, options| {
            load(mime, data, options)
                .inspect_err(|reason| not_loaded(warnings, &format!("embedded {mime}: {reason}")))
                .ok()
        }),
        resolve_string: Box::new(move |href, _| {
            let quoted: String = href.chars().take(QUOTED_CHARS).collect();
            not_loaded(
                warnings,
                &format!("only embedded images are drawn, not {quoted:?}"),
            );
            None
        }),
    }
}

fn not_loaded(warnings: &Warnings, message: &str) {
    warnings.push(WarningCode::ImageNotLoaded, "image", "", message);
}

fn load(mime: &str, data: Arc<Vec<u8>>, options: &Options<'_>) -> Result<ImageKind, String> {
    // The bytes decide, as in browsers: many files carry a wrong MIME type.
    match imagesize::image_type(&data) {
        Ok(ImageType::Png) => checked(&data).map(|()| ImageKind::PNG(data)),
        Ok(ImageType::Jpeg) => checked(&data).map(|()| ImageKind::JPEG(data)),
        Ok(ImageType::Gif) => checked(&data).map(|()| ImageKind::GIF(data)),
        Ok(ImageType::Webp) => checked(&data).map(|()| ImageKind::WEBP(data)),
        Ok(_) => Err("the format is not supported".to_owned()),
        Err(_) if mime == "image/svg+xml" || mime == "text/plain" => nested(&data, options),
        Err(_) => Err("neither PNG, JPEG, GIF, WebP nor SVG".to_owned()),
    }
}

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

/// `options` carry these same hooks, so a nested SVG is as confined as the outer one.
fn nested(data: &[u8], options: &Options<'_>) -> Result<ImageKind, String> {
    if data.starts_with(&[0x1f, 0x8b]) {
        return Err("a compressed SVG inside an SVG is not read".to_owned());
    }
    if data.len() > MAX_NESTED_SVG_BYTES {
        return Err("too large".to_owned());
    }
    // Not `from_data_nested`: that one drops outside images without asking the hook.
    Tree::from_data(data, options)
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
        let load = |data: Vec<u8>| load("image/png", Arc::new(data), &Options::default());
        assert!(load(png_header(4000, 4000)).is_ok());
        assert!(load(png_header(60_000, 60_000)).is_err_and(|e| e.contains("too many")));
        assert!(load(png_header(0, 7)).is_err());
        assert!(load(b"GIF89a\xff\xff\xff\xff".to_vec()).is_err());
        assert!(load(b"nothing".to_vec()).is_err());
    }
}
