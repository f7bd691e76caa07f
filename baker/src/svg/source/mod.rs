//! From bytes to usvg's tree.
//!
//! Limits are checked first, on the text ([`text`], [`entities`]) and then on the tree
//! ([`limits`]). usvg asks hooks for fonts and images; ours open no file ([`fonts`], [`images`]).

mod entities;
mod fonts;
mod images;
mod limits;
mod text;

use std::borrow::Cow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use usvg::fontdb::Database;
use usvg::roxmltree::{Document, ParsingOptions};

use crate::{config::Resources, error::BakeError, style, warning::Warnings};
use limits::{check_filters, check_size};
use text::{GZIP_MAGIC, checked_text, gunzip};

pub use fonts::font_selector;

/// Size of text without a size: CSS's `medium` in browsers. usvg's own default is 12.
const FONT_SIZE_PX: f32 = 16.0;

/// Parses an SVG or SVGZ, at 96 dpi.
///
/// # Errors
/// [`BakeError::Svg`] for text that is no SVG with an area, [`BakeError::Limit`] for one that asks
/// for too much.
pub(crate) fn parse(
    svg: &[u8],
    resources: &Resources,
    warnings: &Warnings,
) -> Result<usvg::Tree, BakeError> {
    let bytes = unpacked(svg)?;
    let text = checked_text(&bytes)?;
    let options = usvg::Options {
        dpi: 96.0,
        image_href_resolver: images::resolver(warnings, resources.images.as_ref()),
        font_resolver: fonts::resolver(warnings),
        fontdb: resources.fonts.clone(),
        font_size: FONT_SIZE_PX,
        ..usvg::Options::default()
    };
    // usvg is not known to panic, but the input may be hostile.
    let tree = catch_unwind(AssertUnwindSafe(|| tree(text, &options, warnings)))
        .map_err(|_| BakeError::Svg("the SVG parser failed".to_owned()))??;
    check_size(&tree)?;
    check_filters(&tree)?;
    Ok(tree)
}

/// The text that a bake of an SVG or SVGZ hands to usvg: its own, or, where it has styles that usvg
/// does not read as browsers do, one with attributes in their place, and texts in place of labels in HTML. Use it, with
/// [`font_selector`] and a font size of 16, to draw the same SVG with usvg.
///
/// # Errors
/// [`BakeError::Svg`] for what is no SVG, [`BakeError::Limit`] for styles that ask for too much.
pub fn styled_text(svg: &[u8], fonts: &Arc<Database>) -> Result<String, BakeError> {
    let bytes = unpacked(svg)?;
    let text = checked_text(&bytes)?;
    let failed = |e| bake_error(&usvg::Error::ParsingFailed(e));
    let styled = style::resolve(
        &document(text).map_err(failed)?,
        &faces(fonts),
        &Warnings::default(),
    )?;
    Ok(styled.unwrap_or_else(|| text.to_owned()))
}

fn faces(database: &Arc<Database>) -> style::Faces<'_> {
    style::Faces {
        database,
        select: font_selector,
    }
}

fn unpacked(svg: &[u8]) -> Result<Cow<'_, [u8]>, BakeError> {
    match svg.starts_with(&GZIP_MAGIC) {
        true => gunzip(svg).map(Cow::Owned),
        false => Ok(Cow::Borrowed(svg)),
    }
}

/// The tree of an SVG with its styles as browsers read them.
fn tree(
    text: &str,
    options: &usvg::Options<'_>,
    warnings: &Warnings,
) -> Result<usvg::Tree, BakeError> {
    let failed = |e| bake_error(&usvg::Error::ParsingFailed(e));
    let document = document(text).map_err(failed)?;
    match style::resolve(&document, &faces(&options.fontdb), warnings)? {
        None => usvg::Tree::from_xmltree(&document, options).map_err(|e| bake_error(&e)),
        Some(text) => usvg::Tree::from_str(&text, options).map_err(|e| bake_error(&e)),
    }
}

/// Parses XML as usvg does.
fn document(text: &str) -> Result<Document<'_>, usvg::roxmltree::Error> {
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(text, options)
}

fn bake_error(error: &usvg::Error) -> BakeError {
    match error {
        usvg::Error::ElementsLimitReached => {
            BakeError::Limit("the SVG has too many or too deeply nested elements".to_owned())
        }
        usvg::Error::InvalidSize => {
            BakeError::Svg("width, height and viewBox must be positive".to_owned())
        }
        usvg::Error::ParsingFailed(usvg::roxmltree::Error::NodesLimitReached) => {
            BakeError::Limit("the SVG has too many or too deeply nested nodes".to_owned())
        }
        usvg::Error::ParsingFailed(e) => BakeError::Svg(format!("XML: {e}")),
        other => BakeError::Svg(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error_of(svg: &[u8]) -> String {
        let warnings = Warnings::default();
        parse(svg, &Resources::default(), &warnings)
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn faults_are_named_in_one_line() {
        let svg = |head: &str| format!("<svg xmlns='http://www.w3.org/2000/svg' {head}/>");
        let cases: [(Vec<u8>, &str); 9] = [
            (b"".to_vec(), "the input is empty"),
            (b" \n\t".to_vec(), "the input is empty"),
            (b"\x89PNG\r\n".to_vec(), "not UTF-8"),
            (b"hello".to_vec(), "XML"),
            (b"<html/>".to_vec(), "not a usable SVG"),
            (
                b"<svg xmlns='http://www.w3.org/2000/svg'><g".to_vec(),
                "XML",
            ),
            (b"\x1f\x8b\x08\x00".to_vec(), "gzip"),
            (svg("width='0' height='5'").into_bytes(), "must be positive"),
            (
                svg("width='100000' height='1'").into_bytes(),
                "longer than 4096:1",
            ),
        ];
        for (input, says) in cases {
            let error = error_of(&input);
            assert!(error.contains(says), "{error:?} should say {says:?}");
            assert!(!error.contains('\n'), "{error:?} is more than a line");
        }
    }

    #[test]
    fn work_is_refused_before_it_starts() {
        let svg = |content: &str| {
            format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'>{content}</svg>")
                .into_bytes()
        };
        let filter = |primitive: &str| {
            svg(&format!(
                "<filter id='f'>{primitive}</filter><path d='M0 0H9V9z' filter='url(#f)'/>"
            ))
        };
        let masks: String = (0..1100)
            .map(|i| {
                let next = i + 1;
                format!("<mask id='m{i}'><g mask='url(#m{next})'><path d='M0 0H9V9z'/></g></mask>")
            })
            .collect();
        let masks = svg(&format!("{masks}<path d='M0 0H9V9z' mask='url(#m0)'/>"));
        let groups = svg(&["<g opacity='.5'>", "</g>"]
            .map(|tag| tag.repeat(60_000))
            .concat());
        let cases = [
            (
                filter("<feTurbulence baseFrequency='1' numOctaves='100000'/>"),
                "filters ask for too much",
            ),
            (masks, "nest deeper than 1024"),
            (groups, "nest"),
            (
                svg("<g id='a'><use href='#b'/></g><g id='b'><use href='#a'/></g>"),
                "nest",
            ),
        ];
        // As much stack as the crate's documentation asks for.
        let errors = std::thread::Builder::new().stack_size(64 << 20);
        let errors = errors.spawn(move || cases.map(|(input, says)| (error_of(&input), says)));
        for (error, says) in errors.unwrap().join().unwrap() {
            assert!(error.contains(says), "{error:?} should say {says:?}");
        }
        let warnings = Warnings::default();
        let usual = filter("<feMorphology radius='1'/><feGaussianBlur stdDeviation='2'/>");
        assert!(parse(&usual, &Resources::default(), &warnings).is_ok());
    }

    #[test]
    fn a_gzip_bomb_stops_at_the_limit() {
        use std::io::Write;
        let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        let spaces = vec![b' '; 1 << 20];
        for _ in 0..80 {
            packer.write_all(&spaces).unwrap();
        }
        let bomb = packer.finish().unwrap();
        assert!(error_of(&bomb).contains("larger than 64 MiB"));
    }
}
